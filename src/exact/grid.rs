//! The board's integral over a whole spot that no more than some lines of the board cross: most pixels of most pictures.
//!
//! The lines of one family, of which there are fewer, cut the spot into strips; in strip i the sign of their squares is σ_i. Beyond
//! line k of the other family lies the signed area W_k = Σ σ_i·|strip i ∩ H_k|, W_0 being all of it, and the sign changes from
//! line to line:
//!
//! ∬ s(a) s(b) dx dy = s_0·(W_0 + 2 Σ_k (−1)^k W_k).
//!
//! A strip's area beyond a line is ½ Σ (p − O) × (q − p)·f over the strip's sides from p to q, f being the part of the side that
//! lies beyond, if O is on the line: then what the line itself contributes is 0. So all lines take the same sum over
//! the same few sides, and are computed in lanes, which the compiler makes vectors of.

use std::array;

use glam::DVec2;
use multiversion::multiversion;

use super::board::{Sum, UNIT, form};
use crate::{math::floor, tracer::Board};

/// At most so many lines cut the spot into strips, ...
const STRIPS: usize = 12;
/// ... and so many cross those.
const MOST: f64 = 96.0;

/// Sides of strips: what the spot's four are cut into, and a chord for each line.
const SIDES: usize = 4 + 3 * STRIPS;

/// The square wave at a whole number below 2^63.
fn square_wave(n: f64) -> f64 {
    if n as i64 & 1 == 0 { 1.0 } else { -1.0 }
}

/// A family whose lines are farther away than this is left to others.
pub(super) const OUT_OF_REACH: f64 = 1e9;

/// How many lines are computed at once.
const LANES: usize = 8;

/// Of a line that is nearly the line at infinity no place in the spot can be told. Sums that are farther off than this are not given.
const FARTHEST_OFF: f64 = 1e-10;

/// The integral over the spot, positive where the board's square [0, 1)² is; `None` if too many lines cross it, or lines whose
/// places cannot be told.
pub(super) fn sum(board: &Board) -> Option<Sum> {
    let levels = CORNERS.map(|at| form(&board.below, at));
    if !levels.iter().all(|&level| level > 0.0) {
        return None;
    }
    let (a, b) = (
        Family::new(board, 0, &levels)?,
        Family::new(board, 1, &levels)?,
    );
    let (few, many) = if a.lines() <= b.lines() {
        (a, b)
    } else {
        (b, a)
    };
    if !(few.lines() <= STRIPS as f64 && many.lines() <= MOST) {
        return None;
    }
    let strips = Strips::new(&few)?;
    let sum = strips.beyond(&many, few.displacement());
    // Of squares as large as numbers can be products are lost.
    (sum.bound < FARTHEST_OFF && !sum.value.is_nan()).then_some(sum)
}

/// The corners of the spot, in the order of its boundary.
const CORNERS: [DVec2; 4] = super::polygon::PIXEL;

/// The lines of one family: where N − nℓ is 0 for a whole n.
struct Family<'a> {
    across: &'a [f64; 3],
    below: &'a [f64; 3],
    /// How far values of N and ℓ may be from the true ones.
    rads: [f64; 2],
    /// Between which lines each corner is, by the lower one.
    squares: [f64; 4],
    first: f64,
    last: f64,
}

impl<'a> Family<'a> {
    /// `None` if its lines are farther away than anything that is prepared for a spot.
    fn new(board: &'a Board, axis: usize, levels: &[f64; 4]) -> Option<Self> {
        let across = &board.across[axis];
        let places: [f64; 4] = array::from_fn(|i| form(across, CORNERS[i]) / levels[i]);
        if !places.iter().all(|place| place.abs() < OUT_OF_REACH) {
            return None;
        }
        let squares = places.map(floor);
        Some(Self {
            across,
            below: &board.below,
            rads: [board.rads[axis], board.rads[2]],
            squares,
            first: squares.into_iter().fold(OUT_OF_REACH, f64::min),
            last: squares.into_iter().fold(-OUT_OF_REACH, f64::max),
        })
    }

    /// How many lines cross the spot.
    fn lines(&self) -> f64 {
        self.last - self.first
    }

    fn line(&self, n: f64) -> [f64; 3] {
        array::from_fn(|k| self.across[k] - n * self.below[k])
    }

    /// How far a line may be from the computed one.
    ///
    /// A factor is off by a rounding of N's and one of ℓ's, by one of the product and one of the difference, and the form's value at a
    /// point by three roundings more. All of them together are less than 6 of the terms; and the gradient is
    /// no less than the greater of its two parts.
    #[inline(always)]
    fn off(&self, n: f64, line: &[f64; 3]) -> f64 {
        let size = |k: usize| self.across[k].abs() + (n * self.below[k]).abs();
        let [of_n, of_l] = self.rads;
        let value = 6.0 * UNIT * (0.5 * (size(0) + size(1)) + size(2)) + of_n + n.abs() * of_l;
        value / line[0].abs().max(line[1].abs())
    }

    /// The sum of all lines' displacements, and of those of the two beyond them, which roundings may have kept out of the spot.
    fn displacement(&self) -> f64 {
        let mut sum = 0.0;
        let mut n = self.first;
        while n <= self.last + 1.0 {
            sum += self.off(n, &self.line(n)) + 4.0 * UNIT;
            n += 1.0;
        }
        sum
    }
}

/// The spot cut into strips by the lines of one family, as sides with the signs of the strips that they bound.
struct Strips {
    sides: [Side; SIDES],
    count: usize,
}

/// A directed side, by its start and its length in x and y, with the sign of the strip to whose boundary it belongs; twice
/// that where it bounds two strips of opposite signs.
#[derive(Clone, Copy, Default)]
struct Side {
    start: DVec2,
    step: DVec2,
    sign: f64,
}

impl Strips {
    /// `None` where roundings do not let a line's chord be told.
    fn new(few: &Family) -> Option<Self> {
        let mut strips = Self {
            sides: [Side::default(); SIDES],
            count: 0,
        };
        // Where the boundary of the spot goes over each line upwards, and where downwards.
        let mut chords = [[None::<DVec2>; 2]; STRIPS];
        for (i, &corner) in CORNERS.iter().enumerate() {
            let next = (i + 1) % CORNERS.len();
            let end = CORNERS[next];
            let mut here = corner;
            let mut square = few.squares[i];
            while square != few.squares[next] {
                let up = few.squares[next] > square;
                let n = if up { square + 1.0 } else { square };
                let line = few.line(n);
                let [from, to] = [corner, end].map(|at| form(&line, at));
                let t = from / (from - to);
                let chord = chords.get_mut((n - few.first) as usize - 1)?;
                let at = corner + (end - corner) * t.clamp(0.0, 1.0);
                if t.is_nan() || chord[usize::from(!up)].replace(at).is_some() {
                    return None;
                }
                strips.push(here, at, square_wave(square));
                here = at;
                square += if up { 1.0 } else { -1.0 };
            }
            strips.push(here, end, square_wave(square));
        }
        let mut n = few.first + 1.0;
        for [up, down] in chords {
            if let (Some(up), Some(down)) = (up, down) {
                // The strip above runs along its chord from where the boundary leaves it to where it came in.
                strips.push(down, up, 2.0 * square_wave(n));
            }
            n += 1.0;
        }
        Some(strips)
    }

    fn push(&mut self, from: DVec2, to: DVec2, sign: f64) {
        if let Some(side) = self.sides.get_mut(self.count) {
            *side = Side {
                start: from,
                step: to - from,
                sign,
            };
            self.count += 1;
        }
    }

    /// The integral with the lines of the other family, where those of this one are displaced by so much.
    ///
    /// A line of the other family that is displaced by δ, and so is a value of its form at the ends of sides, moves the part of the
    /// strips beyond it by δ times its chords, which are √2 long in all. Besides, what is left out as the line itself no longer goes
    /// through O: of each strip ½·δ·(|O − X| + |O − Y|) for the ends X and Y of its chord. O is the line's foot of the spot's centre, so
    /// that no point of the line in the spot is farther from it than √½, and that is at most √½·δ. Twice over, since the sign changes,
    /// it is 2√2·δ and √2·δ for each strip: less than 3·δ·(1 + strips). Of roundings there are in each side three of each product
    /// of p − O, at most √2 long, and its step, and three of f and of its use.
    fn beyond(&self, many: &Family, displacement: f64) -> Sum {
        let sides = &self.sides[..self.count];
        let whole: f64 = sides
            .iter()
            .map(|side| side.sign * side.start.perp_dot(side.step))
            .sum();
        let (mut sum, mut off) = lines_of(sides, many);
        let last = [many.first, many.last + 1.0].map(|n| many.off(n, &many.line(n)));
        off += last[0] + last[1];
        sum += 0.5 * whole;
        let strips = ((sides.len() - 4) / 3 + 1) as f64;
        let lines = many.lines() + 1.0;
        let length: f64 = sides
            .iter()
            .map(|side| side.sign.abs() * (side.step.x.abs() + side.step.y.abs()))
            .sum();
        Sum {
            value: square_wave(many.first) * sum,
            bound: 3.0 * (off * (1.0 + strips) + displacement)
                + UNIT * lines * (16.0 * length + 8.0 * strips + 2.0 * lines),
        }
    }
}

/// 2 Σ (−1)^k W_k, and the sum of the lines' displacements.
#[multiversion(targets = "simd")]
fn lines_of(sides: &[Side], many: &Family) -> (f64, f64) {
    let (mut sums, mut offs) = ([0.0; LANES], [0.0; LANES]);
    let lines = many.lines() as usize;
    let mut done = 0;
    while done < lines {
        let k: [f64; LANES] = array::from_fn(|lane| (done + lane + 1) as f64);
        let n = k.map(|k| many.first + k);
        // Lines that there are not count for nothing.
        let signs: [f64; LANES] = array::from_fn(|lane| match done + lane {
            i if i >= lines => 0.0,
            i if i % 2 == 0 => -1.0,
            _ => 1.0,
        });
        let line: [[f64; LANES]; 3] =
            array::from_fn(|i| n.map(|n| many.across[i] - n * many.below[i]));
        let square: [f64; LANES] =
            array::from_fn(|j| line[0][j] * line[0][j] + line[1][j] * line[1][j]);
        let foot: [f64; LANES] = array::from_fn(|j| -line[2][j] / square[j]);
        let origin: [[f64; LANES]; 2] =
            array::from_fn(|i| array::from_fn(|j| foot[j] * line[i][j]));
        let mut area = [0.0; LANES];
        for side in sides {
            let end = side.start + side.step;
            area = array::from_fn(|j| {
                let value = |p: DVec2| (line[0][j] * p.x + line[1][j] * p.y) + line[2][j];
                let (here, there) = (value(side.start), value(end));
                let beyond = here.max(0.0) + there.max(0.0);
                // A side that lies on the line as a whole contributes nothing either way.
                let all = here.abs() + there.abs() + f64::MIN_POSITIVE;
                let arm = [side.start.x - origin[0][j], side.start.y - origin[1][j]];
                let twice = arm[0] * side.step.y - arm[1] * side.step.x;
                area[j] + side.sign * twice * (beyond / all)
            });
        }
        sums = array::from_fn(|j| sums[j] + signs[j] * area[j]);
        offs = array::from_fn(|j| {
            let off = many.off(n[j], &[line[0][j], line[1][j], line[2][j]]);
            offs[j] + signs[j].abs() * off
        });
        done += LANES;
    }
    (sums.iter().sum(), offs.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{board, polygon::PIXEL};
    use proptest::prelude::*;

    /// A board seen so that its forms have such slopes, in squares a spot, about a place.
    fn seen([a, b]: [[f64; 2]; 2], place: [f64; 2], tilt: [f64; 2]) -> Board {
        let below = [tilt[0], tilt[1], 1.0];
        let across = [(a, place[0]), (b, place[1])]
            .map(|([x, y], at)| [x + at * below[0], y + at * below[1], at]);
        Board {
            across,
            below,
            low: [[0.0; 3]; 3],
            rads: [0.0; 3],
            odd: false,
        }
    }

    #[test]
    fn one_line_and_two_that_cross_have_closed_forms() {
        // The line x = 1/4: three quarters of the spot are on the side of square 0.
        let one = seen([[1.0, 0.0], [0.0, 0.01]], [0.75, 0.5], [0.0; 2]);
        let sum = sum_of(&one);
        // In square (−…, 0) the sign is that of square 0 to the left of 1, where x < 1/4.
        assert!((sum.value - 0.5).abs() <= sum.bound, "{sum:?}");
        // x = 1/4 and y = −1/4, which cross: the signs of 3/4 · 3/4 + 1/4 · 1/4 against the rest.
        let two = seen([[1.0, 0.0], [0.0, 1.0]], [0.75, 1.25], [0.0; 2]);
        let sum = sum_of(&two);
        assert!((sum.value + 0.25).abs() <= sum.bound, "{sum:?}");
        // The diagonals x + y = 0 and x − y = 0 leave nothing.
        let four = seen([[1.0, 1.0], [1.0, -1.0]], [0.0; 2], [0.0; 2]);
        let sum = sum_of(&four);
        assert!(sum.value.abs() <= sum.bound, "{sum:?}");
        assert!(sum.bound < 2e-13);
    }

    #[test]
    fn what_lines_do_not_cross_or_too_many_do_is_left_to_others() {
        assert!(sum(&seen([[40.0, 0.0], [0.0, 40.0]], [0.5; 2], [0.0; 2])).is_none());
        assert!(sum(&seen([[0.0, 500.0], [0.1, 0.0]], [0.5; 2], [0.0; 2])).is_none());
        // The horizon is in the spot.
        assert!(sum(&seen([[1.0, 0.0], [0.0, 1.0]], [0.5; 2], [0.0, 2.5])).is_none());
        // All of the spot is on a line of one family.
        assert!(sum(&seen([[0.0; 2], [1.0, 0.0]], [0.0, 0.5], [0.0; 2])).is_none());
        let overflown = seen([[f64::MAX, 0.0], [0.0, f64::MAX]], [f64::MAX; 2], [0.0; 2]);
        assert!(sum(&overflown).is_none());
    }

    fn sum_of(board: &Board) -> Sum {
        sum(board).expect("few lines")
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]

        #[test]
        fn it_is_what_cutting_out_every_square_gives(
            a in prop::array::uniform2(-9.0..9.0f64),
            b in prop::array::uniform2(-30.0..30.0f64),
            place in prop::array::uniform2(-2.0..2.0f64),
            tilt in prop::array::uniform2(-0.6..0.6f64),
            whole in prop::bool::ANY,
        ) {
            // Lines through corners and along sides among them.
            let round = |x: f64| if whole { (2.0 * x).round() * 0.5 } else { x };
            let board = seen([a.map(round), b.map(round)], place.map(round), tilt);
            let Some(sum) = sum(&board) else { return Ok(()) };
            let other = board::Board::new(board.across, board.below).alone(&PIXEL);
            let off = (sum.value - other.value).abs();
            prop_assert!(off <= sum.bound + other.bound + 1e-13, "{sum:?} and {other:?}");
        }

        #[test]
        fn it_does_not_matter_which_family_cuts_the_strips(
            a in prop::array::uniform2(-9.0..9.0f64),
            b in prop::array::uniform2(-9.0..9.0f64),
            place in prop::array::uniform2(-2.0..2.0f64),
            tilt in prop::array::uniform2(-0.6..0.6f64),
        ) {
            let board = seen([a, b], place, tilt);
            let other = Board { across: [board.across[1], board.across[0]], ..board };
            if let (Some(sum), Some(other)) = (sum(&board), sum(&other)) {
                prop_assert!((sum.value - other.value).abs() <= sum.bound + other.bound);
            }
        }
    }
}
