//! Orders the pixels of a picture along a Hilbert curve, which keeps neighbours together.
//!
//! The curve fills the smallest square that contains the picture and whose side is a power of two
//! (Hilbert 1891). A pixel's rank is the number of the picture's pixels that come before it on the
//! curve. This number is summed quadrant by quadrant. A quadrant, and each quadrant of a quadrant,
//! is visited completely before the next one. Samples that are distributed evenly along the curve
//! are therefore distributed evenly in both directions of the picture, too.

use crate::area::Area;

/// Returns the rank of the pixel (x, y): the number of the picture's pixels that come before it on
/// the Hilbert curve. The picture's sides are at most 2^20 pixels.
pub fn rank(picture: Area, x: u32, y: u32) -> u64 {
    let mut rank = 0;
    let mut side = picture.width.max(picture.height).next_power_of_two();
    // The top left corner of the square that contains the pixel, and the curve's orientation in
    // this square: whether it is mirrored at the main diagonal, and whether it is rotated by half a
    // turn.
    let (mut left, mut top) = (0, 0);
    let (mut mirrored, mut turned) = (false, false);
    while side > 1 {
        side /= 2;
        let mut step = 0;
        loop {
            // In its basic orientation, the curve visits the four quadrants in this order: it
            // begins at the top left, and goes down, right and up.
            let (right, lower) = (step >= 2, step == 1 || step == 2);
            let (right, lower) = if mirrored {
                (lower, right)
            } else {
                (right, lower)
            };
            let quadrant_left = left + u32::from(right != turned) * side;
            let quadrant_top = top + u32::from(lower != turned) * side;
            let inside = |at: u32, start: u32| at.wrapping_sub(start) < side;
            if inside(x, quadrant_left) && inside(y, quadrant_top) {
                (left, top) = (quadrant_left, quadrant_top);
                break;
            }
            // All pixels of this quadrant come before the pixel (x, y). Those inside the picture
            // are counted.
            let columns = picture.width.saturating_sub(quadrant_left).min(side);
            let rows = picture.height.saturating_sub(quadrant_top).min(side);
            rank += u64::from(columns) * u64::from(rows);
            step += 1;
        }
        // Within the first and the last quadrant, the curve is mirrored. Within the last one, it is
        // also rotated by half a turn.
        mirrored ^= step == 0 || step == 3;
        turned ^= step == 3;
    }
    rank
}
