//! Integrates a checkerboard's sign, 1 on squares of one colour and −1 on the others, over a convex
//! polygon of the picture.
//!
//! In: a board's linear forms in a sub-pixel ([`homography`]) and a polygon. Out: the area of the
//! first colour minus that of the second, in square pixels, with an error bound.
//!
//! - Squares near the eye are cut out of the picture one by one ([`near`]).
//! - Over all farther squares, Green's theorem turns the integral into a sum over the lines that
//!   the polygon's edges cross ([`green`]). If an edge crosses very many or infinitely many lines,
//!   [`tail`] evaluates the sum. This happens towards the horizon, and along an edge that hardly
//!   recedes.
//! - Pixels that show only a board, with few of its lines, are computed eight at a time
//!   ([`board_pixels`], [`strips_simd`]).
//!
//! Every bound includes the effect of rounding errors of the linear forms, which displace the
//! squares. If a bound exceeds the polygon's area, the result is 0, the mean of both colours, with
//! the area as the bound.

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
    budget::PixelBudget,
    clip::{measure, split},
};

pub(super) use self::{
    homography::{BoundedSum, Homography, UNIT, form, size},
    special::square_wave,
};

/// Distance, in squares, up to which squares are near. It is measured from the line in the board's
/// plane where the depth is 0 ([`Homography`]). Near squares are cut out one by one. The farther
/// part of a polygon is integrated along its boundary by Green's theorem, with series of at most 20
/// terms. With a distance of 18 squares, the bound of the omitted terms is proportional to
/// 22!/2·(18π)⁻²⁰, about 5e-15. With a smaller distance, this factor would be larger; with a larger
/// distance, more squares would have to be cut out.
const NEAR_SQUARES: f64 = 18.0;
/// Maximum number of squares in a polygon that are all cut out one by one, at any distance. If a
/// polygon shows more squares, only those within the distance [`NEAR_SQUARES`] are cut out. Not
/// critical: with 6 or 96, the measured running time changes by at most about 10 %.
const MAX_CUT_SQUARES: f64 = 24.0;
/// Maximum depth at which squares are cut out one by one. The depth is 1 over the form L
/// ([`Homography`]), which is 0 on the horizon. At this depth, a point of the picture is only a
/// thousand rounding errors away from the horizon, because the largest factor of L is about 1.
/// Squares may be so large that even squares beyond this depth are near ([`NEAR_SQUARES`]). The
/// area beyond this depth is then not integrated, but added to the error bound.
const MAX_DEPTH: f64 = 1e13;

impl Homography {
    /// Integrates the board's sign (1 on squares of one colour, −1 on the others) over the part of
    /// a convex polygon that shows the floor, in square pixels. The result does not depend on the
    /// polygon's orientation.
    pub fn over(&self, polygon: &[DVec2], budget: &PixelBudget) -> BoundedSum {
        let visible = self.visible(polygon);
        if visible.polygon.len() < 3 {
            return BoundedSum::default();
        }
        if self.squares(&visible.polygon) <= MAX_CUT_SQUARES {
            return near::sum(self, &visible.polygon, budget).within(polygon);
        }
        // Squares up to the depth m = `depth` are near, i.e. cut out one by one. At greater depths,
        // m changes little from square to square.
        let [p, q] = self.slope;
        let depth = NEAR_SQUARES * (p.abs() + q.abs());
        let nearness = |at: DVec2| depth.min(MAX_DEPTH) * form(&self.denominator, at) - 1.0;
        let (mut far, mut near) = (Vec::new(), Vec::new());
        split(&visible.polygon, nearness, &mut far, &mut near);
        let mut sum = BoundedSum::default();
        if near.len() > 2 {
            sum.add(near::sum(self, &near, budget));
        }
        if far.len() > 2 {
            sum.add(if depth <= MAX_DEPTH {
                green::sum(self, &far, &visible, budget).within(&far)
            } else {
                BoundedSum::unknown(&far)
            });
        }
        if polygon.iter().any(|&at| self.is_set_on_horizon(at)) {
            // `Self::corner` moves a corner to the horizon if its distance from the horizon may be
            // only a rounding error. The move displaces squares at most as far as rounding errors
            // do. The bound for rounding errors is therefore added a second time.
            sum.bound += self.displacement_error(&visible.polygon);
        }
        sum.within(polygon)
    }

    /// Estimates the number of squares that a polygon shows: its area on the floor, in squares,
    /// plus the numbers of rows and columns of its bounding box on the floor. The area of the
    /// bounding box would be a poor estimate, because a narrow diagonal polygon shows far fewer
    /// squares.
    fn squares(&self, polygon: &[DVec2]) -> f64 {
        let floor: Vec<DVec2> = polygon
            .iter()
            .map(|&at| {
                let depth = 1.0 / form(&self.denominator, at).max(0.0);
                DVec2::from(
                    self.numerators
                        .map(|numerator| form(&numerator, at) * depth),
                )
            })
            .collect();
        let (low, high) = floor.iter().fold(
            (DVec2::INFINITY, DVec2::NEG_INFINITY),
            |(low, high), place| (low.min(*place), high.max(*place)),
        );
        // Numbers of columns and rows of the bounding box on the floor, added up. The sum is
        // infinite or NaN if the polygon reaches the horizon.
        let spans = (high.floor() - low.floor() + 1.0).element_sum();
        spans + measure(&floor).0.abs()
    }
}
