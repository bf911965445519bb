//! A fixed order of a picture's pixels that keeps neighbours together: Hilbert's curve, clipped.
//!
//! The curve fills the smallest square of a power of two that holds the picture (Hilbert 1891); what lies outside is left out of the
//! count. A pixel's rank is the number of the picture's pixels before it, summed quadrant by quadrant. Every aligned square of a
//! power of two is one run of the order, so whatever is dealt out evenly along it is even in both directions.

use crate::area::Area;

/// How many pixels of a picture, each of whose sides is at most 2^20, come before this one.
pub fn rank(picture: Area, x: u32, y: u32) -> u64 {
    let mut rank = 0;
    let side = picture.width.max(picture.height).next_power_of_two();
    // The square that holds the pixel, and how the curve lies in it: mirrored at the main diagonal or not, turned by half or not.
    let mut square = Area::whole(side, side);
    let (mut mirrored, mut turned) = (false, false);
    while square.width > 1 {
        let half = square.width / 2;
        let mut step = 0;
        loop {
            // The four quadrants as an upright curve visits them: down, right, up.
            let (right, lower) = (step >= 2, step == 1 || step == 2);
            let (right, lower) = if mirrored {
                (lower, right)
            } else {
                (right, lower)
            };
            let quadrant = Area {
                x: square.x + u32::from(right != turned) * half,
                y: square.y + u32::from(lower != turned) * half,
                ..Area::whole(half, half)
            };
            if Area::pixel(x, y).lies_in(quadrant) {
                square = quadrant;
                break;
            }
            rank += quadrant.common(picture).pixels();
            step += 1;
        }
        // The curve enters the first quadrant and leaves the last one along its sides.
        mirrored ^= step == 0 || step == 3;
        turned ^= step == 3;
    }
    rank
}
