//! Very many rows of the board at once, between two long sides.

use glam::DVec2;

use super::board::{Board, Sum, UNIT, measure, size};
use super::bulk::{Bulk, sides};
use super::cells::MANY;
use super::cutter::{Chord, Tally};
use super::euler::square_wave;
use super::modes::{self, GRADUAL, Lines, MOST, NOT_IN_STEP};
use crate::math::{Double, Real};
use std::f64::consts::PI;

/// What may be neglected of a side, in square pixels, and what is if that takes too long.
const NEGLECTED: f64 = 5e-11;
const AT_WORST: f64 = 2e-10;
/// What may be of both sides together, where rows are so narrow that their late modes hardly differ.
const NARROW_AT_WORST: f64 = 4e-10;
/// No more rows than this, of a square each, are summed one by one for that.
const PATIENCE: f64 = 20_000.0;

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
        let value = |[a, b, c]: &[Double; 3], at: DVec2| {
            let terms = [(a, at.x), (b, at.y)].map(|(c, x)| c.times(&Double::from_f64(x)));
            terms[0].plus(&terms[1]).plus(c)
        };
        let point = |at: DVec2| {
            let level = value(&board.fine.forms[2], at);
            let place = |axis: usize| value(&board.fine.forms[axis], at).over(&level);
            let depth = Double::from_f64(1.0).over(&level);
            [place(across), place(along), depth]
        };
        let (sides, ahead) = sides(board, across, chords)?;
        Some(Self {
            board,
            along,
            first,
            last,
            sides: sides.map(|ends| ends.map(point)),
            sign: board.fine.floor.slope[across].signum() * ahead,
        })
    }

    /// The lines that a side crosses between two of them.
    fn run(&self, [start, end]: &Side, [first, last]: [f64; 2]) -> Run {
        let rows = end[0].minus(&start[0]);
        let [climb, rise] = [1, 2].map(|i| end[i].minus(&start[i]).over(&rows));
        let is_falling = rise.is_negative();
        let (near, from) = match is_falling {
            true => (end, last),
            false => (start, first),
        };
        let place = |c: f64| {
            let missing = Double::from_f64(c).minus(&near[0]);
            [
                near[1].plus(&missing.times(&climb)),
                near[2].plus(&missing.times(&rise)),
            ]
        };
        let step = match is_falling {
            true => [climb.negated(), rise.negated()],
            false => [climb, rise],
        };
        let slope = self.board.fine.floor.slope[self.along];
        let [t, depth] = place(from);
        Run {
            lines: Lines::new(&[t, depth], &step, &Double::from_f64(last - first), slope),
            from,
            first: t,
            sense: if is_falling { -1.0 } else { 1.0 },
            origin: place(0.0).map(|x| x.hi),
            stride: step[0],
        }
    }

    /// More of it than from one line to another, if the sides' modes together allow that.
    fn sooner(&self, [first, last]: [f64; 2], tolerance: f64) -> [f64; 2] {
        let allows = |ends: [f64; 2]| {
            let [left, right] = self.sides.each_ref().map(|side| self.run(side, ends));
            let is_gradual = |run: &Run| run.lines.depth >= GRADUAL * run.lines.rise;
            let step = self.in_step(&left, &right);
            is_gradual(&left)
                && is_gradual(&right)
                && step * NOT_IN_STEP <= tolerance
                && left.lines.is_even()
        };
        let (mut rows, most) = (0.0, (first - self.first).max(self.last - last));
        while rows < most {
            let ends = match first > self.first {
                true => [self.first + rows, last],
                false => [first, self.last - rows],
            };
            if ends[1] - ends[0] > GRADUAL && allows(ends) {
                return ends;
            }
            rows = 4.0 * rows + 16.0;
        }
        [first, last]
    }

    /// What the crossings of a mode add up to for both sides together, if that is less than for each.
    fn in_step(&self, left: &Run, right: &Run) -> f64 {
        if left.sense != right.sense {
            return f64::INFINITY;
        }
        let start = right.first.minus(&left.first).hi;
        let growth = right.stride.minus(&left.stride).hi;
        // In the widest of views nothing may be left of the differences but what their terms are off: as much at the first line, and at both ends
        // for what it grows by.
        let (mut off, mut off_by_line) = (0.0, 0.0);
        for run in [left, right] {
            let Lines {
                depth, rise, lines, ..
            } = run.lines;
            let moved = self.moved(run);
            off += moved * depth;
            off_by_line += moved * (2.0 * depth + rise * lines) / lines;
        }
        let growth = match start.abs() > off {
            true => growth * start.signum(),
            false => growth.abs(),
        };
        let apart = [start.abs() + off, growth + off_by_line];
        let q = self.board.fine.floor.slope[1 - self.along];
        let step = modes::between(&left.lines, &right.lines, apart, q);
        if step < left.lines.in_step() + right.lines.in_step() {
            step
        } else {
            f64::INFINITY
        }
    }

    /// How far a value of a form may be off: five operations make it of its terms, and five more t and what τ adds to it.
    fn off(&self, axis: usize) -> f64 {
        let form = self.board.fine.forms[axis].map(|c| c.hi);
        self.board.fine.rads[axis] + 16.0 * Double::UNIT * size(&form)
    }

    /// D: how far t may be off at some c, by m.
    fn moved(&self, run: &Run) -> f64 {
        let [of_t, of_c, of_l] = [self.along, 1 - self.along, 2].map(|axis| self.off(axis));
        of_t + run.stride.hi.abs() * of_c + run.origin[0].abs() * of_l
    }

    /// How far the roundings of a side's points and of the board's slopes may put off its modes.
    ///
    /// Values that are off by E_c, E_t and E_L of the forms put off t at some c by up to D·m, D = E_t + |τ|E_c + |t*|E_L, and m by
    /// up to R·m, R = |g|E_c + |m*|E_L, where t* and m* are those of the side where c is 0. The mode n of a line is 2K/|q| times
    /// 4/π²n² times e^(iπnt)·U, U = m⁻²·(F(y_c) − F(y_p)), and of that
    ///
    /// - t puts off πn·D·m·|U|, and 1/p, off by E, up to ½πn·E·m⁻¹, since |F′| is at most ½: the modes up to Q together
    ///   (4/π)·(1 + ½ ln Q) of it for n = 1, up to where (D + E)·m is 1 and they are off anyhow. 1/p puts off no more than 17/16·|pE|·m⁻²
    ///   either, since |yF′| is at most 17/16. Where all modes are summed at once (`kinks`), t puts off D·m⁻¹, and 1/p as much as if Q were |p|/m,
    ///   from where on the latter is less;
    /// - m, with |F| ≤ ½ and |yF′| ≤ 17/16, up to 2.1·R·m⁻² of both, and c, if a part C of it is missing, 1.1·C·m⁻², but no
    ///   more than F(y_c) is twice; Σ 4/π²n² is ½.
    ///
    /// The modes that are left out, as they are from side to side, are those of sides which are not off.
    fn uncertainty(&self, run: &Run) -> f64 {
        let board = self.board;
        let across = 1 - self.along;
        let off = |axis| self.off(axis);
        let (of_c, of_l) = (off(across), off(2));
        let Run {
            lines,
            stride,
            origin: [_, m_0],
            ..
        } = run;
        let Lines { depth, rise, .. } = lines;
        let moved = self.moved(run);
        let deeper = rise.abs() * of_c + m_0.abs() * of_l + 4.0 * UNIT;
        let flat = board.fine.floor.flat(self.along);
        let furthest = depth + rise * lines.lines;
        let count = lines.lines.min(depth / rise);
        // Σ m⁻², and Σ m⁻¹ as far as it matters.
        let squares = (1.0 + count) / (depth * depth);
        let deepest = furthest.min(1.0 / (moved + flat)).max(*depth);
        let inverses = (1.0 + count) / depth * (2.0 + libm::log(deepest / depth));
        // Over all rows the slopes are as uncertain as the ends; then each is rounded.
        let slopes = 2.0 * furthest / lines.lines;
        let exactly = deeper - 4.0 * UNIT;
        let climb = slopes * (moved / stride.hi.abs() + exactly / rise) + 4.0 * UNIT;
        let largest = lines.largest(*depth);
        let of_climb = (1.1 * climb).min(2.0 * (largest - 0.5));
        let slope = board.fine.floor.slope[self.along].abs();
        let modes = 4.0 / PI * (1.5 + 0.5 * libm::log(MOST.max(slope / depth)));
        let of_flat = (modes * 0.5 * flat * inverses).min(0.55 * flat * slope * squares);
        let Sum { value, bound } = board.fine.floor.per_slope[across];
        let relative = 0.5 * largest * (bound + 4.0 * UNIT) + 2.1 * deeper + 0.5 * of_climb;
        2.0 * value * (relative * squares + modes * largest * moved * inverses + of_flat)
    }
}

/// The lines that a side crosses, in the sense in which m grows.
struct Run {
    lines: Lines,
    /// Which of them is the first, and 1, or −1 if c falls from there.
    from: f64,
    sense: f64,
    /// t at the first.
    first: Double,
    /// t and m where c is 0.
    origin: [f64; 2],
    /// What t grows by from line to line.
    stride: Double,
}

impl Bulk for Block<'_> {
    /// The part of it in which m changes little from row to row.
    fn smooth(&self) -> [f64; 2] {
        let [mut first, mut last] = [self.first, self.last];
        let leeway = self.board.leeway;
        let [of_p, of_q] =
            [self.along, 1 - self.along].map(|axis| self.board.fine.floor.per_slope[axis].value);
        let factor = 2.0 * of_q;
        let [left, right] = self.sides;
        // Where m is smaller rows are summed one by one.
        let near = usize::from(left[0][2].hi > left[1][2].hi);
        let length = right[near][1].minus(&left[near][1]).hi.abs();
        let most = (PATIENCE / (1.0 + 0.25 * length.min(MANY))).ceil();
        // Beyond m there are no more than √2/m|∇L| square pixels.
        let steepness = libm::hypot(self.board.below[0], self.board.below[1]);
        let share = Lines::share_neglected() * of_q / of_p;
        let narrow = 1.5 / steepness * share / (NARROW_AT_WORST * leeway);
        for side in &self.sides {
            let Run { lines, sense, .. } = self.run(side, [self.first, self.last]);
            let start = lines
                .start(AT_WORST * leeway / factor)
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
        self.sooner([first, last], NARROW_AT_WORST * leeway / factor)
    }

    fn add(&self, ends: [f64; 2], piece: &[DVec2], tally: &mut Tally) {
        let board = self.board;
        let across = 1 - self.along;
        let per_slope = board.fine.floor.per_slope;
        let (of_p, factor) = (per_slope[self.along], 2.0 * per_slope[across].value);
        let (area, perimeter) = measure(piece.iter().copied());
        // The sides are those between points that are a few roundings off.
        let mut bound = 8.0 * UNIT * perimeter;
        let mut runs = self.sides.each_ref().map(|side| self.run(side, ends));
        let tolerance = NEGLECTED * board.leeway / factor;
        let most = MOST / board.leeway.sqrt();
        let [left, right] = &runs;
        let step = self.in_step(left, right);
        // What a mode has of a line c between the sides is e^(iπnt)·pY_p, from the one to the other p·∫ m⁻³·e^(iπnt) dt: at most |p|/K times
        // the row's area by dc, and over all lines, the ends by half, that of all of it but for what the trapezoidal rule is off; and what
        // the sides have each for itself.
        let rows = (area.abs() + bound) * (1.0 + of_p.bound) / of_p.value;
        let size = rows + left.lines.at_its_ends() + right.lines.at_its_ends();
        if step < f64::INFINITY {
            runs[0].lines.size = size;
        }
        bound += runs.iter().map(|run| self.uncertainty(run)).sum::<f64>();
        let [left, right] = &runs;
        let mut sum = 0.0;
        let mut add = |part: Sum, run: &Run| {
            sum += square_wave(run.from) * part.value;
            bound += factor * part.bound;
        };
        if step < f64::INFINITY {
            add(
                modes::sum(
                    &[(-1.0, &left.lines), (1.0, &right.lines)],
                    step,
                    tolerance,
                    most,
                ),
                left,
            );
        } else {
            let [first, second] = [left, right].map(|run| run.lines.sum(tolerance, most));
            add(
                Sum {
                    value: -first.value,
                    ..first
                },
                left,
            );
            add(second, right);
        }
        if !(sum.is_finite() && bound < area.abs()) {
            // Out of the range of numbers, or not worth having.
            return tally.add(0.0, area.abs());
        }
        tally.add(self.sign * factor * sum, bound);
    }
}
