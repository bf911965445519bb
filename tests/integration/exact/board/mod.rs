//! The board at its horizon, and with squares of any size; in ordinary views, and in views of any width.

mod narrow;
mod ordinary;
mod wide;

use pinhole::scene::Scene;

use super::{exact, is_known, read};

/// Where the horizon passes next to the centres of pixels, level or along their diagonals.
#[test]
fn a_horizon_anywhere_in_a_pixel() {
    for side in [8, 9, 65] {
        for lift in [0.0, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16] {
            for (lift, roll) in [(lift, 0), (-lift, 0), (lift, 45), (-lift, 45)] {
                is_known(&format!(
                    "image {{ width {side} height {side} }}
                     camera {{ eye (0.3, 0.3, 8) direction (0.7, {lift}, -8) roll {roll}deg fov 50deg }}
                     sampler {{ method exact }}
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
                 sampler {{ method exact }}
                 checkerboard {{ y 0 square {square} colors (white, black) }}"
            ));
        }
    }
}

/// A board of one colour in its even squares and another one in its odd ones.
fn floor(eye: &str, square: &str, colors: [&str; 2]) -> Scene {
    let [even, odd] = colors;
    read(&format!(
        "image {{ width 16 height 12 }}
         camera {{ eye {eye} direction (3, -0.5, -1) fov 40deg }}
         sampler {{ method exact }}
         checkerboard {{ square {square} colors ({even}, {odd}) }}"
    ))
}

/// An eye so close to the floor that it sees nothing else of it than the square that it is above.
#[test]
fn an_eye_close_above_a_square() {
    for height in ["1e-16", "1e-20", "1e-28", "1e-100", "1e-300"] {
        let eye = format!("(0.3, {height}, 0.1)");
        let seen = exact(&floor(&eye, "1", ["white", "black"]));
        let wanted = exact(&floor(&eye, "1", ["white", "white"]));
        let bound = seen.bound() + wanted.bound();
        for (seen, wanted) in seen.film.pixels().iter().zip(wanted.film.pixels()) {
            assert!((seen[0] - wanted[0]).abs() <= bound, "{height}");
        }
    }
}

/// Squares so small that only their mean is seen.
#[test]
fn squares_without_number() {
    for square in ["1e-20", "1e-100", "1e-298", "1e-300", "1e-303"] {
        let eye = "(0.3, 2, 0.1)";
        let seen = exact(&floor(eye, square, ["white", "black"]));
        let wanted = exact(&floor(eye, square, ["white", "white"]));
        for (seen, wanted) in seen.film.pixels().iter().zip(wanted.film.pixels()) {
            assert!((seen[0] - 0.5 * wanted[0]).abs() <= 1e-9, "{square}");
        }
    }
}

/// Squares as large as numbers: four of them are seen, however large they are.
#[test]
fn squares_of_the_greatest_numbers() {
    let seen = |square: &str| {
        exact(&read(&format!(
            "image {{ width 16 height 12 }}
             camera {{ eye (0.3, 2, 5) lookat (0, 1, 0) }}
             checkerboard {{ square {square} }}"
        )))
    };
    let large = seen("1e100");
    for square in ["1e160", "1e300", "1e301", "1e305", "1.7e308"] {
        let larger = seen(square);
        let bound = large.bound() + larger.bound();
        for (one, other) in large.film.pixels().iter().zip(larger.film.pixels()) {
            for channel in 0..3 {
                let off = (one[channel] - other[channel]).abs();
                assert!(off <= bound, "{square}: {one:?} and {other:?}");
            }
        }
    }
}
