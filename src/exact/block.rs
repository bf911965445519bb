//! Very many rows of the board at once, between two long sides.

use glam::DVec2;

use super::board::{Board, Sum, UNIT, measure, size};
use super::bulk::Bulk;
use super::cells::MANY;
use super::cutter::{Chord, Tally};
use super::euler::square_wave;
use super::modes::{GRADUAL, Lines, MOST};
use crate::math::{Double, Real, two_product};
use std::f64::consts::PI;

/// What may be neglected of a side, in square pixels, and what is if that takes too long.
const NEGLECTED: f64 = 1e-10;
const AT_WORST: f64 = 4e-9;
/// What may be of both sides together, where rows are so narrow that their late modes hardly differ.
const NARROW_AT_WORST: f64 = 2e-8;
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
    /// The sign of what is beyond the first side, less what is beyond the second.
    sign: f64,
}

/// A side where it begins and where it ends: its place across the rows and along them, and m.
///
/// Far away all three are uncertain, but by the same factor 1/L, so that the slopes between them are not.
type Side = [[Double; 3]; 2];

impl<'a> Block<'a> {
    /// Between two lines, given where they cut a polygon; the rows run along an axis of the board.
    pub(super) fn new(
        board: &'a Board,
        along: usize,
        [first, last]: [f64; 2],
        chords: &[Chord; 2],
    ) -> Option<Self> {
        let across = 1 - along;
        let value = |[a, b, c]: [f64; 3], at: DVec2| {
            let terms = [two_product(a, at.x), two_product(b, at.y)];
            terms[0].plus(&terms[1]).plus(&Double::from_f64(c))
        };
        let point = |at: DVec2| {
            let level = value(board.below, at);
            let place = |axis: usize| value(board.across[axis], at).over(&level);
            let depth = Double::from_f64(1.0).over(&level);
            [place(across), place(along), depth]
        };
        // In the widest of views a row is so narrow that which of its sides is nearer is better known than which is before the
        // other: along it m and t differ by p times as much, and are as uncertain as 1 and N are.
        let [p, q] = [along, across].map(|axis| board.slope[axis]);
        let is_narrow = p.abs() * size(&board.across[along]) > 1.0;
        let order = if is_narrow { 2 } else { 1 };
        let ends = |chord: Chord| {
            let [s, t] = chord?.map(point);
            let is_ordered = !t[order].minus(&s[order]).is_negative();
            Some(if is_ordered { [s, t] } else { [t, s] })
        };
        let (from, to) = (ends(chords[0])?, ends(chords[1])?);
        Some(Self {
            board,
            along,
            first,
            last,
            sides: [0, 1].map(|i| [from[i], to[i]]),
            sign: q.signum() * if is_narrow { p.signum() } else { 1.0 },
        })
    }

    /// The lines that a side crosses between two of them, from the end that is nearer: which is the first of them, and 1, or −1 if
    /// c falls from there.
    fn lines(&self, [start, end]: &Side, [first, last]: [f64; 2], size: f64) -> (Lines, f64, f64) {
        let rows = end[0].minus(&start[0]);
        let slopes = [1, 2].map(|i| end[i].minus(&start[i]).over(&rows));
        let (near, from, sense) = if slopes[1].is_negative() {
            (end, last, -1.0)
        } else {
            (start, first, 1.0)
        };
        let missing = Double::from_f64(from).minus(&near[0]);
        let [t, depth] = [0, 1].map(|i| near[i + 1].plus(&missing.times(&slopes[i])).hi);
        let lines = Lines {
            t,
            stride: sense * slopes[0].hi,
            depth,
            rise: sense * slopes[1].hi,
            lines: last - first,
            slope: self.board.slope[self.along],
            size,
        };
        (lines, from, sense)
    }

    /// How far the roundings of a side's points and of the board's slopes may put off its modes.
    ///
    /// Values that are off by E_c, E_t and E_L of the forms put off t at some c by up to D·m, D = E_t + |τ|E_c + |t*|E_L, and m by
    /// up to R·m, R = |g|E_c + |m*|E_L, where t* and m* are those of the side where c is 0. The mode n of a line is 2K/|q| times
    /// 4/π²n² times e^(iπnt)·U, U = m⁻²·(F(y_c) − F(y_p)), and of that
    ///
    /// - t puts off πn·D·m·|U|, and 1/p, off by E, up to ½πn·E·m⁻¹, since |F′| is at most ½: the modes up to Q together
    ///   (4/π)·(1 + ½ ln Q) of it for n = 1, up to where (D + E)·m is 1 and they are off anyhow;
    /// - m, with |F| ≤ ½ and |yF′| ≤ 17/16, up to 2.1·R·m⁻² of both, and c, if a part C of it is missing, 1.1·C·m⁻², but no
    ///   more than F(y_c) is twice; Σ 4/π²n² is ½.
    ///
    /// The modes that are left out, as they are from side to side, are those of sides which are not off.
    fn uncertainty(&self, lines: &Lines, from: f64, sense: f64) -> f64 {
        let board = self.board;
        let across = 1 - self.along;
        // The factors are rounded, and in the end t, and what τ adds to it.
        let off = |form: &[f64; 3], roundings: f64| roundings * UNIT * size(form);
        let of_t = off(&board.across[self.along], 4.0);
        let of_c = off(&board.across[across], 1.0);
        let of_l = off(&board.below, 1.0);
        let Lines {
            t,
            stride,
            depth,
            rise,
            ..
        } = lines;
        let (t_0, m_0) = (t - sense * stride * from, depth - sense * rise * from);
        let moved = of_t + stride.abs() * of_c + t_0.abs() * of_l;
        let deeper = rise.abs() * of_c + m_0.abs() * of_l + 4.0 * UNIT;
        let flat = board.flat(self.along);
        let furthest = depth + rise * lines.lines;
        let count = lines.lines.min(depth / rise);
        // Σ m⁻², and Σ m⁻¹ as far as it matters.
        let squares = (1.0 + count) / (depth * depth);
        let deepest = furthest.min(1.0 / (moved + flat)).max(*depth);
        let inverses = (1.0 + count) / depth * (2.0 + libm::log(deepest / depth));
        // Over all rows the slopes are as uncertain as the ends.
        let slopes = 2.0 * furthest / lines.lines;
        let climb = slopes * (moved / stride.abs() + deeper / rise);
        let largest = lines.largest(*depth);
        let of_climb = (1.1 * climb).min(2.0 * (largest - 0.5));
        let modes = 4.0 / PI * (1.0 + 0.5 * libm::log(MOST));
        let Sum { value, bound } = board.per_slope[across];
        let relative = 0.5 * largest * (bound + 4.0 * UNIT) + 2.1 * deeper + 0.5 * of_climb;
        2.0 * value * (relative * squares + modes * (largest * moved + 0.5 * flat) * inverses)
    }
}

impl Bulk for Block<'_> {
    /// The part of it in which m changes little from row to row.
    fn smooth(&self) -> [f64; 2] {
        let [mut first, mut last] = [self.first, self.last];
        let factor = 2.0 * self.board.per_slope[1 - self.along].value;
        let [left, right] = self.sides;
        // Where m is smaller rows are summed one by one.
        let near = usize::from(left[0][2].hi > left[1][2].hi);
        let length = right[near][1].minus(&left[near][1]).hi.abs();
        let most = (PATIENCE / (1.0 + 0.25 * length.min(MANY))).ceil();
        // Beyond m there are no more than √2/m|∇L| square pixels.
        let steepness = libm::hypot(self.board.below[0], self.board.below[1]);
        let narrow = 1.5 / steepness * Lines::share_neglected() / NARROW_AT_WORST;
        for side in &self.sides {
            let (lines, _, sense) = self.lines(side, [self.first, self.last], f64::INFINITY);
            let start = lines
                .start(AT_WORST / factor)
                .min(narrow.max(GRADUAL * lines.rise));
            let missing = (start - lines.depth) / lines.rise;
            if missing > 0.0 {
                let rows = missing.ceil().min(most);
                if sense > 0.0 {
                    first = first.max(self.first + rows);
                } else {
                    last = last.min(self.last - rows);
                }
            }
        }
        [first, last]
    }

    fn add(&self, ends: [f64; 2], piece: &[DVec2], tally: &mut Tally) {
        let board = self.board;
        let across = 1 - self.along;
        let per_slope = board.per_slope[across];
        let factor = 2.0 * per_slope.value;
        let [p, q] = [self.along, across].map(|axis| board.slope[axis]);
        let (area, perimeter) = measure(piece.iter().copied());
        // A mode n of a row is, from side to side, ∫ m⁻³·e^(iπnt) dm: no more than half of m⁻² differs by between them, which by
        // 2K/|q| is twice the row's area.
        let size = 1.1 * area.abs() / factor;
        // The sides are those between points that are a few roundings off.
        let mut bound = 8.0 * UNIT * perimeter;
        // What is of the forms' inverse their rounding moves as a whole.
        let mut at_most = board.displaced(piece.iter().copied());
        let (mut sum, mut uncertain) = (0.0, 0.0);
        for (side, sense) in self.sides.iter().zip([-1.0, 1.0]) {
            let (lines, from, way) = self.lines(side, ends, size);
            let part = lines.sum(NEGLECTED / factor);
            sum += sense * square_wave(from) * part.value;
            bound += factor * part.bound;
            // Roundings may have it that the slopes are not quite those of the side.
            let slopes = (way * (lines.rise - p * lines.stride) - q).abs() / q.abs();
            at_most += factor * (slopes + per_slope.bound) * part.value.abs();
            uncertain += self.uncertainty(&lines, from, way);
        }
        let bound = bound + uncertain.min(at_most);
        if !(sum.is_finite() && bound < area.abs()) {
            // Out of the range of numbers, or not worth having.
            return tally.add(0.0, area.abs());
        }
        tally.add(self.sign * factor * sum, bound);
    }
}
