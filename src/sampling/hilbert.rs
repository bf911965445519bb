//! A fixed order of a picture's pixels that keeps neighbours together: Hilbert's curve, clipped.
//!
//! The curve fills the smallest square of a power of two that holds the picture (Hilbert 1891); what lies outside is left out of the
//! count. A pixel's rank is the number of the picture's pixels before it, summed quadrant by quadrant. Every aligned square of a
//! power of two is one run of the order, so whatever is dealt out evenly along it is even in both directions.

/// The order of the pixels of a picture.
#[derive(Clone, Copy, Debug)]
pub struct HilbertOrder {
    width: u32,
    height: u32,
}

impl HilbertOrder {
    /// The order of a picture's pixels; each side is at most 2^20.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height }
    }

    /// How many pixels come before this one.
    pub fn rank(&self, x: u32, y: u32) -> u64 {
        let mut rank = 0;
        let mut side = self.width.max(self.height).next_power_of_two();
        // The corner of the square that holds the pixel, and how the curve lies in it: mirrored at the main diagonal or not,
        // turned by half or not.
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
                rank += self.pixels(quadrant_left, quadrant_top, side);
                step += 1;
            }
            // The curve enters the first quadrant and leaves the last one along its sides.
            mirrored ^= step == 0 || step == 3;
            turned ^= step == 3;
        }
        rank
    }

    /// How many of the picture's pixels a square holds.
    fn pixels(&self, left: u32, top: u32, side: u32) -> u64 {
        let columns = self.width.saturating_sub(left).min(side);
        let rows = self.height.saturating_sub(top).min(side);
        u64::from(columns) * u64::from(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_is_walked_in_single_steps_and_the_largest_has_its_ranks() {
        for side in [1, 2, 4, 8, 16, 32] {
            let order = HilbertOrder::new(side, side);
            let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
            let mut walk: Vec<_> = pixels.map(|(x, y)| (order.rank(x, y), x, y)).collect();
            walk.sort_unstable();
            for (pair, rank) in walk.windows(2).zip(0..) {
                let [(first, x0, y0), (second, x1, y1)] = [pair[0], pair[1]];
                assert_eq!((first, second), (rank, rank + 1));
                assert_eq!(x0.abs_diff(x1) + y0.abs_diff(y1), 1);
            }
        }
        let side = 1 << 20;
        let order = HilbertOrder::new(side, side);
        assert_eq!(order.rank(side - 1, 0), (1 << 40) - 1);
        let rows = HilbertOrder::new(side, 1);
        assert_eq!(rows.rank(side - 1, 0), u64::from(side) - 1);
    }
}
