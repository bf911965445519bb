//! Tests of exact pictures of a checkerboard in which the rays of a pixel run along a diagonal of
//! the squares. All squares on a diagonal have the same colour. Therefore, the pixel may differ
//! from the mean of both colours even if the squares are too small to be visible.

use super::*;

/// Compares pixels of black and white boards with values that were computed independently. The last
/// two cells of a row are the expected value and the error of this value.
///
/// The view plane distance `d` is so tiny that nearly all rays of a picture lie in one vertical
/// plane. This plane meets the board in a diagonal of its squares. In the first two rows, all
/// squares on this diagonal are black. In the other rows, the expected values are sums of millions
/// of terms. They were computed with 40 digits, as if `d` were 0.
#[test]
fn independently_known_pixels_lie_within_the_bound() {
    for [image, camera, board, x, y, truth, off] in rows("
        width 2 height 2 -> eye (0.3, 1, 0.3) direction (1, 0, -1) d 1e-40 -> square 1 colors (black, white) -> 0 -> 1 -> 0 -> 1e-30
        width 2 height 2 -> eye (-0.4804996875, 1, 0.3554996875) direction (-1, 0, -1) d 1e-300 -> square 0.0625 colors (white, black) -> 1 -> 1 -> 0 -> 1e-14
        width 4 height 2 -> eye (-0.055864375, 13.0, -0.16288562496875) direction (1, 0, 1) d 1e-40 far 4.066243e-37 -> square 0.03125 colors (white, black) -> 0 -> 1 -> 0.996802944621548 -> 1e-15
        width 16 height 2 -> eye (-0.051105874999999995, 0.5, 0.948894124875) direction (1, 0, -1) d 1e-300 far 3.081378e-297 -> square 0.125 colors (white, black) -> 0 -> 1 -> 0.9998377339346415 -> 1e-15
    ") {
        let text = format!("image {{ {image} }} camera {{ {camera} }} checkerboard {{ {board} }}");
        let [x, y] = [x, y].map(|at| at.parse().unwrap());
        let [truth, off]: [f64; 2] = [truth, off].map(|number| number.parse().unwrap());
        let ([light, ..], bound) = pixel(&exact(&read(&text)), x, y);
        let error = (light - truth).abs();
        assert!(error <= bound + off, "{error:e} > {bound:e} of {text}");
    }
}

sampled_and_exhaustive!(extreme_lenses_do_not_hang);

/// Renders checkerboards through cameras with extreme numbers. In some pixels, a sum over all
/// visible edges of the squares would take practically forever. The pixels must be computed
/// quickly, even if their error bounds become large.
fn extreme_lenses_do_not_hang(effort: Effort) {
    for text in effort.of([
        "camera { eye (-24.8, 13.6, -14.3) direction (-0.6542553237278188, 0, -0.5082900613062609) d 1e80 }
         checkerboard { square 136 colors (white, black) }",
        "camera { eye (5e-324, -1.333179750293108e17, 0) lookat (1.7976931348623157e308, -9.697327195529915e-14, 1.7976931348623157e308)
           up (7.287757695933216e92, -231448480128.88724, 5e-324) d 7.287757695933215e92
           near 1.1380496007412987e-202 far 1.7976931348623157e308 }
         checkerboard { y -241717738976317.66 square 2.2868347391406466e96 colors (red, olive) }",
    ]) {
        let exact = exact(&read(&format!("image {{ width 2 height 2 }} {text}")));
        assert!(exact.film.pixels().iter().flatten().all(|light| (0.0..=1.0).contains(light)));
    }
}
