//! The grid of a quadtree: whole numbers for positions in the view plane and for inverse depths.
//!
//! In: coordinates in the view plane, and inverse depths. Out: coordinates in units of the grid,
//! and inverse depths as [`Nearness`] values, which have 32 bits. The conversions keep the order of
//! the numbers, and bounds are rounded outwards.

use crate::tracer::{
    bounds2d::Extent,
    camera::{Direction, Window},
    interval::Interval,
    local_form::Patch,
};

/// Ratio of the side of the quadtree's root cell to the longer side of the camera's window. With
/// 1.125, the root cell is wider than the window by a sixteenth on each side. Rectangles of pixels
/// at the picture's edge are therefore inside it, even with rounding errors.
const ROOT_MARGIN: f64 = 1.125;

/// Binary logarithm of the side of the quadtree's root cell in units of the grid. Rounding
/// positions to units hardly matters, because even in a picture 100,000 pixels wide, a pixel is
/// about 150 units long.
pub(super) const LEVELS: u32 = 24;

/// A rectangle of the view plane in units of the grid. The units `low` and `high` belong to the
/// rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    pub(super) low: [u32; 2],
    pub(super) high: [u32; 2],
}

/// The bounds of an object in the view plane, and an upper bound of its inverse depth.
#[derive(Clone, Copy, Debug)]
pub struct BoundedObject {
    /// Rectangle in which the object may be seen.
    pub bounds: Rectangle,
    /// Upper bound of the object's inverse depths.
    pub nearest: Nearness,
    /// The object's index in the file.
    pub object: u32,
}

/// An inverse depth rounded to 20 bits of its fraction: the upper 32 bits of a non-negative `f64`.
/// The order of these bits, as an integer, is the order of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Nearness(u32);

/// Conversion from the components X and Y of a ray's direction to units of the grid.
#[derive(Clone, Copy, Debug)]
pub struct CellGrid {
    least: f64,
    per_unit: f64,
    /// First grid unit of the camera's window on each axis. Points at lower units are outside of
    /// the window, so they are not looked up in the quadtree.
    low: [u32; 2],
    high: [u32; 2],
}

impl Nearness {
    /// A value that is less than the nearness of every object. As the limit below which objects are
    /// hidden, it hides no object.
    pub const NONE: Self = Self(0);

    /// Rounds a non-negative number up. Returns the greatest value for NaN and negative numbers.
    fn above(x: f64) -> Self {
        if x >= 0.0 {
            Self((x.to_bits() >> 32) as u32 + 1)
        } else {
            Self(u32::MAX)
        }
    }

    /// Rounds a positive number down. Returns [`NONE`](Self::NONE) for all other numbers and NaN.
    pub fn below(x: f64) -> Self {
        if x > 0.0 {
            Self((x.to_bits() >> 32) as u32)
        } else {
            Self::NONE
        }
    }
}

impl Rectangle {
    /// The rectangle that contains every other rectangle. It is used for objects without bounds.
    /// Its ends are below `u32::MAX`, because [`share_of`](Self::share_of) adds one to them.
    pub const ALL: Self = Self {
        low: [0; 2],
        high: [u32::MAX - 1; 2],
    };

    /// Returns whether two rectangles have a unit of the grid in common.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        let meets = |i: usize| (self.low[i] <= other.high[i]) & (other.low[i] <= self.high[i]);
        meets(0) & meets(1)
    }

    #[inline]
    pub(super) fn holds(&self, at: [u32; 2]) -> bool {
        let holds = |i: usize| (self.low[i] <= at[i]) & (at[i] <= self.high[i]);
        holds(0) & holds(1)
    }

    /// Returns the fraction of `other` that this rectangle covers, from 0 to 1.
    pub fn share_of(&self, other: &Self) -> f64 {
        let share = |i: usize| {
            let (low, high) = (
                self.low[i].max(other.low[i]),
                self.high[i].min(other.high[i]),
            );
            f64::from((high + 1).saturating_sub(low)) / f64::from(other.high[i] + 1 - other.low[i])
        };
        share(0) * share(1)
    }

    /// Returns whether all of `other` lies in this rectangle.
    #[inline]
    pub fn contains(&self, other: &Self) -> bool {
        self.holds(other.low) && self.holds(other.high)
    }
}

impl CellGrid {
    /// Builds the grid for a camera's window.
    pub fn new(window: &Window<f64>) -> Self {
        let half = window.x.max(window.y) * ROOT_MARGIN;
        let mut grid = Self {
            least: -half,
            per_unit: f64::from(1 << LEVELS) / (2.0 * half),
            low: [0; 2],
            high: [0; 2],
        };
        let reach = [window.x, window.y];
        grid.low = reach.map(|reach| grid.unit(-reach).saturating_sub(1));
        grid.high = reach.map(|reach| grid.unit(reach) + 1);
        grid
    }

    /// Returns the unit of the grid that contains the coordinate `x`, or the nearest unit if `x` is
    /// outside of the grid. Returns the first unit for NaN.
    #[inline]
    fn unit(&self, x: f64) -> u32 {
        // Maximum of the result: the second-to-last unit of the grid. `CellGrid::high` is one unit
        // beyond the result and must still be a unit of the grid.
        const LAST: u32 = (1 << LEVELS) - 2;
        (((x - self.least) * self.per_unit) as u32).min(LAST)
    }

    /// Returns the grid units of the components X and Y of a ray's direction. Returns `None` if the
    /// direction is outside of the window.
    #[inline]
    pub(super) fn units(&self, r: &Direction<f64>) -> Option<[u32; 2]> {
        let at = [self.unit(r.x), self.unit(r.y)];
        let is_within = |axis: usize| self.low[axis] <= at[axis] && at[axis] <= self.high[axis];
        (is_within(0) && is_within(1)).then_some(at)
    }

    /// Converts ranges of the components X and Y of a ray's direction to a rectangle of the grid,
    /// widened by one unit on each side and clipped to the window. Returns `None` if the rectangle
    /// lies outside of the window.
    fn ends(&self, ranges: [Interval; 2]) -> Option<Rectangle> {
        let low = [0, 1].map(|i| {
            let low = self.unit(ranges[i].low).saturating_sub(1);
            low.max(self.low[i])
        });
        let high = [0, 1].map(|i| (self.unit(ranges[i].high) + 1).min(self.high[i]));
        (low[0] <= high[0] && low[1] <= high[1]).then_some(Rectangle { low, high })
    }

    /// Returns the rectangle of the grid that contains all rays through the rectangle `patch` of
    /// the view plane, clipped to the window. Returns `None` if `patch` lies outside of the window.
    pub fn rectangle(&self, patch: &Patch) -> Option<Rectangle> {
        let center = [patch.center.x, patch.center.y];
        self.ends([0, 1].map(|i| Interval::about(center[i], 0.5 * patch.sides[i])))
    }

    /// Converts the bounds of an object to units of the grid. Returns `None` if they lie outside of
    /// the window.
    pub fn item(&self, object: usize, extent: &Extent) -> Option<BoundedObject> {
        Some(BoundedObject {
            bounds: self.ends(extent.across)?,
            nearest: Nearness::above(extent.nearest),
            // The index fits into 32 bits, because 2^32 objects would not fit into memory.
            object: object as u32,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the grid is as fine as the window allows. With a coarser grid, too many objects
    /// would be found for each ray.
    #[test]
    fn a_window_has_nearly_all_units_along_its_longer_side() {
        for (x, y) in [(1.0, 1.0), (3e-6, 1e-6), (0.2, 50.0), (1e200, 1e199)] {
            let grid = CellGrid::new(&Window { x, y, z: 2.0 });
            let sides = [0, 1].map(|axis| f64::from(grid.high[axis] - grid.low[axis]));
            let all = f64::from(1 << LEVELS) / ROOT_MARGIN;
            for (side, reach) in sides.into_iter().zip([x, y]) {
                // Up to 4 units of difference are allowed, because the window is widened by a unit
                // on each side and its ends are rounded.
                assert!(
                    (side - all * reach / x.max(y)).abs() <= 4.0,
                    "{x}, {y}: {side}"
                );
            }
        }
    }
}
