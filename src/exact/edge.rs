//! The board's integral over a region of many squares, along the region's boundary.
//!
//! With the waves A_k of `euler` and J = K/m³, P = Σ_j (−1)^j A_j+1(a) ∂_a^j J, of n terms, has ∂_a P = s(a)·J up to
//! ±A_n(a) ∂_a^n J. By Green's theorem ∬ s(a) s(b) J da db = ∮ s(b) P db. Likewise Q = Σ_k (−1)^k A_k+1(b) ∂_b^k J, and
//! Ψ = ΣΣ (−1)^(j+k) A_j+1(a) A_k+1(b) ∂_a^j ∂_b^k J, j + k < n, has dΨ = s(a) Q da + s(b) P db up to terms of order n.
//! On an edge, where m grows by γ for a unit of b, X = −K Σ_k (k+1)!/2 · S_k A_k+1(b) m^(−2−k), k = 1 … n, with S_1 = 1
//! and S_k+1 = γ·S_k + (∂m/∂b)^k, has dX/db = −Q up to order n. Hence with ρ = da/db
//!
//! ∫ s(b) P db = ΔΨ − ∫ s(a) Q da = ΔΨ + ρ ∫ s(a) dX, and with the roles exchanged = −(db/da) ∫ s(b) dX′(a),
//!
//! and ∫ s(a) dX is [s(a)·X] less the jumps of s(a) times X: an edge costs as many terms as it crosses lines of one family,
//! and the family that it crosses less may be chosen.

use super::board::{Board, Corner, Sum, UNIT, measure};
use super::complex::turn_exactly;
use super::euler::{waves, waves_at};
use super::horizon;
use crate::math::{Double, Real};
use std::f64::consts::PI;

use multiversion::multiversion;

/// The most terms of the asymptotic series.
pub(super) const MAX_TERMS: usize = 20;
/// The series is long enough when what it neglects is below this, in square pixels.
const TRUNCATION: f64 = 1e-14;

/// In a sum over crossings so many are added on their own, as the terms' signs alternate; and the place of the first of so many is told more
/// exactly.
const LANES: usize = 8;
const CHUNK: usize = 64;

/// (k + 1)!/2.
pub(super) const HALF_FACTORIAL: [f64; MAX_TERMS + 2] = {
    let mut all = [0.5; MAX_TERMS + 2];
    let mut k = 1;
    while k < MAX_TERMS + 2 {
        all[k] = all[k - 1] * (k + 1) as f64;
        k += 1;
    }
    all
};

/// The integral over a convex polygon of which every square is far away, which may reach to the horizon.
pub(super) fn sum(board: &Board, corners: &[Corner]) -> Sum {
    if corners.len() < 3 {
        return Sum::default();
    }
    let (area, _) = measure(corners.iter().map(|c| c.at));
    let edges: Vec<Option<Edge>> = (0..corners.len())
        .map(|i| Edge::new(board, &corners[i], &corners[(i + 1) % corners.len()]))
        .collect();
    let nearest = corners.iter().fold(f64::INFINITY, |m, c| m.min(c.depth));
    let (terms, truncation) = terms(board, nearest, &edges, area.abs());
    let mut sum = Sum {
        value: 0.0,
        bound: truncation + board.blurred(corners.iter().map(|c| c.at)),
    };
    for (i, edge) in edges.iter().enumerate() {
        let mut ends = 0.0;
        if let Some(edge) = edge {
            let part = edge.integral(board, terms);
            sum.value += edge.sign * part.value;
            sum.bound += part.bound;
            ends -= edge.potential;
        }
        if let Some(before) = &edges[(i + corners.len() - 1) % corners.len()] {
            ends += before.potential;
        }
        if ends != 0.0 && corners[i].depth.is_finite() {
            let (psi, size) = potential(board, &corners[i], terms);
            sum.value += ends * psi;
            sum.bound += (16.0 * UNIT + 2.0 * board.floor.misfit) * size;
        }
    }
    sum.value *= board.floor.handed * area.signum();
    sum
}

/// How many terms the series needs, and what it then neglects.
///
/// With |A_k| ≤ ½π^(1−k), what P neglects integrates to at most ½π^(1−n)·(n+2)!/2·(|p|/m)^n times the area in the picture,
/// and what Ψ and X neglect on an edge to n·π^(1−n)·(n+2)!/2·(g/m)^n·∫ J |dt|, where g is the largest of m's slopes along
/// the edge and along its parameter t, and ∫ J |dt| ≤ J·min(|Δt|, m/2γ) at the near end.
fn terms(board: &Board, nearest: f64, edges: &[Option<Edge>], area: f64) -> (usize, f64) {
    let slope = board.floor.slope[0].abs().max(board.floor.slope[1].abs());
    let (mut ratio, mut weight) = (slope / nearest, 0.0);
    for edge in edges.iter().flatten() {
        ratio = ratio.max(edge.climb.abs() / edge.depth);
        let reach = edge.length.abs().min(0.5 * edge.depth / edge.climb.abs());
        weight += board.floor.density / (edge.depth * edge.depth * edge.depth) * reach;
    }
    let neglected = |n: usize, power: f64| {
        HALF_FACTORIAL[n + 1] * power * PI * (0.5 * area + n as f64 * weight)
    };
    let step = ratio / PI;
    let mut power = step * step;
    let mut best = (2, neglected(2, power));
    for n in 3..=MAX_TERMS {
        if best.1 <= TRUNCATION {
            break;
        }
        power *= step;
        let bound = neglected(n, power);
        if bound < best.1 {
            best = (n, bound);
        }
    }
    best
}

/// Ψ at a corner, and its size before anything cancels.
fn potential(board: &Board, corner: &Corner, terms: usize) -> (f64, f64) {
    match terms {
        0..=2 => potential_of::<2, 4>(board, corner, terms),
        3..=4 => potential_of::<4, 6>(board, corner, terms),
        5..=7 => potential_of::<7, 9>(board, corner, terms),
        8..=12 => potential_of::<12, 14>(board, corner, terms),
        _ => potential_of::<MAX_TERMS, { MAX_TERMS + 2 }>(board, corner, terms),
    }
}

fn potential_of<const MOST: usize, const ROWS: usize>(
    board: &Board,
    corner: &Corner,
    terms: usize,
) -> (f64, f64) {
    let u = 1.0 / corner.depth;
    let [a, b] = [0, 1].map(|i| {
        let mut waves = waves::<MOST, ROWS>(turned(&corner.place(i)));
        let mut power = 1.0;
        for wave in &mut waves[1..=terms] {
            *wave *= power;
            power *= board.floor.slope[i] * u;
        }
        waves
    });
    let mut sum = 0.0;
    for degree in 0..terms {
        let mut row = 0.0;
        for j in 0..=degree {
            row += a[j + 1] * b[degree - j + 1];
        }
        sum += HALF_FACTORIAL[degree + 1] * row;
    }
    let density = board.floor.density * u * u * u;
    (density * sum, density)
}

/// A place without whole turns, in half turns.
fn turned(place: &Double) -> f64 {
    turn_exactly(place).to_f64()
}

/// The last whole number before a place, and s there.
fn floor(place: &Double) -> (Double, f64) {
    let (square, is_odd) = place.floor();
    (square, if is_odd { -1.0 } else { 1.0 })
}

/// An edge from its near end to its far one. `c` counts the lines of the family that it crosses less, t those of the other.
pub(super) struct Edge {
    /// +1 or −1 where the boundary runs from near to far or back, times the sign before ρ ∫ s dX.
    sign: f64,
    /// How Ψ at the edge's end, in the boundary's sense, counts: 1 where t is b, else 0.
    potential: f64,
    c: Double,
    t: Double,
    pub depth: f64,
    /// The far end's c, t and m, unless it is on the horizon.
    end: Option<(Double, Double, f64)>,
    /// How many lines it crosses of the family that it crosses less, infinite for the horizon.
    count: Double,
    /// t's change to the far end, infinite for the horizon.
    length: f64,
    /// dc/dt.
    pub rho: f64,
    /// dm/dt, along the edge and on the floor.
    climb: f64,
    pub slope: f64,
    /// dt and dm for every line crossed, and the sense in which they are crossed.
    pub stride: Double,
    pub rise: f64,
    sense: f64,
}

impl Edge {
    /// An edge of the boundary, summed along the axis of the board that it follows more; `None` if there is nothing to sum.
    fn new(board: &Board, from: &Corner, to: &Corner) -> Option<Self> {
        let forward = from.depth <= to.depth;
        let (near, far) = if forward { (from, to) } else { (to, from) };
        if near.depth.is_infinite() {
            return None;
        }
        let step = |i: usize| match far.depth.is_infinite() {
            true => far.floor[i].abs(),
            false => far.place(i).minus(&near.place(i)).hi.abs(),
        };
        let mut edge = Self::along(board, near, far, step(0) <= step(1))?;
        if !forward {
            edge.sign = -edge.sign;
        }
        Some(edge)
    }

    /// An edge from its near end to its far one, summed along b or along a.
    fn along(board: &Board, near: &Corner, far: &Corner, by_b: bool) -> Option<Self> {
        let (c, t) = if by_b { (0, 1) } else { (1, 0) };
        let endless = far.depth.is_infinite();
        let exactly = |i: usize| match endless {
            true => far.place(i),
            false => far.place(i).minus(&near.place(i)),
        };
        let (across, along) = (exactly(c), exactly(t));
        if along.hi == 0.0 {
            return None;
        }
        let lines = match endless {
            true => Double::from_f64(f64::INFINITY),
            false => floor(&far.place(c)).0.minus(&floor(&near.place(c)).0),
        };
        let rise = if endless { 1.0 } else { far.depth - near.depth };
        let per_line = along.over(&across);
        Some(Self {
            sign: if by_b { 1.0 } else { -1.0 },
            potential: if by_b { 1.0 } else { 0.0 },
            c: near.place(c),
            t: near.place(t),
            depth: near.depth,
            end: (!endless).then(|| (far.place(c), far.place(t), far.depth)),
            count: match lines.is_negative() {
                true => lines.negated(),
                false => lines,
            },
            length: if endless { f64::INFINITY } else { along.hi },
            rho: across.hi / along.hi,
            climb: rise / along.hi,
            slope: board.floor.slope[t],
            stride: match across.is_negative() {
                true => per_line.negated(),
                false => per_line,
            },
            rise: rise / across.hi.abs(),
            sense: across.hi.signum(),
        })
    }

    /// ρ ∫ s(c) dX from near to far.
    fn integral(&self, board: &Board, terms: usize) -> Sum {
        let series = self.series(board, terms);
        let (square, start) = floor(&self.c);
        let mut sum = Sum {
            value: -start * series.at(turned(&self.t), self.depth),
            bound: 0.0,
        };
        let lines = self.lines();
        if let Some((c, t, depth)) = self.end {
            sum.value += floor(&c).1 * series.at(turned(&t), depth);
        }
        let ends = series.size(1, self.depth);
        if lines > 0.0 && self.rho != 0.0 {
            let within = self.c.minus(&square);
            let first = match self.sense > 0.0 {
                true => Double::from_f64(1.0).minus(&within),
                false => within,
            };
            let t = first.times(&self.stride).plus(&self.t);
            let crossings = Crossings {
                turned: [t, self.stride].map(|x| turn_exactly(&x)),
                depth: self.depth + first.hi * self.rise,
                edge: self,
                lines,
                count: self.count,
            };
            // s jumps by −2s where the first line is crossed, and by turns from there.
            let tail = board.tail(lines);
            let jumps = horizon::crossings(&crossings, &series, 0.5 * tail / self.rho.abs());
            sum.value += 2.0 * start * jumps.value;
            sum.bound += 2.0 * jumps.bound;
        }
        // X at either end is rounded. And K, which all of it has before it, does not quite fit the corners; nor do the slopes, whose powers
        // are in the later terms, which are less.
        let (ends, all) = (32.0 * UNIT * ends, ends + sum.value.abs());
        sum.value *= self.rho;
        sum.bound = self.rho.abs() * (sum.bound + ends + 2.0 * board.floor.misfit * all);
        sum
    }

    /// How many lines it crosses of the family that it crosses less.
    pub(super) fn lines(&self) -> f64 {
        self.count.hi
    }

    fn series(&self, board: &Board, terms: usize) -> Series {
        let mut factors = [0.0; MAX_TERMS + 1];
        let (mut s, mut power) = (1.0, self.slope);
        for k in 1..=terms {
            factors[k] = -board.floor.density * HALF_FACTORIAL[k] * s;
            s = self.climb * s + power;
            power *= self.slope;
        }
        let across = usize::from(self.potential == 0.0);
        let Sum { value, bound } = board.floor.per_slope[across];
        let slope = board.floor.slope[across];
        let [off, size] = [self.climb - self.slope - self.rho * slope, self.rho * slope];
        let per_slope = Sum {
            value: value.copysign(slope),
            // Roundings may have it that the slopes are not quite those of the edge.
            bound: bound + (off / size).abs(),
        };
        Series {
            terms,
            factors,
            per_slope,
        }
    }
}

/// X on an edge: Σ `factors[k]`·A_k+1(t)·m^(−2−k), k = 1 … terms.
pub(super) struct Series {
    pub terms: usize,
    pub factors: [f64; MAX_TERMS + 1],
    /// K by ∂m/∂c, with a bound relative to it that allows for the edge's own slopes, too.
    pub per_slope: Sum,
}

impl Series {
    fn at(&self, t: f64, depth: f64) -> f64 {
        match self.terms {
            0..=2 => self.at_with::<2, 4>(t, depth),
            3..=4 => self.at_with::<4, 6>(t, depth),
            5..=7 => self.at_with::<7, 9>(t, depth),
            8..=12 => self.at_with::<12, 14>(t, depth),
            _ => self.at_with::<MAX_TERMS, { MAX_TERMS + 2 }>(t, depth),
        }
    }

    fn at_with<const MOST: usize, const ROWS: usize>(&self, t: f64, depth: f64) -> f64 {
        let waves = waves::<MOST, ROWS>(t);
        let u = 1.0 / depth;
        let sum = (1..=self.terms)
            .rev()
            .fold(0.0, |sum, k| (sum + self.factors[k] * waves[k + 1]) * u);
        sum * u * u
    }

    /// A bound on the k-th term, by |A_k+1| ≤ ½π^(−k).
    pub(super) fn size(&self, k: usize, depth: f64) -> f64 {
        let u = 1.0 / depth;
        let mut size = 0.5 * self.factors[k].abs() * u * u;
        for _ in 0..k {
            size *= u / PI;
        }
        size
    }

    /// How many terms a sum over so many crossings needs from some depth on, for what is left to be below `limit`; and
    /// what is left.
    fn enough(&self, depth: f64, lines: f64, limit: f64) -> (usize, f64) {
        let (mut terms, mut left) = (self.terms, 0.0);
        while terms > 1 {
            let more = left + lines * self.size(terms, depth);
            if more > limit {
                break;
            }
            left = more;
            terms -= 1;
        }
        (terms, left)
    }
}

/// The lines of one family that an edge crosses: t and m at the first, and how many there are.
pub(super) struct Crossings<'a> {
    /// t and its step from line to line, without whole turns, in half turns.
    turned: [Double; 2],
    pub depth: f64,
    pub edge: &'a Edge,
    pub lines: f64,
    /// The same exactly.
    pub count: Double,
}

impl Crossings<'_> {
    /// Σ (−1)^j X over the first `lines` crossings, one by one.
    ///
    /// In blocks over which m grows by half at most, each with as many terms as it needs.
    pub(super) fn one_by_one(&self, series: &Series, lines: f64) -> Sum {
        let mut sum = Sum::default();
        let mut done = 0.0;
        // Of blocks there are dozens. Towards the horizon much more than that is neglected in the end.
        let limit = TRUNCATION * if self.lines.is_finite() { 0.1 } else { 100.0 };
        while done < lines {
            let depth = self.depth + done * self.edge.rise;
            let most = (0.5 * depth / self.edge.rise).floor().clamp(16.0, 4096.0);
            let count = most.min(lines - done);
            let (terms, left) = series.enough(depth, count, limit);
            let block = block(self, series, terms, [done, count]);
            sum.value += if done % 2.0 == 0.0 { block } else { -block };
            // t is off by two roundings, and three of the way that it goes within a chunk, which X′, at most π X's bound, takes to X; half
            // that way on the average. The sum of the block is off by as many roundings of the terms as are added in a lane.
            let reach = 2.0 + 0.5 * count.min(CHUNK as f64);
            let added = count / LANES as f64 + 4.0;
            let rounding = UNIT * series.size(1, depth) * (added + 16.0 + 4.0 * PI * reach);
            sum.bound += left + count * rounding;
            done += count;
        }
        sum
    }

    /// X where one line is crossed.
    pub(super) fn line(&self, series: &Series, j: &Double) -> f64 {
        let t = self.turned_at(j);
        series.at(t.hi, self.depth + j.hi * self.edge.rise)
    }

    #[inline(always)]
    fn block<const TERMS: usize, const ROWS: usize>(
        &self,
        series: &Series,
        done: f64,
        count: f64,
    ) -> f64 {
        let mut sums = [0.0; LANES];
        let mut left = count as usize;
        let mut j = done;
        while left > 0 {
            let now = left.min(CHUNK);
            // A loop that the compiler makes vectors of, to the end of the last of them; what is too much is not added.
            let mut values = [0.0; CHUNK];
            let filled = now.next_multiple_of(LANES);
            let t = self.turned_at(&Double::from_f64(j)).hi;
            for (i, value) in values[..filled].iter_mut().enumerate() {
                *value = self.at::<TERMS, ROWS>(series, t, j, f64::from(i as u32));
            }
            values[now..filled].fill(0.0);
            for values in values[..filled].chunks_exact(LANES) {
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value;
                }
            }
            left -= now;
            j += now as f64;
        }
        ((sums[0] - sums[1]) + (sums[2] - sums[3])) + ((sums[4] - sums[5]) + (sums[6] - sums[7]))
    }

    /// t at crossing j, without whole turns.
    pub(super) fn turned_at(&self, j: &Double) -> Double {
        let [t, stride] = &self.turned;
        turn_exactly(&t.plus(&stride.times(j)))
    }

    /// t's step from line to line and a half turn, by which s turns; without whole turns.
    pub(super) fn turning(&self) -> Double {
        turn_exactly(&self.turned[1].plus(&Double::from_f64(1.0)))
    }

    /// X at crossing j + i, where t is that of crossing j.
    #[inline(always)]
    fn at<const TERMS: usize, const ROWS: usize>(
        &self,
        series: &Series,
        t: f64,
        j: f64,
        i: f64,
    ) -> f64 {
        let waves = waves_at::<TERMS, ROWS, 1>([t + i * self.turned[1].hi]);
        let u = 1.0 / (self.depth + (j + i) * self.edge.rise);
        let (mut x, mut k) = (0.0, TERMS);
        while k > 0 {
            x = (x + series.factors[k] * waves[k + 1][0]) * u;
            k -= 1;
        }
        x * u * u
    }
}

/// Σ (−1)^j X over so many crossings after those that are done, of the series so many terms.
#[multiversion(targets = "simd")]
fn block(crossings: &Crossings, series: &Series, terms: usize, [done, count]: [f64; 2]) -> f64 {
    match terms {
        1 => crossings.block::<1, 3>(series, done, count),
        2 => crossings.block::<2, 4>(series, done, count),
        3 => crossings.block::<3, 5>(series, done, count),
        4 => crossings.block::<4, 6>(series, done, count),
        5 => crossings.block::<5, 7>(series, done, count),
        6 => crossings.block::<6, 8>(series, done, count),
        7..=9 => crossings.block::<9, 11>(series, done, count),
        10..=12 => crossings.block::<12, 14>(series, done, count),
        _ => crossings.block::<MAX_TERMS, { MAX_TERMS + 2 }>(series, done, count),
    }
}
