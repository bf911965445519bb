//! Very many rows of the board at once, between two long sides.

use glam::DVec2;

use super::board::{Board, UNIT, form, measure};
use super::bulk::Bulk;
use super::cells::MANY;
use super::cutter::{Chord, Tally};
use super::euler::square_wave;
use super::modes::Lines;

/// What may be neglected of a side, in square pixels, and what is if that takes too long.
const NEGLECTED: f64 = 1e-10;
const AT_WORST: f64 = 4e-9;
/// No more rows than this, of a square each, are summed one by one for that.
const PATIENCE: f64 = 200_000.0;

/// What lies between two lines of the board and between two sides, on each of which m is linear.
///
/// Of s(c)·s(t)·J, J = K/m³, the integral along t from a side to infinity has one along the side from line to line.
pub(super) struct Block<'a> {
    board: &'a Board,
    along: usize,
    first: f64,
    last: f64,
    sides: [Side; 2],
}

/// A side where it begins and where it ends: its place along the rows, and m.
type Side = [[f64; 2]; 2];

impl<'a> Block<'a> {
    /// Between two lines, given where they cut a polygon; the rows run along an axis of the board.
    pub(super) fn new(
        board: &'a Board,
        along: usize,
        [first, last]: [f64; 2],
        chords: &[Chord; 2],
    ) -> Option<Self> {
        let point = |at: DVec2| {
            let depth = 1.0 / form(&board.below, at);
            [form(&board.across[along], at) * depth, depth]
        };
        let ends = |chord: Chord| {
            let [s, t] = chord?.map(point);
            Some(if s[0] <= t[0] { [s, t] } else { [t, s] })
        };
        let (from, to) = (ends(chords[0])?, ends(chords[1])?);
        Some(Self {
            board,
            along,
            first,
            last,
            sides: [0, 1].map(|i| [from[i], to[i]]),
        })
    }

    /// The lines that a side crosses between two of them.
    fn lines(&self, [start, end]: &Side, [first, last]: [f64; 2]) -> Lines {
        let rows = self.last - self.first;
        let [stride, rise] = [0, 1].map(|i| (end[i] - start[i]) / rows);
        Lines {
            t: start[0] + (first - self.first) * stride,
            stride,
            depth: start[1] + (first - self.first) * rise,
            rise,
            lines: last - first,
            slope: self.board.slope[self.along],
        }
    }
}

impl Bulk for Block<'_> {
    /// The part of it in which m changes little from row to row.
    fn smooth(&self) -> [f64; 2] {
        let [mut first, mut last] = [self.first, self.last];
        let factor = 2.0 * self.board.per_slope[1 - self.along].value;
        let [left, right] = self.sides;
        let length = (right[0][0] - left[0][0]).max(right[1][0] - left[1][0]);
        let most = (PATIENCE / (1.0 + 0.25 * length.clamp(0.0, MANY))).ceil();
        for side in &self.sides {
            let lines = self.lines(side, [self.first, self.last]);
            let start = lines.start(AT_WORST / factor);
            let missing = (start - lines.depth.min(side[1][1])) / lines.rise.abs();
            if missing > 0.0 {
                let rows = missing.ceil().min(most);
                if lines.rise > 0.0 {
                    first = first.max(self.first + rows);
                } else {
                    last = last.min(self.last - rows);
                }
            }
        }
        [first, last]
    }

    fn add(&self, ends: [f64; 2], piece: &[DVec2], tally: &mut Tally) {
        let across = 1 - self.along;
        let per_slope = self.board.per_slope[across];
        let factor = 2.0 * per_slope.value;
        let sign = square_wave(ends[0]) * self.board.slope[across].signum();
        let [p, q] = [self.along, across].map(|axis| self.board.slope[axis]);
        let (_, perimeter) = measure(piece.iter().copied());
        // The sides are those between points that are a few roundings off.
        let mut bound = 8.0 * UNIT * perimeter;
        let mut sum = 0.0;
        for (side, sense) in self.sides.iter().zip([-1.0, 1.0]) {
            let lines = self.lines(side, ends);
            let part = lines.sum(NEGLECTED / factor);
            sum += sense * part.value;
            // Roundings may have it that the slopes are not quite those of the side.
            let slopes = (lines.rise - (q + p * lines.stride)).abs() / q.abs();
            let relative = slopes + per_slope.bound;
            bound += factor * (part.bound + relative * part.value.abs());
        }
        tally.add(sign * factor * sum, bound);
        tally.has_inverse = true;
    }
}
