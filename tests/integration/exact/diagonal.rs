//! Squares too small to be seen, along their diagonals: what is left of them is known from the eye's place alone.

use pinhole::area::Area;

use super::{part, read};

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
