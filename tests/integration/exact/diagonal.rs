//! Views along a diagonal of the board, where most is left of its squares, be they too small to be seen: it is known from the eye's place alone. There all
//! modes of rows are in step, too, so that bounds are used to the last.

use super::*;
use crate::effort::{Effort, sampled_and_exhaustive};

/// 1 − 2|φ| between −1 and 1, and of the period 2.
fn triangle(phase: f64) -> f64 {
    let turned = phase - 2.0 * (0.5 * phase).round_ties_even();
    1.0 - 2.0 * turned.abs()
}

/// In the widest views a pixel sees a line of floor, across the view's direction. If q squares along z go with ±p along x there, or the other
/// way round, both odd, a part of (1 ± Λ/pq)/2 of it is white, and Λ the triangle wave of what the line is off the corner of four squares.
#[test]
fn a_line_of_squares_without_number() {
    // The view's direction, by what x and z are to be taken for the phase, and what it is below the eye: the direction's y by the height.
    for (direction, [of_x, of_z], below) in [
        ("(1, 0, -1)", [-1.0, 1.0], 0.0),
        ("(1, 0, 1)", [1.0, 1.0], 0.0),
        ("(1, -0.5, -3)", [-1.0, 3.0], 0.5 * 1.7),
        ("(5, 0.25, 3)", [5.0, 3.0], 0.25 * 1.7),
    ] {
        for (x, z) in [(0.31, 2.2), (-7.1, 1.03), (1e3, -0.2)] {
            for square in [1.3e-9, 1e-12, 1e-15] {
                for (lens, far) in [
                    ("d 1e-300", ""),
                    ("d 1e-40", "far 1000"),
                    ("d 5e-324", "far 90"),
                ] {
                    let scene = read(&format!(
                        "image {{ width 6 height 6 }}
                         camera {{ eye ({x:?}, 1.7, {z:?}) direction {direction} {lens} {far} }}
                         sampler {{ method exact }}
                         checkerboard {{ y 0 square {square:e} colors (white, black) }}"
                    ));
                    let pixel = Area {
                        x: 1,
                        y: 5,
                        width: 1,
                        height: 1,
                    };
                    let seen = part(&scene, pixel);
                    // Remainders are exact.
                    let rest = |x: f64| x % (2.0 * square) / square;
                    let wave = triangle(of_x * rest(x) + of_z * rest(z) + rest(below))
                        / (of_x * of_z).abs();
                    // p/q is positive where x and z have different signs in the phase.
                    let white = 0.5 - 0.5 * wave * (of_x * of_z).signum();
                    let (found, bound) = (seen.film.pixel(0, 0)[0], seen.bound());
                    let name = format!("{direction} {x} {z} {square:e} {lens} {far}");
                    assert!(bound <= 1e-9 + 8.0 * square, "{name}: {bound:e}");
                    assert!(
                        (found - white).abs() <= bound + 1e-14,
                        "{name}: {found} for {white}, {bound:e}"
                    );
                }
            }
        }
    }
}

/// Pixels known from elsewhere, of scenes in black and white, with how far that may be off: the widest views along x = z with the eye over that line, of
/// which both sides are the same, up to what the eye's coordinates are off and the view's depth; and two whose millions of pieces were added up
/// with 40 digits, for d = 0.
const KNOWN: [(&str, [u32; 2], f64, f64); 4] = [
    (
        "image { width 2 height 2 } camera { eye (0.3, 1, 0.3) direction (1, 0, -1) d 1e-40 }
         checkerboard { square 1 colors (black, white) }",
        [0, 1],
        0.0,
        1e-30,
    ),
    (
        "image { width 2 height 2 } camera { eye (-0.4804996875, 1, 0.3554996875) direction (-1, 0, -1) d 1e-300 }
         checkerboard { square 0.0625 colors (white, black) }",
        [1, 1],
        0.0,
        1e-14,
    ),
    (
        "image { width 4 height 2 }
         camera { eye (-0.055864375, 13.0, -0.16288562496875) direction (1, 0, 1) d 1e-40 far 4.066243e-37 }
         checkerboard { square 0.03125 colors (white, black) }",
        [0, 1],
        0.996_802_944_621_548,
        1e-15,
    ),
    (
        "image { width 16 height 2 }
         camera { eye (-0.051105874999999995, 0.5, 0.948894124875) direction (1, 0, -1) d 1e-300 far 3.081378e-297 }
         checkerboard { square 0.125 colors (white, black) }",
        [0, 1],
        0.999_837_733_934_641_5,
        1e-15,
    ),
];

#[test]
fn what_is_known_otherwise_is_within_the_bound() {
    for (text, [x, y], truth, off) in KNOWN {
        let exact = exact(&read(&format!("{text} sampler {{ method exact }}")));
        let bound = exact.bounds[(y * exact.film.width() + x) as usize];
        let error = (exact.film.pixel(x, y)[0] - truth).abs();
        assert!(
            error <= f64::from(bound) + off,
            "{error:e} > {bound:e} of {text}"
        );
        assert!(bound <= 1e-8, "{bound:e} of {text}");
    }
}

sampled_and_exhaustive!(the_longest_lenses_end);

/// Places and times so many that modes of lines do not end: something is known in the end, or nothing, but soon.
fn the_longest_lenses_end(effort: Effort) {
    for text in effort.of([
        "camera { eye (-24.8, 13.6, -14.3) direction (-0.6542553237278188, 0, -0.5082900613062609) d 1e80 }
         checkerboard { square 136 colors (white, black) }",
        "camera { eye (5e-324, -1.333179750293108e17, 0) lookat (1.7976931348623157e308, -9.697327195529915e-14, 1.7976931348623157e308)
           up (7.287757695933216e92, -231448480128.88724, 5e-324) d 7.287757695933215e92
           near 1.1380496007412987e-202 far 1.7976931348623157e308 }
         checkerboard { y -241717738976317.66 square 2.2868347391406466e96 colors (red, olive) }",
    ]) {
        let exact = exact(&read(&format!("image {{ width 2 height 2 }} sampler {{ method exact }} {text}")));
        assert!(exact.film.pixels().iter().flatten().all(|light| (0.0..=1.0).contains(light)));
    }
}
