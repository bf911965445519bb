//! Integrates a checkerboard's sign, 1 on squares of one colour and −1 on the others, over a
//! polygon of few squares or of squares near the eye. Each square is cut out of the polygon.
//!
//! In: a convex polygon of the picture that does not reach the horizon. Out: the sum of the areas
//! of the squares in it, each multiplied by its sign, in square pixels, with an error bound. The
//! board has two families of lines, those between columns and those between rows of squares. The
//! lines of one family cut the polygon into strips, and the lines of the other family cut each
//! strip into squares (`clip`). The bound includes the area over which rounding may displace each
//! cut, and the rounding errors of the computed areas.

use glam::DVec2;

use super::{
    super::{
        budget::PixelBudget,
        clip::{measure, split},
    },
    homography::{BoundedSum, Homography, UNIT, form},
    special::square_wave,
};
use crate::math::two_sum;

/// Maximum number of corners that cutting may add to a polygon. Squares are cut off the polygon one
/// after another, and each cut changes the remaining polygon. If it gets more corners than the
/// maximum, cutting ends, and its area is added to the error bound. Exact cuts add at most two
/// corners, both on the line of the latest cut. Many more corners show that the lines are closer to
/// each other than rounding errors, so that cutting is useless.
const MAX_EXTRA_CORNERS: usize = 32;

/// Maximum absolute value of a board coordinate, in squares, in a polygon that is cut into squares.
/// A polygon with larger coordinates is not cut; its area is added to the error bound. Up to this
/// value, the numbers of a square and its neighbours are exact in `f64`.
const MAX_SQUARE: f64 = 1e15;

/// Integrates the board's sign over a convex polygon that does not reach the horizon, in square
/// pixels. The polygon is cut into the rows (or columns) of the board, and each row into squares.
/// Returns 0 with the polygon's area as the bound if the budget is too small for the rows or the
/// picture is cancelled. If the budget is too small for the squares of a row, the row adds 0 to the
/// value and its area to the bound.
pub(super) fn sum(board: &Homography, polygon: &[DVec2], budget: &PixelBudget) -> BoundedSum {
    let mut tally = CompensatedSum::default();
    let [mut rows, mut squares] = [0, 1].map(|family| Cutter::new(board, family));
    rows.start(polygon);
    squares.start(polygon);
    if squares.count() < rows.count() {
        std::mem::swap(&mut rows, &mut squares);
    }
    if !budget.try_charge(rows.count()) {
        return BoundedSum::unknown(polygon);
    }
    while let Some(row) = rows.next(&mut tally) {
        if budget.is_cancelled() {
            return BoundedSum::unknown(polygon);
        }
        squares.start(&rows.piece);
        if !budget.try_charge(squares.count()) {
            tally.add(0.0, measure(&rows.piece).0.abs());
            continue;
        }
        while let Some(square) = squares.next(&mut tally) {
            if budget.is_cancelled() {
                return BoundedSum::unknown(polygon);
            }
            let (area, perimeter) = measure(&squares.piece);
            // The area is half a sum with a term for each corner. A term is the difference of two
            // products of distances, each at most half the perimeter. A term is computed with three
            // roundings, and adding it to the sum is the fourth.
            let rounding = squares.piece.len() as f64 * UNIT * perimeter * perimeter;
            tally.add(
                square_wave(row) * square_wave(square) * area.abs(),
                rounding,
            );
        }
    }
    tally.sum()
}

/// Cutter of a convex polygon into strips, one after another. A strip lies between neighbouring
/// lines of one family of the board's lines (those between columns or between rows of squares).
/// `rest` is the part of the polygon that is not yet cut off.
struct Cutter {
    numerators: [f64; 3],
    denominator: [f64; 3],
    rest: Vec<DVec2>,
    piece: Vec<DVec2>,
    spare: Vec<DVec2>,
    /// Number of the next strip, and number of the last strip. `None` if the polygon is empty, or
    /// if a coordinate is [`MAX_SQUARE`] or more.
    strips: Option<(i64, i64)>,
    /// Maximum number of corners of the part of the polygon that is not yet cut off (`rest`). With
    /// more corners, the part is not cut any further.
    too_many: usize,
}

impl Cutter {
    fn new(board: &Homography, family: usize) -> Self {
        Self {
            numerators: board.numerators[family],
            denominator: board.denominator,
            rest: Vec::new(),
            piece: Vec::new(),
            spare: Vec::new(),
            strips: None,
            too_many: MAX_EXTRA_CORNERS,
        }
    }

    /// Starts cutting `polygon`: copies it to `rest`, the part that is not yet cut off, and finds
    /// its first and last strip.
    fn start(&mut self, polygon: &[DVec2]) {
        self.rest.clear();
        self.rest.extend(polygon);
        self.too_many = self.rest.len() + MAX_EXTRA_CORNERS;
        let place = |&at: &DVec2| form(&self.numerators, at) / form(&self.denominator, at);
        let places = || self.rest.iter().map(place);
        self.strips =
            (!self.rest.is_empty() && places().all(|at| at.abs() < MAX_SQUARE)).then(|| {
                let squares = places().map(|at| at.floor() as i64);
                squares.fold((i64::MAX, i64::MIN), |(low, high), i| {
                    (low.min(i), high.max(i))
                })
            });
    }

    /// Returns the number of strips that are left, or infinity if the polygon cannot be cut,
    /// because it is empty or a coordinate is not below [`MAX_SQUARE`].
    fn count(&self) -> f64 {
        self.strips
            .map_or(f64::INFINITY, |(first, last)| (last - first + 1) as f64)
    }

    /// Cuts the next strip, between the lines i and i + 1, off `rest`, the part of the polygon that
    /// is not yet cut off. Moves the strip to `piece`, adds the cut's error to `tally`, and returns
    /// i. Returns `None` if `rest` is empty or the polygon cannot be cut.
    fn next(&mut self, tally: &mut CompensatedSum) -> Option<f64> {
        let (i, last) = self.strips?;
        if self.rest.len() < 3 {
            return None;
        }
        self.strips = Some((i + 1, last));
        if i >= last {
            std::mem::swap(&mut self.piece, &mut self.rest);
            self.rest.clear();
            return Some(last as f64);
        }
        self.cut((i + 1) as f64, tally);
        Some(i as f64)
    }

    /// Cuts `rest`, the part of the polygon that is not yet cut off, along line `n`. Moves the part
    /// before the line to `piece`, and adds the cut's error to `tally`. If `rest` then has too many
    /// corners, adds its area to the error and empties it.
    fn cut(&mut self, n: f64, tally: &mut CompensatedSum) {
        let line: [f64; 3] = std::array::from_fn(|k| self.numerators[k] - n * self.denominator[k]);
        self.piece.clear();
        self.spare.clear();
        let chord = split(
            &self.rest,
            |at| form(&line, at),
            &mut self.piece,
            &mut self.spare,
        );
        std::mem::swap(&mut self.rest, &mut self.spare);
        if self.rest.len() > self.too_many {
            let (area, perimeter) = measure(&self.rest);
            let rounding = self.rest.len() as f64 * UNIT * perimeter * perimeter;
            tally.add(0.0, area.abs() + rounding);
            self.rest.clear();
        }
        let Some([from, to]) = chord else { return };
        let size = |k: usize| self.numerators[k].abs() + (n * self.denominator[k]).abs();
        // `off` is the maximum error of a value of the cutting line's form: three roundings of its
        // factors, and four of the value itself. Each rounding is relative to the sum of the
        // absolute values of the form's terms. The chord's end points are computed with four more
        // roundings, which are added to the error below.
        let off = 7.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2));
        let step = (to - from).abs();
        tally.bound += (off / line[0].abs().max(line[1].abs()) + 4.0 * UNIT) * (step.x + step.y);
    }
}

/// A compensated sum of many numbers with an error bound. The rounding errors of the additions are
/// collected in `rest` and added at the end.
#[derive(Default)]
struct CompensatedSum {
    value: f64,
    rest: f64,
    bound: f64,
}

impl CompensatedSum {
    fn add(&mut self, value: f64, bound: f64) {
        let sum = two_sum(self.value, value);
        self.value = sum.hi;
        self.rest += sum.lo;
        self.bound += bound;
    }

    fn sum(&self) -> BoundedSum {
        BoundedSum {
            value: self.value + self.rest,
            // `rest` is the sum of all earlier rounding errors. Adding it causes an error of at
            // most one unit roundoff, because the absolute value of the result is at most 1. The
            // error of `rest` itself is far below a second unit roundoff.
            bound: self.bound + 2.0 * UNIT,
        }
    }
}
