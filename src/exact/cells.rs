//! The board's integral square by square: strips of squares, then the squares of each.

use glam::DVec2;

use super::board::{Board, Corner, Sum, form, measure};

/// The integral over a convex polygon that does not reach the horizon, by cutting it along every line of the board.
///
/// Rounding moves every side of every piece by at most the board's displacement, which bounds the error by that times
/// the pieces' perimeters.
pub(super) fn sum(board: &Board, corners: &[Corner]) -> Sum {
    let mut perimeters = 0.0;
    let mut value = 0.0;
    let mut columns = Cutter::new(corners.iter().map(|c| c.at));
    let [a, b] = &board.across;
    while let Some(column) = columns.next(a, &board.below) {
        let mut squares = Cutter::new(columns.piece.iter().copied());
        while let Some(row) = squares.next(b, &board.below) {
            let (area, perimeter) = measure(squares.piece.iter().copied());
            let sign = if (column ^ row) & 1 == 0 { 1.0 } else { -1.0 };
            value += sign * area.abs();
            perimeters += perimeter;
        }
    }
    Sum {
        value,
        bound: board.displacement * perimeters,
    }
}

/// A convex polygon from which one strip of squares after the other is cut off.
struct Cutter {
    rest: Vec<DVec2>,
    piece: Vec<DVec2>,
    spare: Vec<DVec2>,
    strips: Option<(i64, i64)>,
}

impl Cutter {
    fn new(points: impl Iterator<Item = DVec2>) -> Self {
        Self {
            rest: points.collect(),
            piece: Vec::with_capacity(8),
            spare: Vec::with_capacity(8),
            strips: None,
        }
    }

    /// Makes `piece` the part of the rest between the lines i and i + 1 of N/L, and returns i.
    fn next(&mut self, across: &[f64; 3], below: &[f64; 3]) -> Option<i64> {
        if self.rest.len() < 3 {
            return None;
        }
        let (i, last) = self
            .strips
            .unwrap_or_else(|| range(&self.rest, across, below));
        self.strips = Some((i + 1, last));
        self.piece.clear();
        if i >= last {
            std::mem::swap(&mut self.piece, &mut self.rest);
            return Some(last);
        }
        let n = (i + 1) as f64;
        let line = [
            across[0] - n * below[0],
            across[1] - n * below[1],
            across[2] - n * below[2],
        ];
        self.spare.clear();
        split(&self.rest, &line, &mut self.piece, &mut self.spare);
        std::mem::swap(&mut self.rest, &mut self.spare);
        Some(i)
    }
}

/// The first and the last strip that a polygon meets.
fn range(points: &[DVec2], across: &[f64; 3], below: &[f64; 3]) -> (i64, i64) {
    points.iter().fold((i64::MAX, i64::MIN), |(low, high), &p| {
        let i = (form(across, p) / form(below, p)).floor() as i64;
        (low.min(i), high.max(i))
    })
}

/// A convex polygon's parts on the negative and on the positive side of a line.
fn split(points: &[DVec2], line: &[f64; 3], negative: &mut Vec<DVec2>, positive: &mut Vec<DVec2>) {
    let Some(&last) = points.last() else { return };
    let mut before = (last, form(line, last));
    for &point in points {
        let side = form(line, point);
        if (side > 0.0 && before.1 < 0.0) || (side < 0.0 && before.1 > 0.0) {
            let at = before.0 + (point - before.0) * (before.1 / (before.1 - side));
            negative.push(at);
            positive.push(at);
        }
        if side <= 0.0 {
            negative.push(point);
        }
        if side >= 0.0 {
            positive.push(point);
        }
        before = (point, side);
    }
}
