//! The board's integral over a polygon of many squares, along its boundary, by Green's theorem with
//! periodic Euler polynomials. The symbols are those of [`Homography`].
//!
//! In: a convex polygon in which m changes little from square to square, and which may reach the
//! horizon. Out: the integral of the board's sign, with a bound: the truncation of the series and
//! of sums over crossings, roundings, and displacements by roundings of the forms.
//!
//! With the waves A_k of `special` and J = K/m³, P = Σ_j (−1)^j A_j+1(a) ∂_a^j J, of n terms,
//! satisfies ∂_a P = s(a)·J up to ±A_n(a) ∂_a^n J. By Green's theorem ∬ s(a) s(b) J da db = ∮ s(b)
//! P db. Likewise Q = Σ_k (−1)^k A_k+1(b) ∂_b^k J, and Ψ = ΣΣ (−1)^(j+k) A_j+1(a) A_k+1(b) ∂_a^j
//! ∂_b^k J, j + k < n, satisfies dΨ = s(a) Q da + s(b) P db up to terms of order n. On an edge,
//! where m grows by γ per unit of b, X = −K Σ_k (k+1)!/2 · S_k A_k+1(b) m^(−2−k), k = 1 … n, with
//! S_1 = 1 and S_k+1 = γ·S_k + (∂m/∂b)^k, satisfies dX/db = −Q up to order n. Hence with ρ = da/db
//!
//! ∫ s(b) P db = ΔΨ − ∫ s(a) Q da = ΔΨ + ρ ∫ s(a) dX, and with the roles exchanged = −(db/da) ∫
//! s(b) dX′(a),
//!
//! and ∫ s(a) dX is [s(a)·X] minus the jumps of s(a) times X. An edge therefore costs as many terms
//! as it crosses lines of one family, and the family with fewer crossings is chosen.

use super::super::{budget::PixelBudget, clip::measure};
use super::crossings::{EdgeSeries, LineCrossings, MAX_TERMS};
use super::homography::{BoundedSum, Corner, Homography, UNIT, VisiblePart};
use super::special::{reduce, reduce_double, square_wave, waves};
use super::tail;
use crate::math::{Double, Real};
use glam::DVec2;
use std::f64::consts::PI;

/// Truncation error of the series, as a fraction of the tolerance.
const TRUNCATION: f64 = 1e-3;

/// Truncation error of the sum over an edge that ends, as a fraction of the tolerance, in a polygon
/// that reaches the horizon. There are at most two such edges that matter, and as many that run
/// into the horizon. Half of the total of all edges counts, since these are sums of signs.
const FINITE_TAIL: f64 = 1.0 / 9.0;
/// Truncation error of the sum over an edge that runs into the horizon, as a fraction of the
/// tolerance.
const ENDLESS_TAIL: f64 = 8.0 / 9.0;
/// Truncation error of the sum over an edge, as a fraction of the tolerance, in a polygon whose
/// edges all end: two recede, and the other two hardly contribute (`tail::level`).
const ONLY_FINITE_TAIL: f64 = 1.0;
/// Minimum fraction of the tolerance for a polygon; a larger one gets the fraction that its area is
/// of the pixel's.
const MIN_SHARE: f64 = 1.0 / 64.0;

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

/// Integrates over a convex polygon in which every square is far away, and which may reach the
/// horizon.
pub(super) fn sum(
    board: &Homography,
    polygon: &[DVec2],
    visible: &VisiblePart,
    budget: &PixelBudget,
) -> BoundedSum {
    let (area, _) = measure(polygon);
    let corner = |&at: &DVec2| board.corner(at, visible);
    let corners: Vec<Corner> = polygon.iter().map(corner).collect();
    // Polygons that make up a pixel may neglect no more together than a single one, except for
    // those below `MIN_SHARE`; and many edges no more than four.
    let share = area.abs().max(MIN_SHARE) * (4.0 / corners.len() as f64).min(1.0);
    let edges: Vec<Option<Edge>> = (0..corners.len())
        .map(|i| Edge::new(board, &corners[i], &corners[(i + 1) % corners.len()]))
        .collect();
    let is_endless = |edge: &Edge| edge.end.is_none();
    let tails = if edges.iter().flatten().any(is_endless) {
        [FINITE_TAIL, ENDLESS_TAIL]
    } else {
        [ONLY_FINITE_TAIL; 2]
    };
    let nearest = corners.iter().fold(f64::INFINITY, |m, c| m.min(c.depth));
    let truncation = TRUNCATION * budget.tolerance;
    let (terms, truncation) = terms(board, nearest, &edges, area.abs(), truncation);
    let mut sum = BoundedSum {
        value: 0.0,
        bound: truncation + board.displacement_error(polygon),
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
            // The k-th term has at most 3k + 4 roundings and is less than 2^−k of the first one,
            // and Σ (3k + 4)/2^k = 14; K's product has two.
            sum.bound += (16.0 * UNIT + 2.0 * board.density_error) * size;
        }
    }
    sum.value *= board.orientation * area.signum();
    sum
}

/// Returns how many terms the series needs for a truncation error below `limit`, and that error.
///
/// By |A_k| ≤ ½π^(1−k), the truncation error of P integrates to at most ½π^(1−n)·(n+2)!/2·(|p|/m)^n
/// times the area in the picture. Those of Ψ and X on an edge integrate to at most
/// n·π^(1−n)·(n+2)!/2·(g/m)^n·∫ J |dt|, where g is the largest of m's slopes along the edge and
/// along its parameter t, and ∫ J |dt| ≤ J·min(|Δt|, m/2γ) at the near end.
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

/// Returns Ψ at a corner, and its size before cancellation.
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
        let mut waves = waves::<MOST, ROWS>(reduce(corner.floor[i]));
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

/// An edge from its near end to its far end. c counts the lines of the family that it crosses less
/// often, t those of the other family.
struct Edge {
    /// Sign of the boundary's direction, +1 from near to far, times the sign before ρ ∫ s dX.
    sign: f64,
    /// Weight of Ψ at the edge's end, in the boundary's direction: 1 if t is b, or else 0.
    potential: f64,
    c: f64,
    t: f64,
    depth: f64,
    /// c, t and m at the far end; `None` if that is on the horizon.
    end: Option<(f64, f64, f64)>,
    /// Number of lines of family c that the edge crosses, infinite if it ends at the horizon.
    count: Double,
    /// Change of t to the far end, infinite at the horizon.
    length: f64,
    /// dc/dt.
    rho: f64,
    /// dm/dt along the edge.
    climb: f64,
    /// ∂m/∂t on the floor.
    slope: f64,
    /// Step of t from line to line.
    stride: Double,
    /// Step of m from line to line.
    rise: f64,
    /// Direction in which lines are crossed, +1 or −1.
    sense: f64,
}

impl Edge {
    /// Returns an edge of the boundary, summed along the axis t of the board that it follows more
    /// closely over its crossings with lines of the other axis, c. Returns `None` if there is
    /// nothing to sum.
    fn new(board: &Homography, from: &Corner, to: &Corner) -> Option<Self> {
        let is_forward = from.depth <= to.depth;
        let (near, far) = if is_forward { (from, to) } else { (to, from) };
        if near.depth.is_infinite() {
            return None;
        }
        let is_endless = far.depth.is_infinite();
        let steps = [0, 1].map(|i| {
            if is_endless {
                Double::from_f64(far.floor[i])
            } else {
                Double::difference(far.floor[i], near.floor[i])
            }
        });
        let by_b = steps[0].hi.abs() <= steps[1].hi.abs();
        let [c, t] = if by_b { [0, 1] } else { [1, 0] };
        let (across, along) = (steps[c], steps[t]);
        if along.hi == 0.0 {
            return None;
        }
        let lines = if is_endless {
            Double::from_f64(f64::INFINITY)
        } else {
            Double::difference(far.floor[c].floor(), near.floor[c].floor())
        };
        let rise = if is_endless {
            1.0
        } else {
            far.depth - near.depth
        };
        // If no line is crossed, there is no next line.
        let mut stride = lines;
        if !lines.is_zero() {
            stride = along.over(&across);
        }
        Some(Self {
            sign: if by_b == is_forward { 1.0 } else { -1.0 },
            potential: if by_b { 1.0 } else { 0.0 },
            c: near.floor[c],
            t: near.floor[t],
            depth: near.depth,
            end: (!is_endless).then(|| (far.floor[c], far.floor[t], far.depth)),
            count: lines.negated_if(lines.is_negative()),
            length: if is_endless { f64::INFINITY } else { along.hi },
            rho: across.hi / along.hi,
            climb: rise / along.hi,
            slope: board.slope[t],
            stride: stride.negated_if(across.is_negative()),
            rise: rise / across.hi.abs(),
            sense: across.hi.signum(),
        })
    }

    /// Computes ρ ∫ s(c) dX from near to far; `tolerance` limits the truncation error.
    fn integral(
        &self,
        board: &Homography,
        terms: usize,
        tolerance: f64,
        budget: &PixelBudget,
    ) -> BoundedSum {
        let series = self.series(board, terms);
        let square = self.c.floor();
        let start = square_wave(square);
        let mut sum = BoundedSum {
            value: -start * series.at(reduce(self.t), self.depth),
            bound: 0.0,
        };
        if let Some((c, t, depth)) = self.end {
            sum.value += square_wave(c.floor()) * series.at(reduce(t), depth);
        }
        let ends = series.size(1, self.depth);
        if self.count.hi > 0.0 && self.rho != 0.0 {
            let within = Double::difference(self.c, square);
            let first = if self.sense > 0.0 {
                Double::from_f64(1.0).minus(&within)
            } else {
                within
            };
            let t = first.times(&self.stride).plus(&Double::from_f64(self.t));
            let crossings = LineCrossings {
                reduced: [t, self.stride].map(|x| reduce_double(&x)),
                depth: self.depth + first.hi * self.rise,
                rise: self.rise,
                count: self.count,
            };
            // s jumps by −2s where the first line is crossed, and alternates from there.
            let tolerance = 0.5 * tolerance / self.rho.abs();
            let jumps = tail::sum(&crossings, &series, tolerance, budget);
            sum.value += 2.0 * start * jumps.value;
            sum.bound += 2.0 * jumps.bound;
        }
        // X at either end: counted as for Ψ, its terms have 14 roundings of the first one's size.
        // Every term is proportional to K, which is rounded, too.
        let (ends, all) = (32.0 * UNIT * ends, ends + sum.value.abs());
        sum.value *= self.rho;
        sum.bound = self.rho.abs() * (sum.bound + ends + 2.0 * board.density_error * all);
        sum
    }

    fn series(&self, board: &Homography, terms: usize) -> EdgeSeries {
        let mut factors = [0.0; MAX_TERMS + 1];
        let (mut s, mut power) = (1.0, self.slope);
        for k in 1..=terms {
            factors[k] = -board.density * HALF_FACTORIAL[k] * s;
            s = self.climb * s + power;
            power *= self.slope;
        }
        EdgeSeries { terms, factors }
    }
}
