//! The board's integral over a convex polygon that not very many lines cross, in double-double: for what roundings would leave in doubt.
//!
//! The same formula as that of `grid`: the lines of one family, of which there are fewer, cut the polygon into strips, and each line of the
//! other takes twice what lies beyond it from what came before. Where a polygon is seen grazing, hundreds of lines cross it, each of which
//! may be displaced by some roundings; here those are of 2⁻¹⁰². With great care a long and narrow polygon is cut across first: most lines
//! would miss most of its strips.

use std::array;

use glam::DVec2;
use multiversion::multiversion;

use super::board::{Board, Sum, UNIT, measure};
use super::euler::square_wave;
use super::grid::OUT_OF_REACH;
use crate::math::{Double, Real, two_sum};

/// Where there are more sides of strips by lines than so many for every square, most lines miss most strips.
const WASTEFUL: f64 = 12.0;
/// With no more lines than these, which are computed at once, nothing is gained by fewer.
const FEW_LINES: f64 = 2.0 * LANES as f64;

const ZERO: Double = Double { hi: 0.0, lo: 0.0 };

/// How many lines are computed at once.
const LANES: usize = 8;

/// What bounds the relative error of every operation here.
const OFF: f64 = 4.0 * Double::UNIT;

/// The integral over a polygon in the spot, positive where squares are however it is oriented; `None` if too many lines cross it, or lines
/// whose places cannot be told.
pub(super) fn sum(board: &Board, polygon: &[DVec2]) -> Option<Sum> {
    let corners: Vec<Point> = polygon.iter().map(|&at| Point::exactly(at)).collect();
    let area = (0..corners.len()).fold(ZERO, |sum, i| {
        sum.plus(&corners[i].cross(&corners[(i + 1) % corners.len()]))
    });
    let mut left = board.care.patience();
    let mut sum = in_pieces(board, &corners, f64::INFINITY, &mut left)?;
    if area.is_negative() {
        sum.value = -sum.value;
    }
    Some(sum)
}

/// The same, positive where squares are if the polygon runs in the positive sense; of all sides by lines so many are left to look at. Not
/// more lines may cross it than so many.
fn in_pieces(board: &Board, corners: &[Point], most: f64, left: &mut f64) -> Option<Sum> {
    let levels: Vec<Double> = corners
        .iter()
        .map(|at| value(&board.fine.forms[2], at))
        .collect();
    if !levels.iter().all(|level| level.hi > 0.0) {
        return None;
    }
    let (a, b) = (
        Family::new(board, 0, corners, &levels)?,
        Family::new(board, 1, corners, &levels)?,
    );
    let points = a.places.iter().zip(&b.places);
    let (area, _) = measure(points.map(|(&a, &b)| DVec2::new(a, b)));
    let lines = a.lines() + b.lines();
    let squares = lines + 1.0 + area.abs();
    let (few, many) = match a.lines() <= b.lines() {
        true => (a, b),
        false => (b, a),
    };
    let sides = corners.len() as f64 + 3.0 * few.lines();
    let all = sides * (many.lines() + 1.0);
    let is_wasteful = many.lines() > FEW_LINES && all > WASTEFUL * squares;
    if is_wasteful && board.care.cuts_long_ones() {
        let middle = (0.5 * (many.first + many.last)).floor() + 0.5;
        let halves = cut(corners, &many.line(middle));
        // A half has half of these lines; unless places are so uncertain that nothing is cut.
        if lines > most || halves.iter().any(|half| half.len() < 3) {
            return None;
        }
        let most = 0.8 * lines + 4.0;
        let mut sum = Sum::default();
        for half in halves {
            sum.add(in_pieces(board, &half, most, left)?);
            // What the addition leaves.
            sum.bound += UNIT * sum.value.abs();
        }
        // Both halves have the same corners on the cut, which a few roundings may keep off the sides.
        sum.bound += 16.0 * OFF;
        return Some(sum);
    }
    *left -= all;
    if *left < 0.0 {
        return None;
    }
    Some(Strips::new(&few, corners)?.beyond(&few, &many))
}

/// The parts of a convex polygon on either side of a line.
fn cut(corners: &[Point], line: &[Double; 3]) -> [Vec<Point>; 2] {
    let mut halves = [Vec::new(), Vec::new()];
    let values: Vec<Double> = corners.iter().map(|at| value(line, at)).collect();
    for (i, corner) in corners.iter().enumerate() {
        let next = (i + 1) % corners.len();
        let half = usize::from(values[i].is_negative());
        halves[half].push(*corner);
        if values[i].is_negative() != values[next].is_negative() {
            let t = values[i].over(&values[i].minus(&values[next]));
            let at = corner.towards(&corners[next], &t);
            for half in &mut halves {
                half.push(at);
            }
        }
    }
    halves
}

/// A point of the picture.
#[derive(Clone, Copy)]
struct Point {
    x: Double,
    y: Double,
}

impl Point {
    fn exactly(at: DVec2) -> Self {
        let [x, y] = [at.x, at.y].map(Double::from_f64);
        Self { x, y }
    }

    fn minus(&self, other: &Self) -> Self {
        Self {
            x: self.x.minus(&other.x),
            y: self.y.minus(&other.y),
        }
    }

    /// The point so far on the way to another.
    fn towards(&self, other: &Self, t: &Double) -> Self {
        let step = other.minus(self);
        Self {
            x: self.x.plus(&step.x.times(t)),
            y: self.y.plus(&step.y.times(t)),
        }
    }

    fn cross(&self, other: &Self) -> Double {
        let terms = [self.x.times(&other.y), self.y.times(&other.x)];
        terms[0].minus(&terms[1])
    }
}

fn value([a, b, c]: &[Double; 3], at: &Point) -> Double {
    a.times(&at.x).plus(&b.times(&at.y)).plus(c)
}

/// The lines of one family: where N − nL is 0 for a whole n.
struct Family<'a> {
    across: &'a [Double; 3],
    below: &'a [Double; 3],
    /// How far values of N and of L may be from the true ones.
    rads: [f64; 2],
    /// Where each corner is, in squares, and between which lines, by the lower one.
    places: Vec<f64>,
    squares: Vec<f64>,
    first: f64,
    last: f64,
}

impl<'a> Family<'a> {
    /// `None` if its lines are too far away for it.
    fn new(board: &'a Board, axis: usize, corners: &[Point], levels: &[Double]) -> Option<Self> {
        let (across, below) = (&board.fine.forms[axis], &board.fine.forms[2]);
        let (mut places, mut squares) = (Vec::new(), Vec::new());
        for (at, level) in corners.iter().zip(levels) {
            let place = value(across, at).over(level);
            places.push(place.hi);
            squares.push(place.floor().0.hi);
        }
        if !squares.iter().all(|square| square.abs() < OUT_OF_REACH) {
            return None;
        }
        Some(Self {
            across,
            below,
            rads: [board.fine.rads[axis], board.fine.rads[2]],
            first: squares.iter().copied().fold(OUT_OF_REACH, f64::min),
            last: squares.iter().copied().fold(-OUT_OF_REACH, f64::max),
            places,
            squares,
        })
    }

    /// How many lines cross the polygon.
    fn lines(&self) -> f64 {
        self.last - self.first
    }

    fn line(&self, n: f64) -> [Double; 3] {
        let n = Double::from_f64(n);
        array::from_fn(|k| self.across[k].minus(&self.below[k].times(&n)))
    }

    /// How far a line may be from the computed one: as in `grid`, with a rounding more of the factors, which are rounded themselves, and of
    /// the points where it cuts and is measured from.
    fn off(&self, n: f64) -> f64 {
        let size = |k: usize| self.across[k].hi.abs() + (n * self.below[k].hi).abs();
        let [of_n, of_l] = self.rads;
        let value = 8.0 * OFF * (0.5 * (size(0) + size(1)) + size(2)) + of_n + n.abs() * of_l;
        let [x, y, _] = self.line(n).map(|factor| factor.hi.abs());
        // Some roundings of f64 in the bound itself.
        1.001 * value / x.max(y) + 16.0 * OFF
    }

    /// The sum of all lines' displacements, and of those of the two beyond them, which roundings may have kept out of the polygon.
    fn displacement(&self) -> f64 {
        let (mut sum, mut n) = (0.0, self.first);
        while n <= self.last + 1.0 {
            sum += self.off(n);
            n += 1.0;
        }
        sum
    }
}

/// The strips that the lines of a family cut a polygon into.
struct Strips {
    points: Vec<Point>,
    sides: Vec<Side>,
}

/// A directed side of a strip from one point to another, with the strip's sign; twice that where it bounds two strips of opposite signs.
struct Side {
    ends: [usize; 2],
    step: Point,
    sign: f64,
    /// start × step.
    area: Double,
}

impl Strips {
    /// `None` where roundings do not let a line's chord be told.
    fn new(few: &Family, corners: &[Point]) -> Option<Self> {
        let mut strips = Self {
            points: corners.to_vec(),
            sides: Vec::new(),
        };
        // Where the boundary goes over each line upwards, and where downwards.
        let mut chords = vec![[None::<usize>; 2]; few.lines() as usize];
        for (i, corner) in corners.iter().enumerate() {
            let next = (i + 1) % corners.len();
            let (mut here, mut square) = (i, few.squares[i]);
            while square != few.squares[next] {
                let up = few.squares[next] > square;
                let n = if up { square + 1.0 } else { square };
                let line = few.line(n);
                let [from, to] = [i, next].map(|end| value(&line, &corners[end]));
                let t = from.over(&from.minus(&to));
                let t = match t.hi {
                    t if t.is_nan() => return None,
                    ..0.0 => ZERO,
                    1.0.. => Double::from_f64(1.0),
                    _ => t,
                };
                let at = strips.points.len();
                strips.points.push(corner.towards(&corners[next], &t));
                let chord = chords.get_mut((n - few.first) as usize - 1)?;
                if chord[usize::from(!up)].replace(at).is_some() {
                    return None;
                }
                strips.push([here, at], square_wave(square));
                here = at;
                square += if up { 1.0 } else { -1.0 };
            }
            strips.push([here, next], square_wave(square));
        }
        let mut n = few.first + 1.0;
        for [up, down] in chords {
            // The strip above runs along its chord from where the boundary leaves it to where it came in.
            strips.push([down?, up?], 2.0 * square_wave(n));
            n += 1.0;
        }
        Some(strips)
    }

    fn push(&mut self, ends: [usize; 2], sign: f64) {
        let [start, end] = ends.map(|end| self.points[end]);
        let step = end.minus(&start);
        self.sides.push(Side {
            ends,
            step,
            sign,
            area: start.cross(&step),
        });
    }

    /// The integral with the lines of the other family.
    ///
    /// What displaced lines change is as in `grid`. Of roundings there are in each term, (p − O) × step·f, of which both parts are at most 1.5
    /// times the step, no more than 16, and one of each sum of those.
    fn beyond(&self, few: &Family, many: &Family) -> Sum {
        let whole = self.sides.iter().fold(ZERO, |sum, side| {
            sum.plus(&side.area.times(&Double::from_f64(side.sign)))
        });
        let sum = lines_of(self, many).plus(&whole.scaled(-1));
        let strips = few.lines() + 1.0;
        let lines = many.lines() + 1.0;
        let length: f64 = self.sides.iter().map(Side::length).sum();
        let roundings = 1.5 * lines * length * (16.0 + lines + self.sides.len() as f64);
        let displaced = many.displacement() * (1.0 + strips) + few.displacement();
        Sum {
            value: square_wave(many.first) * sum.hi,
            bound: 3.0 * displaced + OFF * roundings + UNIT * sum.hi.abs(),
        }
    }
}

impl Side {
    fn length(&self) -> f64 {
        self.sign.abs() * (self.step.x.hi.abs() + self.step.y.hi.abs())
    }
}

/// 2 Σ (−1)^k W_k.
#[multiversion(targets = "simd")]
fn lines_of(strips: &Strips, many: &Family) -> Double {
    let lines = many.lines() as usize;
    let mut values = vec![Lanes::of(|_| ZERO); strips.points.len()];
    let mut sum = ZERO;
    for done in (0..lines).step_by(LANES) {
        let line: [Lanes; 3] = array::from_fn(|k| {
            Lanes::of(|lane| {
                let n = Double::from_f64(many.first + (done + lane + 1) as f64);
                many.across[k].minus(&many.below[k].times(&n))
            })
        });
        for (value, at) in values.iter_mut().zip(&strips.points) {
            *value = Lanes::of(|i| {
                let [a, b, c] = line.each_ref().map(|factor| factor.get(i));
                a.times(&at.x).plus(&b.times(&at.y)).plus(&c)
            });
        }
        let origin: [Lanes; 2] = {
            let foot = Lanes::of(|i| {
                let [a, b, c] = line.each_ref().map(|factor| factor.get(i));
                quotient(&c, &a.times(&a).plus(&b.times(&b))).negated()
            });
            array::from_fn(|k| Lanes::of(|i| foot.get(i).times(&line[k].get(i))))
        };
        let mut area = Lanes::of(|_| ZERO);
        for side in &strips.sides {
            let [here, there] = side.ends.map(|end| values[end]);
            area = Lanes::of(|i| {
                let (here, there) = (here.get(i), there.get(i));
                let beyond = positive(&here).plus(&positive(&there));
                let all = size(&here).plus(&size(&there));
                let all = Double {
                    hi: all.hi + f64::MIN_POSITIVE,
                    lo: all.lo,
                };
                let arm = [0, 1].map(|k| origin[k].get(i));
                let moved = arm[0]
                    .times(&side.step.y)
                    .minus(&arm[1].times(&side.step.x));
                let twice = side.area.minus(&moved);
                let part = twice.times(&quotient(&beyond, &all));
                // The signs are ±1 and ±2.
                let part = Double {
                    hi: part.hi * side.sign,
                    lo: part.lo * side.sign,
                };
                area.get(i).plus(&part)
            });
        }
        for i in 0..LANES.min(lines - done) {
            sum = match (done + i) % 2 {
                0 => sum.minus(&area.get(i)),
                _ => sum.plus(&area.get(i)),
            };
        }
    }
    sum
}

/// Several numbers, side by side so that the compiler makes vectors of them.
#[derive(Clone, Copy)]
struct Lanes {
    hi: [f64; LANES],
    lo: [f64; LANES],
}

impl Lanes {
    #[inline(always)]
    fn of(number: impl Fn(usize) -> Double) -> Self {
        let (mut hi, mut lo) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            Double {
                hi: hi[i],
                lo: lo[i],
            } = number(i);
        }
        Self { hi, lo }
    }

    #[inline(always)]
    fn get(&self, i: usize) -> Double {
        Double {
            hi: self.hi[i],
            lo: self.lo[i],
        }
    }
}

#[inline(always)]
fn positive(x: &Double) -> Double {
    let factor = if x.hi > 0.0 { 1.0 } else { 0.0 };
    Double {
        hi: x.hi * factor,
        lo: x.lo * factor,
    }
}

#[inline(always)]
fn size(x: &Double) -> Double {
    let sign = 1.0_f64.copysign(x.hi);
    Double {
        hi: x.hi * sign,
        lo: x.lo * sign,
    }
}

/// A quotient with a correction less than that of [`Double`]: the first one's product is off by 5u², and what it leaves, which is about u of
/// it, by less than 4u.
#[inline(always)]
fn quotient(a: &Double, b: &Double) -> Double {
    let first = a.hi / b.hi;
    let rest = a.minus(&b.times(&Double::from_f64(first)));
    two_sum(first, rest.hi / b.hi)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use proptest::prelude::*;

    use super::*;
    use crate::exact::{care::Care, cells, polygon::PIXEL};

    fn board([a, b]: [[f64; 2]; 2], place: [f64; 2], tilt: [f64; 2]) -> Board {
        let below = [tilt[0], tilt[1], 1.0];
        let across = [(a, place[0]), (b, place[1])]
            .map(|([x, y], at)| [x + at * below[0], y + at * below[1], at]);
        Board::new(across, below)
    }

    #[test]
    fn squares_a_thousandth_of_the_spot() {
        // Of 100.5 squares by 100.5 there is left a quarter of one.
        let seen = board([[100.5, 0.0], [0.0, 100.5]], [50.25; 2], [0.0; 2]);
        let mirrored: Vec<DVec2> = PIXEL.into_iter().rev().collect();
        for polygon in [&PIXEL[..], &mirrored] {
            let found = sum(&seen, polygon).expect("few lines");
            let error = (found.value - 0.25 / (100.5 * 100.5)).abs();
            assert!(error <= found.bound && found.bound < 2e-16, "{found:?}");
        }
    }

    #[test]
    fn too_many_lines_and_the_horizon_are_left_to_others() {
        let many = board([[900.0, 0.0], [0.0, 900.0]], [0.5; 2], [0.0; 2]);
        let endless = board([[1.0, 0.0], [0.0, 1.0]], [0.5; 2], [0.0, 2.5]);
        let far = board([[1.0, 0.0], [0.0, 1.0]], [1e10; 2], [0.0; 2]);
        for board in [many, endless, far] {
            assert!(sum(&board, &PIXEL).is_none());
        }
    }

    #[test]
    fn a_long_and_narrow_polygon_in_pieces() {
        // Some 1400 lines of either family pass between its long sides, a few at a time.
        let mut seen = board([[1000.0, 930.0], [-1000.0, 940.0]], [0.3, -0.2], [0.1, 0.0]);
        let polygon = [(-0.5, -0.001), (0.5, -0.002), (0.5, 0.001), (-0.5, 0.002)];
        let polygon = polygon.map(|(x, y)| DVec2::new(x, y));
        assert!(sum(&seen, &polygon).is_none());
        seen.care = Care::Great;
        let whole = sum(&seen, &polygon).expect("few squares");
        assert!(whole.bound < 1e-14, "{whole:?}");
        // Cut by hand into sixteen, each with few lines.
        seen.care = Care::Usual;
        let at = |x: f64| {
            let [p, q, r, s] = polygon;
            [p.lerp(q, x), s.lerp(r, x)]
        };
        let mut parts = Sum::default();
        for i in 0..16 {
            let [[p, s], [q, r]] = [i, i + 1].map(|i| at(f64::from(i) / 16.0));
            parts.add(sum(&seen, &[p, q, r, s]).expect("few lines"));
        }
        // Corners of these are rounded.
        let off = (whole.value - parts.value).abs();
        assert!(
            off <= whole.bound + parts.bound + 32.0 * UNIT,
            "{whole:?}, not {parts:?}"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn it_is_what_cutting_out_every_square_gives(
            a in prop::array::uniform2(-20.0..20.0_f64),
            b in prop::array::uniform2(-60.0..60.0_f64),
            place in prop::array::uniform2(-2.0..2.0_f64),
            tilt in prop::array::uniform2(-0.99..0.99_f64),
            cut in 0.1..1.0_f64,
            whole in prop::bool::ANY,
        ) {
            // Lines through corners and along sides among them.
            let round = |x: f64| if whole { (2.0 * x).round() * 0.5 } else { x };
            let tilt = tilt.map(|x| 0.5 * x);
            let seen = board([a.map(round), b.map(round)], place.map(round), tilt.map(round));
            let [p, q, r, s] = PIXEL;
            let polygon = [p, q, q.lerp(r, cut), s.lerp(r, cut), s];
            let Some(found) = sum(&seen, &polygon) else { return Ok(()) };
            let corners = seen.visible(&polygon);
            let other = cells::sum(&seen, &corners, &AtomicBool::new(false));
            // Of a line that is nowhere or everywhere nothing is told.
            let told = [found, other].iter().all(|sum| sum.value.is_finite() && sum.bound.is_finite());
            prop_assume!(told || !whole);
            let off = (found.value - other.value).abs();
            prop_assert!(off <= found.bound + other.bound, "{found:?} and {other:?}");
            prop_assert!(whole || found.bound < 1e-15, "{found:?}");
        }
    }
}
