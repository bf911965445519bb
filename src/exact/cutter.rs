//! Polygons cut into strips of squares, and their parts added up.

use glam::DVec2;

use super::board::{Board, Sum, UNIT, form, measure};
use crate::math::two_sum;

/// A cut adds a corner at most, and strips of one family two in all. Where so many more come together, lines are too close to
/// each other for their corners to be told apart.
const SPARE_CORNERS: usize = 32;

/// A row with fewer whole squares is cut square by square.
const FEW: f64 = 3.0;

/// A convex polygon from which one strip of squares after the other is cut off, along one axis of the board.
pub(super) struct Cutter {
    across: [f64; 3],
    below: [f64; 3],
    pub rest: Vec<DVec2>,
    pub piece: Vec<DVec2>,
    spare: Vec<DVec2>,
    strips: Option<(i64, i64)>,
    /// With how many corners nothing is said of what is left any more.
    too_many: usize,
    /// Where the lines on both sides of the piece cut the polygon.
    pub chords: [Chord; 2],
}

/// What a line has of a polygon: its ends, if it was met.
pub(super) type Chord = Option<[DVec2; 2]>;

impl Cutter {
    pub(super) fn new(board: &Board, axis: usize) -> Self {
        Self::of(board.across[axis], board.below)
    }

    fn of(across: [f64; 3], below: [f64; 3]) -> Self {
        Self {
            across,
            below,
            rest: Vec::new(),
            piece: Vec::new(),
            spare: Vec::new(),
            strips: None,
            too_many: SPARE_CORNERS,
            chords: [None; 2],
        }
    }

    /// Begins with a polygon.
    pub(super) fn start(&mut self, points: impl Iterator<Item = DVec2>) {
        self.rest.clear();
        self.rest.extend(points);
        self.too_many = self.rest.len() + SPARE_CORNERS;
        self.strips = self.range();
        self.chords = [None; 2];
    }

    /// Makes `piece` the part of the rest between the lines i and i + 1, and returns i.
    pub(super) fn next(&mut self, tally: &mut Tally) -> Option<f64> {
        if self.rest.len() < 3 {
            return None;
        }
        let (i, last) = self.strips?;
        self.strips = Some((i + 1, last));
        if i >= last {
            self.chords = [self.chords[1], None];
            std::mem::swap(&mut self.piece, &mut self.rest);
            self.rest.clear();
            return Some(last as f64);
        }
        self.cut((i + 1) as f64, tally);
        Some(i as f64)
    }

    /// The first and the last strip that the polygon meets; none if they are out of the range of numbers.
    fn range(&self) -> Option<(i64, i64)> {
        let mut range = None;
        for &p in &self.rest {
            let place = form(&self.across, p) / form(&self.below, p);
            if place.is_nan() || place.abs() > 1e18 {
                return None;
            }
            let i = place.floor() as i64;
            let (low, high) = range.unwrap_or((i, i));
            range = Some((low.min(i), high.max(i)));
        }
        range
    }

    /// How many strips are left.
    pub(super) fn count(&self) -> f64 {
        self.strips
            .map_or(f64::INFINITY, |(first, last)| (last - first + 1) as f64)
    }

    /// Another cutter that begins with the piece.
    pub(super) fn again(&self) -> Self {
        let mut again = Self::of(self.across, self.below);
        again.start(self.piece.iter().copied());
        again
    }

    /// Makes `piece` the part of the rest before the line n.
    pub(super) fn cut(&mut self, n: f64, tally: &mut Tally) {
        let line: [f64; 3] = std::array::from_fn(|k| self.across[k] - n * self.below[k]);
        self.piece.clear();
        self.spare.clear();
        let chord = split(&self.rest, &line, &mut self.piece, &mut self.spare);
        std::mem::swap(&mut self.rest, &mut self.spare);
        self.chords = [self.chords[1], chord];
        if self.rest.len() > self.too_many {
            let (area, perimeter) = measure(self.rest.iter().copied());
            tally.add(0.0, area.abs() + 4.0 * UNIT * perimeter * perimeter);
            self.rest.clear();
        }
        let Some([from, to]) = chord else { return };
        let size = |k: usize| self.across[k].abs() + (n * self.below[k]).abs();
        // The factors are off by three roundings of these, the form's value by four, and the point by four of its own.
        let off = 7.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2));
        let step = (to - from).abs();
        tally.bound += (off / line[0].abs().max(line[1].abs()) + 4.0 * UNIT) * (step.x + step.y);
    }

    /// The whole squares of the strip, as lines of the other axis count them, if there are some.
    pub(super) fn whole(&self, board: &Board, axis: usize) -> Option<[f64; 2]> {
        let [Some(lower), Some(upper)] = self.chords else {
            return None;
        };
        let [lower, upper] = [lower, upper].map(|chord| {
            let [s, t] = chord.map(|p| form(&board.across[axis], p) / form(&self.below, p));
            [s.min(t), s.max(t)]
        });
        let first = lower[0].max(upper[0]).ceil();
        let last = lower[1].min(upper[1]).floor();
        (last - first >= FEW).then_some([first, last])
    }
}

/// A convex polygon's parts on the negative and on the positive side of a line, and the line's chord.
pub(super) fn split(
    points: &[DVec2],
    line: &[f64; 3],
    negative: &mut Vec<DVec2>,
    positive: &mut Vec<DVec2>,
) -> Chord {
    let mut before = points.last().map(|&last| (last, form(line, last)))?;
    let mut chord: Chord = None;
    let mut meet = |at: DVec2| chord = Some([chord.map_or(at, |[first, _]| first), at]);
    for &point in points {
        let side = form(line, point);
        if (side > 0.0 && before.1 < 0.0) || (side < 0.0 && before.1 > 0.0) {
            let at = before.0 + (point - before.0) * (before.1 / (before.1 - side));
            negative.push(at);
            positive.push(at);
            meet(at);
        }
        if side <= 0.0 {
            negative.push(point);
        }
        if side >= 0.0 {
            positive.push(point);
        }
        if side == 0.0 {
            meet(point);
        }
        before = (point, side);
    }
    chord
}

/// A sum of many numbers, and what it is off. The numbers' own rounding is kept and added in the end.
#[derive(Default)]
pub(super) struct Tally {
    value: f64,
    rest: f64,
    bound: f64,
    /// Whether anything was computed of the forms' inverse.
    pub(super) has_inverse: bool,
}

impl Tally {
    pub(super) fn add(&mut self, value: f64, bound: f64) {
        let sum = two_sum(self.value, value);
        self.value = sum.hi;
        self.rest += sum.lo;
        self.bound += bound;
    }

    pub(super) fn sum(&self) -> Sum {
        Sum {
            value: self.value + self.rest,
            bound: self.bound + 2.0 * UNIT,
        }
    }
}
