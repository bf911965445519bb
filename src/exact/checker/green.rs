//! The board's integral over a polygon of many squares, along its boundary, by Green's theorem with
//! periodic Euler polynomials. Symbols are those of [`Homography`].
//!
//! In: a convex polygon in which m changes little from square to square, which may reach to the
//! horizon. Out: the integral of the board's sign, with a bound: what the series neglects, what is
//! neglected of sums over crossings, roundings, and what roundings of the forms displace.
//!
//! With the waves A_k of `special` and J = K/m³, P = Σ_j (−1)^j A_j+1(a) ∂_a^j J, of n terms, has
//! ∂_a P = s(a)·J up to ±A_n(a) ∂_a^n J. By Green's theorem ∬ s(a) s(b) J da db = ∮ s(b) P db.
//! Likewise Q = Σ_k (−1)^k A_k+1(b) ∂_b^k J, and Ψ = ΣΣ (−1)^(j+k) A_j+1(a) A_k+1(b) ∂_a^j ∂_b^k J,
//! j + k < n, has dΨ = s(a) Q da + s(b) P db up to terms of order n. On an edge, where m grows by γ
//! for a unit of b, X = −K Σ_k (k+1)!/2 · S_k A_k+1(b) m^(−2−k), k = 1 … n, with S_1 = 1
//! and S_k+1 = γ·S_k + (∂m/∂b)^k, has dX/db = −Q up to order n. Hence with ρ = da/db
//!
//! ∫ s(b) P db = ΔΨ − ∫ s(a) Q da = ΔΨ + ρ ∫ s(a) dX, and with the roles exchanged = −(db/da) ∫
//! s(b) dX′(a),
//!
//! and ∫ s(a) dX is [s(a)·X] less the jumps of s(a) times X: an edge costs as many terms as it
//! crosses lines of one family, and the family that it crosses less may be chosen.

use super::super::{budget::Budget, clip::measure};
use super::crossings::{LineCrossings, MAX_TERMS, Series};
use super::homography::{Corner, Homography, Sum, UNIT, Visible};
use super::special::{square_wave, turn, turn_exactly, waves};
use super::tail;
use crate::math::{Double, Real};
use glam::DVec2;
use std::f64::consts::PI;

/// The series is long enough when what it neglects is below this part of what is asked for.
const TRUNCATION: f64 = 1e-3;

/// Shares of the tolerance that an edge may neglect at its lines, in a polygon that reaches the
/// horizon: an edge that ends, and one that runs into the horizon. There are at most two of either
/// kind where both matter, and half of what the edges neglect together counts, since these are sums
/// of signs.
const FINITE_TAIL: f64 = 1.0 / 9.0;
const ENDLESS_TAIL: f64 = 8.0 / 9.0;
/// The same in a polygon whose edges all end: two recede, and the other two hardly neglect anything
/// (`tail::level`).
const ONLY_FINITE_TAIL: f64 = 1.0;
/// A polygon may neglect the part of that which its area is of the pixel's, but at least this part.
const LEAST_SHARE: f64 = 1.0 / 64.0;

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

/// The integral over a convex polygon of which every square is far away, which may reach to the
/// horizon.
pub(super) fn sum(
    board: &Homography,
    polygon: &[DVec2],
    visible: &Visible,
    budget: &Budget,
) -> Sum {
    let (area, _) = measure(polygon);
    let corner = |&at: &DVec2| board.corner(at, visible);
    let corners: Vec<Corner> = polygon.iter().map(corner).collect();
    // Polygons that make up a pixel neglect no more together than one does, but for those below
    // LEAST_SHARE, nor many edges more than four.
    let share = area.abs().max(LEAST_SHARE) * (4.0 / corners.len() as f64).min(1.0);
    let edges: Vec<Option<Edge>> = (0..corners.len())
        .map(|i| Edge::new(board, &corners[i], &corners[(i + 1) % corners.len()]))
        .collect();
    let is_endless = |edge: &Edge| edge.end.is_none();
    let tails = match edges.iter().flatten().any(is_endless) {
        true => [FINITE_TAIL, ENDLESS_TAIL],
        false => [ONLY_FINITE_TAIL; 2],
    };
    let nearest = corners.iter().fold(f64::INFINITY, |m, c| m.min(c.depth));
    let truncation = TRUNCATION * budget.tolerance;
    let (terms, truncation) = terms(board, nearest, &edges, area.abs(), truncation);
    let mut sum = Sum {
        value: 0.0,
        bound: truncation + board.displaced(polygon),
    };
    for (i, edge) in edges.iter().enumerate() {
        let mut ends = 0.0;
        if let Some(edge) = edge {
            let tolerance = share * tails[usize::from(is_endless(edge))] * budget.tolerance;
            let part = edge.integral(board, terms, tolerance, budget);
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
            // The k-th term has 3k + 4 roundings at most and less than 2^−k of the first one's
            // size, Σ (3k + 4)/2^k = 14; and K's product has two.
            sum.bound += (16.0 * UNIT + 2.0 * board.misfit) * size;
        }
    }
    sum.value *= board.handed * area.signum();
    sum
}

/// How many terms the series needs for what it neglects to be below a limit, and what it then
/// neglects.
///
/// With |A_k| ≤ ½π^(1−k), what P neglects integrates to at most ½π^(1−n)·(n+2)!/2·(|p|/m)^n times
/// the area in the picture, and what Ψ and X neglect on an edge to n·π^(1−n)·(n+2)!/2·(g/m)^n·∫ J
/// |dt|, where g is the largest of m's slopes along the edge and along its parameter t, and ∫ J
/// |dt| ≤ J·min(|Δt|, m/2γ) at the near end.
fn terms(
    board: &Homography,
    nearest: f64,
    edges: &[Option<Edge>],
    area: f64,
    limit: f64,
) -> (usize, f64) {
    let slope = board.slope[0].abs().max(board.slope[1].abs());
    let (mut ratio, mut weight) = (slope / nearest, 0.0);
    for edge in edges.iter().flatten() {
        ratio = ratio.max(edge.climb.abs() / edge.depth);
        let reach = edge.length.abs().min(0.5 * edge.depth / edge.climb.abs());
        weight += board.density / (edge.depth * edge.depth * edge.depth) * reach;
    }
    let neglected = |n: usize, power: f64| {
        HALF_FACTORIAL[n + 1] * power * PI * (0.5 * area + n as f64 * weight)
    };
    let step = ratio / PI;
    let mut power = step * step;
    let mut best = (2, neglected(2, power));
    for n in 3..=MAX_TERMS {
        if best.1 <= limit {
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
fn potential(board: &Homography, corner: &Corner, terms: usize) -> (f64, f64) {
    match terms {
        0..=2 => potential_of::<2, 4>(board, corner, terms),
        3..=4 => potential_of::<4, 6>(board, corner, terms),
        5..=7 => potential_of::<7, 9>(board, corner, terms),
        8..=12 => potential_of::<12, 14>(board, corner, terms),
        _ => potential_of::<MAX_TERMS, { MAX_TERMS + 2 }>(board, corner, terms),
    }
}

fn potential_of<const MOST: usize, const ROWS: usize>(
    board: &Homography,
    corner: &Corner,
    terms: usize,
) -> (f64, f64) {
    let u = 1.0 / corner.depth;
    let [a, b] = [0, 1].map(|i| {
        let mut waves = waves::<MOST, ROWS>(turn(corner.floor[i]));
        let mut power = 1.0;
        for wave in &mut waves[1..=terms] {
            *wave *= power;
            power *= board.slope[i] * u;
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
    let density = board.density * u * u * u;
    (density * sum, density)
}

/// An edge from its near end to its far one. `c` counts the lines of the family that it crosses
/// less, t those of the other.
struct Edge {
    /// +1 or −1 where the boundary runs from near to far or back, times the sign before ρ ∫ s dX.
    sign: f64,
    /// How Ψ at the edge's end, in the boundary's sense, counts: 1 where t is b, else 0.
    potential: f64,
    c: f64,
    t: f64,
    depth: f64,
    /// The far end's c, t and m, unless it is on the horizon.
    end: Option<(f64, f64, f64)>,
    /// How many lines it crosses of the family that it crosses less, infinite for the horizon.
    count: Double,
    /// t's change to the far end, infinite for the horizon.
    length: f64,
    /// dc/dt.
    rho: f64,
    /// dm/dt, along the edge and on the floor.
    climb: f64,
    slope: f64,
    /// dt and dm for every line crossed, and the sense in which they are crossed.
    stride: Double,
    rise: f64,
    sense: f64,
}

impl Edge {
    /// An edge of the boundary, summed along the axis of the board that it follows more; `None` if
    /// there is nothing to sum.
    fn new(board: &Homography, from: &Corner, to: &Corner) -> Option<Self> {
        let forward = from.depth <= to.depth;
        let (near, far) = if forward { (from, to) } else { (to, from) };
        if near.depth.is_infinite() {
            return None;
        }
        let step = |i: usize| match far.depth.is_infinite() {
            true => far.floor[i].abs(),
            false => (far.floor[i] - near.floor[i]).abs(),
        };
        let axes = if step(0) <= step(1) { [0, 1] } else { [1, 0] };
        let mut edge = Self::along(board, near, far, axes)?;
        if !forward {
            edge.sign = -edge.sign;
        }
        Some(edge)
    }

    /// An edge from its near end to its far one, whose lines of the axis c are summed along the
    /// axis t.
    fn along(board: &Homography, near: &Corner, far: &Corner, [c, t]: [usize; 2]) -> Option<Self> {
        let by_b = t == 1;
        let endless = far.depth.is_infinite();
        let exactly = |i: usize| match endless {
            true => Double::from_f64(far.floor[i]),
            false => Double::difference(far.floor[i], near.floor[i]),
        };
        let (across, along) = (exactly(c), exactly(t));
        if along.hi == 0.0 {
            return None;
        }
        let lines = match endless {
            true => Double::from_f64(f64::INFINITY),
            false => Double::difference(far.floor[c].floor(), near.floor[c].floor()),
        };
        let rise = if endless { 1.0 } else { far.depth - near.depth };
        // Where no line is crossed there is no next one.
        let per_line = match lines.is_zero() {
            true => lines,
            false => along.over(&across),
        };
        Some(Self {
            sign: if by_b { 1.0 } else { -1.0 },
            potential: if by_b { 1.0 } else { 0.0 },
            c: near.floor[c],
            t: near.floor[t],
            depth: near.depth,
            end: (!endless).then(|| (far.floor[c], far.floor[t], far.depth)),
            count: match lines.is_negative() {
                true => lines.negated(),
                false => lines,
            },
            length: if endless { f64::INFINITY } else { along.hi },
            rho: across.hi / along.hi,
            climb: rise / along.hi,
            slope: board.slope[t],
            stride: match across.is_negative() {
                true => per_line.negated(),
                false => per_line,
            },
            rise: rise / across.hi.abs(),
            sense: across.hi.signum(),
        })
    }

    /// ρ ∫ s(c) dX from near to far; `tolerance` is what may be neglected of it.
    fn integral(&self, board: &Homography, terms: usize, tolerance: f64, budget: &Budget) -> Sum {
        let series = self.series(board, terms);
        let square = self.c.floor();
        let start = square_wave(square);
        let mut sum = Sum {
            value: -start * series.at(turn(self.t), self.depth),
            bound: 0.0,
        };
        if let Some((c, t, depth)) = self.end {
            sum.value += square_wave(c.floor()) * series.at(turn(t), depth);
        }
        let ends = series.size(1, self.depth);
        if self.count.hi > 0.0 && self.rho != 0.0 {
            let within = Double::difference(self.c, square);
            let first = match self.sense > 0.0 {
                true => Double::from_f64(1.0).minus(&within),
                false => within,
            };
            let t = first.times(&self.stride).plus(&Double::from_f64(self.t));
            let crossings = LineCrossings {
                turned: [t, self.stride].map(|x| turn_exactly(&x)),
                depth: self.depth + first.hi * self.rise,
                rise: self.rise,
                count: self.count,
            };
            // s jumps by −2s where the first line is crossed, and by turns from there.
            let jumps = tail::sum(
                &crossings,
                &series,
                0.5 * tolerance / self.rho.abs(),
                budget,
            );
            sum.value += 2.0 * start * jumps.value;
            sum.bound += 2.0 * jumps.bound;
        }
        // X at either end: its terms, counted as Ψ's, have 14 roundings of the first one's size.
        // Every term is proportional to K, which is rounded, too.
        let (ends, all) = (32.0 * UNIT * ends, ends + sum.value.abs());
        sum.value *= self.rho;
        sum.bound = self.rho.abs() * (sum.bound + ends + 2.0 * board.misfit * all);
        sum
    }

    fn series(&self, board: &Homography, terms: usize) -> Series {
        let mut factors = [0.0; MAX_TERMS + 1];
        let (mut s, mut power) = (1.0, self.slope);
        for k in 1..=terms {
            factors[k] = -board.density * HALF_FACTORIAL[k] * s;
            s = self.climb * s + power;
            power *= self.slope;
        }
        Series { terms, factors }
    }
}
