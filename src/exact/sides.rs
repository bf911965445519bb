//! Sides of pixels that cross many lines of a board, each summed once for the two pixels that share it.
//!
//! A side's sum is that of the pixel to its left or above it, whichever of the two pixels asks: so no pixel depends on which
//! others were computed before it.

use std::collections::HashMap;

use glam::DVec2;

use super::{
    board::{Board, Corner, Sum, form},
    edge::Edge,
};

/// The sums that are known.
#[derive(Debug, Default)]
pub(super) struct Sides(HashMap<Side, Sum>);

/// A side of a pixel, from its near end on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Side {
    /// The checkerboard, as an object of the scene.
    board: usize,
    /// The near end, as a corner of the picture's pixels.
    near: [u32; 2],
    /// The step from there to the next corner.
    way: [i8; 2],
    /// Whether it ends on the horizon.
    is_endless: bool,
    /// Along which axis of the board it is summed.
    by_b: bool,
}

/// A side that crosses fewer lines is sooner summed than found.
const LONG: f64 = 24.0;

/// A pixel some of whose sides may be known.
pub(super) struct Known<'a> {
    pub sides: &'a mut Sides,
    pub board: usize,
    pub x: u32,
    pub y: u32,
    /// Whether the square [0, 1)² of the board as the pixel has it has the second colour.
    pub odd: bool,
    /// The same checkerboard in the pixel of another column and row, and whether that is so of its square [0, 1)².
    pub elsewhere: &'a dyn Fn(u32, u32) -> Option<(Board, bool)>,
}

impl Known<'_> {
    /// What an edge of the pixel's board sums up to, from near to far, if it is a long side of the pixel.
    pub fn sum(&mut self, board: &Board, edge: &Edge, ends: [&Corner; 2]) -> Option<Sum> {
        let [near, far] = ends;
        let side = (edge.lines() > LONG).then(|| self.side(edge, near, far))??;
        let sum = match self.sides.0.get(&side) {
            Some(sum) => *sum,
            None => {
                let sum = self.computed(side, board)?;
                self.sides.0.insert(side, sum);
                sum
            }
        };
        Some(by_color(sum, self.odd))
    }

    /// The side that an edge is: from a corner of the pixel along a side of it, to the next corner or into the horizon.
    fn side(&self, edge: &Edge, near: &Corner, far: &Corner) -> Option<Side> {
        let is_corner = |corner: &Corner| corner.at.abs() == DVec2::splat(0.5);
        let is_endless = far.depth.is_infinite();
        let way = far.at - near.at;
        let is_whole = is_corner(near) && (is_corner(far) || is_endless);
        if !is_whole || (way.x == 0.0) == (way.y == 0.0) {
            return None;
        }
        let corner = |at: u32, offset: f64| at + u32::from(offset > 0.0);
        let sign = |step: f64| i8::from(step > 0.0) - i8::from(step < 0.0);
        Some(Side {
            board: self.board,
            near: [corner(self.x, near.at.x), corner(self.y, near.at.y)],
            way: [sign(way.x), sign(way.y)],
            is_endless,
            by_b: edge.is_by_b(),
        })
    }

    /// The sum of a side as the pixel to its left or above it has it, if it can be seen from there; positive for the first colour.
    fn computed(&self, side: Side, own: &Board) -> Option<Sum> {
        let [x, y] = side.near;
        // The pixel whose lower right corner, lower left or upper right one the near end is.
        let column = if side.way[0] > 0 {
            x
        } else {
            x.saturating_sub(1)
        };
        let row = if side.way[1] > 0 {
            y
        } else {
            y.saturating_sub(1)
        };
        if [column, row] == [self.x, self.y] {
            return along(own, self.odd, side, [column, row]);
        }
        let (board, odd) = (self.elsewhere)(column, row)?;
        along(&board, odd, side, [column, row])
    }
}

/// The sum of a side of a pixel that has such a board.
fn along(board: &Board, odd: bool, side: Side, [column, row]: [u32; 2]) -> Option<Sum> {
    let [x, y] = side.near;
    let way = DVec2::new(f64::from(side.way[0]), f64::from(side.way[1]));
    let offset = |corner: u32, pixel: u32| f64::from(corner) - f64::from(pixel) - 0.5;
    let near = DVec2::new(offset(x, column), offset(y, row));
    let level = |at: DVec2| form(&board.below, at);
    let (here, there) = (level(near), level(near + way));
    let far = if side.is_endless {
        let t = (here / (here - there)).clamp(0.0, 1.0);
        board.corner(near + way * t, 0.0)
    } else {
        board.corner(near + way, there)
    };
    let near = board.corner(near, here);
    if !(near.depth > 0.0 && far.depth > 0.0) || near.depth.is_infinite() {
        return None;
    }
    let edge = Edge::along(board, &near, &far, side.by_b)?;
    let mut sum = edge.alone(board);
    // The other pixel that has it knows of its own roundings alone. Displaced, the side sweeps once what two points do there and back.
    let ends = [near.at, far.at].into_iter();
    sum.bound += (0.5 * board.displaced(ends.clone())).min(board.blurred(ends));
    Some(by_color(sum, odd))
}

/// From a sum that is positive for the square [0, 1)² to one for the first colour, and back.
fn by_color(sum: Sum, odd: bool) -> Sum {
    Sum {
        value: if odd { -sum.value } else { sum.value },
        ..sum
    }
}
