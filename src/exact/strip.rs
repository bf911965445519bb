//! Many squares of a row of the board at once.

use std::f64::consts::PI;

use glam::DVec2;

use super::board::{FAR, Sum, UNIT, form, measure};
use super::bulk::{Bulk, sides};
use super::cells::Row;
use super::cutter::{Chord, Tally};
use super::edge::MAX_TERMS;
use super::euler::{ORDERS, square_wave, waves};

/// Much of a row: what lies between two lines of the board, and between two sides on which m is linear.
///
/// A line at a has G(a) = K/2|q|·(m^−2 − M^−2) of J = K/m³ between the sides, where m and M are theirs, and s(a)·G has the
/// antiderivative Σ (−1)^k A_k+1(a) G^(k)(a). At a line of the board just the odd waves are not 0.
pub(super) struct Strip<'a> {
    row: &'a Row<'a>,
    first: f64,
    last: f64,
    sides: [Side; 2],
    /// Whether the first side is nearer (1) or the second one (−1).
    sign: f64,
}

/// A side of a strip: where it begins and ends along the row and m there, and the slope of m.
///
/// Far away both are uncertain, but by the same factor 1/L, so that the slope is not.
struct Side {
    start: [f64; 2],
    end: [f64; 2],
    slope: f64,
}

impl<'a> Strip<'a> {
    /// Between two lines, given where they cut the row's piece.
    pub(super) fn new(row: &'a Row, [first, last]: [f64; 2], chords: &[Chord; 2]) -> Option<Self> {
        let point = |at: DVec2| [row.place(at), 1.0 / form(&row.board.below, at)];
        let (sides, ahead) = sides(row.board, row.along, chords)?;
        let sides = sides.map(|ends| {
            let [start, end] = ends.map(point);
            Side {
                start,
                end,
                slope: (end[1] - start[1]) / (end[0] - start[0]),
            }
        });
        Some(Self {
            row,
            first,
            last,
            sides,
            sign: row.board.fine.floor.slope[1 - row.along].signum() * ahead,
        })
    }

    /// m on a side, from the end that is nearer.
    fn depth(&self, Side { start, end, slope }: &Side, i: f64) -> f64 {
        if i - self.first < self.last - i {
            start[1] + slope * (i - start[0])
        } else {
            end[1] + slope * (i - end[0])
        }
    }
}

impl Bulk for Strip<'_> {
    /// The part of it in which m changes little from line to line.
    fn smooth(&self) -> [f64; 2] {
        let [mut first, mut last] = [self.first, self.last];
        for Side { start, end, slope } in &self.sides {
            if *slope > 0.0 {
                first = first.max(self.first + (FAR - start[1] / slope).ceil());
            } else if *slope < 0.0 {
                last = last.min(self.last - (FAR + end[1] / slope).ceil());
            }
        }
        [first, last]
    }

    fn add(&self, [first, last]: [f64; 2], piece: &[DVec2], tally: &mut Tally) {
        let waves = waves::<MAX_TERMS, { MAX_TERMS + 2 }>(0.0);
        let mut sum = 0.0;
        let mut bound = 0.0;
        for (i, sense) in [(first, -1.0), (last, 1.0)] {
            for (side, half) in self.sides.iter().zip([1.0, -1.0]) {
                let end = self.potential(&waves, self.depth(side, i), side.slope);
                sum += sense * half * square_wave(i) * end.value;
                bound += end.bound;
            }
        }
        let (_, perimeter) = measure(piece.iter().copied());
        // The sides are those between points that are a few roundings off.
        bound += 8.0 * UNIT * perimeter;
        tally.add(self.sign * self.row.sign * sum, bound);
    }
}

impl Strip<'_> {
    /// Σ A_k+1(0)·(K/2|q|)·(k + 1)!·γ^k·m^(−2−k), with what it neglects: |A_n| ≤ ½π^(1−n), and G^(n−1) is monotonic.
    fn potential(&self, waves: &[f64; ORDERS], depth: f64, slope: f64) -> Sum {
        let board = self.row.board;
        let u = 1.0 / depth;
        let per_slope = board.fine.floor.per_slope[1 - self.row.along];
        let first = 0.5 * per_slope.value * u * u;
        // L is off by some roundings of its terms.
        let [x, y, z] = board.below.map(f64::abs);
        let off = 12.0 * UNIT * (0.5 * (x + y) + z) * depth;
        let (mut sum, mut factor) = (0.0, first);
        for k in 0..MAX_TERMS - 1 {
            sum += waves[k + 1] * factor;
            factor *= slope * u * (k + 2) as f64;
        }
        let neglected = 0.5 * factor.abs() / libm::pow(PI, (MAX_TERMS - 1) as f64);
        Sum {
            value: sum,
            bound: neglected + (per_slope.bound + off + 16.0 * UNIT) * first,
        }
    }
}
