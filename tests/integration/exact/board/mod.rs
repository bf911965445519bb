//! Tests of exact pictures of a checkerboard near its horizon, with squares of any size, in
//! ordinary and in extreme views.

mod extreme;
mod ordinary;

use super::{assert_known, assert_part_adds_up, difference, exact, read};
use crate::{
    effort::{Effort, sampled_and_exhaustive},
    random::Random,
    table::rows,
};

/// The horizon passes close to the centres of a row of pixels or, with a roll of 45°, of the pixels
/// on a diagonal of the picture. The error bound of every pixel must be at most 1e-9.
#[test]
fn pixels_crossed_by_the_horizon_are_known_within_1e_9() {
    for side in [8, 9, 65] {
        for lift in [0.0, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16] {
            for (lift, roll) in [(lift, 0), (-lift, 0), (lift, 45), (-lift, 45)] {
                assert_known(&format!(
                    "image {{ width {side} height {side} }}
                     camera {{ eye (0.3, 0.3, 8) direction (0.7, {lift}, -8) roll {roll}deg fov 50deg }}
                     checkerboard {{ y 0 square 1 }}"
                ));
            }
        }
    }
}

#[test]
fn boards_of_tiny_squares_and_with_long_lenses_are_known_within_1e_9() {
    for [image, camera, board, lenses] in rows(
        "
        -- Next to nothing is left but their mean.
        width 6 height 4 -> eye (0.3, 1.7, 8) direction (1, -0.1, -2) roll 20deg -> square 1e-12 -> fov 40deg | fov 1deg | fov 170deg
        width 6 height 4 -> eye (0.3, 1.7, 8) direction (1, -0.1, -2) roll 20deg -> square 1e-30 -> fov 40deg | fov 1deg | fov 170deg
        -- A corner of squares close up, an odd number of squares from the eye: the share is as good as in any view.
        width 1 height 1 -> eye (-1, 1, -4) direction (-1, -1, 1) d 1 -> -> view_height 1 | view_height 1e-3 | view_height 1e-6 | view_height 1e-9 | view_height 1e-14
    ",
    ) {
        for lens in lenses.split('|') {
            assert_known(&format!(
                "image {{ {image} }} camera {{ {camera} {lens} }} checkerboard {{ {board} colors (white, black) }}"
            ));
        }
    }
}

#[test]
fn extreme_boards_equal_the_boards_that_they_look_like() {
    for [eye, one, other, share, most, values] in rows(
        "
        -- An eye so close to the floor that it sees nothing else of it than the square that it is above.
        (0.3, s, 0.1) -> colors (white, black) -> colors (white, white) -> 1 -> bounds -> 1e-16 1e-20 1e-28 1e-100 1e-300
        -- Squares so small that only their mean is seen.
        (0.3, 2, 0.1) -> square s colors (white, black) -> square s colors (white, white) -> 0.5 -> 1e-9 -> 1e-20 1e-100 1e-298 1e-300 1e-303
        -- Squares as large as numbers: four of them are seen, however large they are.
        (-0.3, 2, 0.1) -> square 1e100 -> square s -> 1 -> bounds -> 1e160 1e300 1e301 1e305 1.7e308
    ",
    ) {
        for value in values.split(' ') {
            let [one, other] = [one, other].map(|board| {
                exact(&read(&format!(
                    "let s = {value} image {{ width 16 height 12 }}
                     camera {{ eye {eye} direction (3, -0.5, -1) fov 40deg }}
                     checkerboard {{ {board} }}"
                )))
            });
            let share: f64 = share.parse().unwrap();
            let most = most.parse().unwrap_or(one.bound() + other.bound());
            for (one, other) in one.film.pixels().iter().zip(other.film.pixels()) {
                let apart = difference(*one, other.map(|light| share * light));
                assert!(apart <= most, "{eye}, {value}: {apart:e} of {most:e}");
            }
        }
    }
}
