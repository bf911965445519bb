//! A fixed order of a picture's pixels that keeps neighbours together: Hilbert's curve, clipped.
//!
//! The curve fills the smallest square of a power of two that holds the picture (Hilbert 1891);
//! what lies outside is left out of the count. A pixel's rank is the number of the picture's pixels
//! before it, summed quadrant by quadrant. Every aligned square of a power of two is one run of the
//! order, so whatever is dealt out evenly along it is even in both directions.

use crate::area::Area;

/// How many pixels of a picture, each of whose sides is at most 2^20, come before this one.
pub fn rank(picture: Area, x: u32, y: u32) -> u64 {
    let mut rank = 0;
    let mut side = picture.width.max(picture.height).next_power_of_two();
    // The corner of the square that holds the pixel, and how the curve lies in it: mirrored at the
    // main diagonal or not, turned by half or not.
    let (mut left, mut top) = (0, 0);
    let (mut mirrored, mut turned) = (false, false);
    while side > 1 {
        side /= 2;
        let mut step = 0;
        loop {
            // The four quadrants as an upright curve visits them: down, right, up.
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
            // How many of the picture's pixels the quadrant holds.
            let columns = picture.width.saturating_sub(quadrant_left).min(side);
            let rows = picture.height.saturating_sub(quadrant_top).min(side);
            rank += u64::from(columns) * u64::from(rows);
            step += 1;
        }
        // The curve enters the first quadrant and leaves the last one along its sides.
        mirrored ^= step == 0 || step == 3;
        turned ^= step == 3;
    }
    rank
}
