//! The board at its horizon, and with squares of any size; in ordinary views, and in views of any width.

mod narrow;
mod ordinary;
mod wide;

use super::{difference, exact, is_known, part_adds_up, read};
use crate::{
    effort::{Effort, sampled_and_exhaustive},
    table::rows,
    tracer::Random,
};

/// Where the horizon passes next to the centres of pixels, level or along their diagonals.
#[test]
fn a_horizon_anywhere_in_a_pixel() {
    for side in [8, 9, 65] {
        for lift in [0.0, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16] {
            for (lift, roll) in [(lift, 0), (-lift, 0), (lift, 45), (-lift, 45)] {
                is_known(&format!(
                    "image {{ width {side} height {side} }}
                     camera {{ eye (0.3, 0.3, 8) direction (0.7, {lift}, -8) roll {roll}deg fov 50deg }}
                     checkerboard {{ y 0 square 1 }}"
                ));
            }
        }
    }
}

/// Of squares too small to be seen, however small, next to nothing is left but their mean.
#[test]
fn squares_too_small_to_be_seen() {
    for lens in ["fov 40deg", "fov 1deg", "fov 170deg"] {
        for square in ["1e-12", "1e-30"] {
            is_known(&format!(
                "image {{ width 6 height 4 }}
                 camera {{ eye (0.3, 1.7, 8) direction (1, -0.1, -2) roll 20deg {lens} }}
                 checkerboard {{ y 0 square {square} colors (white, black) }}"
            ));
        }
    }
}

/// The largest difference between a board's picture and another board's, of which a share is seen; and the bounds of both.
fn apart(eye: &str, one: &str, other: &str, share: f64) -> (f64, f64) {
    let [one, other] = [one, other].map(|board| {
        exact(&read(&format!(
            "image {{ width 16 height 12 }}
             camera {{ eye {eye} direction (3, -0.5, -1) fov 40deg }}
             checkerboard {{ {board} }}"
        )))
    });
    let pixels = one.film.pixels().iter().zip(other.film.pixels());
    let differences = pixels.map(|(one, other)| difference(*one, other.map(|light| share * light)));
    let bounds = one.bound() + other.bound();
    (differences.fold(0.0, f64::max), bounds)
}

/// An eye so close to the floor that it sees nothing else of it than the square that it is above.
#[test]
fn an_eye_close_above_a_square() {
    for height in ["1e-16", "1e-20", "1e-28", "1e-100", "1e-300"] {
        let eye = format!("(0.3, {height}, 0.1)");
        let (apart, bounds) = apart(&eye, "colors (white, black)", "colors (white, white)", 1.0);
        assert!(apart <= bounds, "{height}: {apart:e} of {bounds:e}");
    }
}

/// Squares so small that only their mean is seen.
#[test]
fn squares_without_number() {
    for square in ["1e-20", "1e-100", "1e-298", "1e-300", "1e-303"] {
        let board = |odd: &str| format!("square {square} colors (white, {odd})");
        let (apart, _) = apart("(0.3, 2, 0.1)", &board("black"), &board("white"), 0.5);
        assert!(apart <= 1e-9, "{square}: {apart:e}");
    }
}

/// Squares as large as numbers: four of them are seen, however large they are.
#[test]
fn squares_of_the_greatest_numbers() {
    for square in ["1e160", "1e300", "1e301", "1e305", "1.7e308"] {
        let square = format!("square {square}");
        let (apart, bounds) = apart("(-0.3, 2, 0.1)", "square 1e100", &square, 1.0);
        assert!(apart <= bounds, "{square}: {apart:e} of {bounds:e}");
    }
}
