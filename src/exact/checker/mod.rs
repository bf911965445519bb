//! The integral of a checkerboard's sign over a convex polygon of the picture.
//!
//! In: a board's forms in a sub-pixel ([`homography`]) and a polygon. Out: by how much more of it
//! shows the first colour than the second, with a bound.
//!
//! - Near squares are cut out of the picture one by one ([`near`]).
//! - Beyond them Green's theorem makes of the integral a sum over the lines that the polygon's
//!   sides cross ([`green`]), which [`tail`] adds up where those lines are very many, or never end:
//!   toward the horizon, and where a side hardly recedes.
//! - Pixels of a board alone, with few of its lines, are computed eight at a time
//!   ([`board_pixels`], [`strips_simd`]).
//!
//! What roundings of the forms displace is added to every bound. Where more is in doubt than the
//! polygon's area, the answer is the mean of both colours.

pub(super) mod board_pixels;
mod crossings;
mod green;
mod homography;
mod near;
mod special;
mod strips_simd;
mod tail;
#[cfg(test)]
mod tests;

use glam::DVec2;

use super::{
    budget::Budget,
    clip::{measure, split},
};

pub(super) use self::{
    homography::{Homography, Sum, UNIT, form, size},
    special::square_wave,
};

/// The part of the board that is further away than so many squares is summed along its boundary:
/// there the n-th term of the series is at most n/18π of the one before, so that its 20 terms reach
/// 20!/(18π)²⁰ = 2e-17.
const FAR: f64 = 18.0;
/// No more squares than these are cut out one by one wherever they are. (Measured: with 6 or 96
/// times differ by about a tenth at most.)
const FEW: f64 = 24.0;
/// No near square is cut out beyond this m, where the horizon is a thousand roundings away, and
/// where nothing is known of a board with squares so large that they are near. (The largest factor
/// of L is about 1.)
const DEEP: f64 = 1e13;

impl Homography {
    /// The integral of s(a)·s(b) over what a convex polygon shows of the floor, in square pixels;
    /// positive where the squares are, however the polygon is oriented.
    pub fn over(&self, polygon: &[DVec2], budget: &Budget) -> Sum {
        let visible = self.visible(polygon);
        if visible.polygon.len() < 3 {
            return Sum::default();
        }
        if self.squares(&visible.polygon) <= FEW {
            return near::sum(self, &visible.polygon, budget).within(polygon);
        }
        // Squares are near up to a depth, beyond which m changes by little from square to square.
        let [p, q] = self.slope;
        let depth = FAR * (p.abs() + q.abs());
        let nearness = |at: DVec2| depth.min(DEEP) * form(&self.below, at) - 1.0;
        let (mut far, mut near) = (Vec::new(), Vec::new());
        split(&visible.polygon, nearness, &mut far, &mut near);
        let mut sum = Sum::default();
        if near.len() > 2 {
            sum.add(near::sum(self, &near, budget));
        }
        if far.len() > 2 {
            sum.add(match depth <= DEEP {
                true => green::sum(self, &far, &visible, budget).within(&far),
                false => Sum::nothing_known(&far),
            });
        }
        if polygon.iter().any(|&at| self.is_beside_horizon(at)) {
            // Said to be on the horizon, such corners displace what is seen once more as roundings
            // do.
            sum.bound += self.displaced(&visible.polygon);
        }
        sum.within(polygon)
    }

    /// About how many squares a polygon shows: its area on the floor, and the rows and columns of
    /// its box there. A slanted strip has many fewer than its box.
    fn squares(&self, polygon: &[DVec2]) -> f64 {
        let floor: Vec<DVec2> = polygon
            .iter()
            .map(|&at| {
                let depth = 1.0 / form(&self.below, at).max(0.0);
                DVec2::from(self.across.map(|across| form(&across, at) * depth))
            })
            .collect();
        let (low, high) = floor.iter().fold(
            (DVec2::INFINITY, DVec2::NEG_INFINITY),
            |(low, high), place| (low.min(*place), high.max(*place)),
        );
        // At the horizon it is infinite, or not a number.
        let spans = (high.floor() - low.floor() + 1.0).element_sum();
        spans + measure(&floor).0.abs()
    }
}
