//! Integrates the sign of a checkerboard, 1 on squares of one colour and −1 on the others, over a
//! polygon of many squares. Green's theorem with periodic Euler polynomials turns the integral into
//! a sum along the polygon's boundary.
//!
//! In: a convex polygon of the picture in which the depth m changes little from square to square,
//! and which may reach the horizon. Out: the integral of the board's sign, with an error bound. The
//! bound covers three kinds of errors: the truncation of series and of sums over the lines that
//! edges cross; rounding errors; and the displacement of squares by rounding errors of the linear
//! forms that map the picture to the board ([`Homography`]).
//!
//! In the formulas, (a, b) is a point of the board's plane, in squares, and s is the square wave, 1
//! and −1 in turn from square to square. One unit of the plane's area at the depth m covers K/m³
//! square pixels, where K is a constant ([`Homography`]). n is the number of terms after which a
//! series is truncated.
//!
//! With the periodic Euler polynomials A_k of [`waves`] and J = K/m³, the sum
//!
//! P = Σ_j (−1)^j·A_j+1(a)·∂_a^j J, j < n,
//!
//! satisfies ∂_a P = s(a)·J, except for the truncation error ±A_n(a)·∂_a^n J. By Green's theorem,
//!
//! ∬ s(a)·s(b)·J da db = ∮ s(b)·P db.
//!
//! Likewise let Q = Σ_k (−1)^k·A_k+1(b)·∂_b^k J for k < n, and
//!
//! Ψ = ΣΣ (−1)^(j+k)·A_j+1(a)·A_k+1(b)·∂_a^j ∂_b^k J, j + k < n.
//!
//! Then dΨ = s(a)·Q da + s(b)·P db, except for terms of order n.
//!
//! Let m grow by γ per unit of b along an edge. There, the series
//!
//! X = −K·Σ_k (k+1)!/2·S_k·A_k+1(b)·m^(−2−k), k = 1 … n,
//!
//! with S_1 = 1 and S_k+1 = γ·S_k + (∂m/∂b)^k, satisfies dX/db = −Q, except for terms of order n.
//! With ρ = da/db, and with ΔΨ the difference of Ψ between the ends of the edge, it follows that
//!
//! ∫ s(b)·P db = ΔΨ − ∫ s(a)·Q da = ΔΨ + ρ·∫ s(a) dX.
//!
//! If a and b exchange their roles, and X′ is the series in a, the same integral is
//!
//! ∫ s(b)·P db = −(db/da)·∫ s(b) dX′.
//!
//! Partial summation gives ∫ s(a) dX: it is the difference of s(a)·X between the edge's ends, minus
//! the sum of X times the jump of s(a) at each line that the edge crosses. The number of
//! evaluations of X is about the number of crossed lines on which a is a whole number. With X′, it
//! is about the number of crossed lines on which b is a whole number. Of the two formulas, the one
//! with fewer evaluations is used.

use super::super::{budget::PixelBudget, clip::measure};
use super::crossings::{EdgeSeries, LineCrossings, MAX_TERMS};
use super::homography::{BoundedSum, Corner, Homography, UNIT, VisiblePart};
use super::special::{reduce, reduce_double, square_wave, waves};
use super::tail;
use crate::math::{Double, Real};
use glam::DVec2;
use std::f64::consts::PI;

/// Maximum error from truncating the series along the edges and at the corners of a polygon, as a
/// fraction of the pixel's tolerance. The number of terms is chosen accordingly. The fraction is
/// small, because the sums over the points where edges cross lines of the board may use up all of
/// the tolerance ([`FINITE_TAIL`]).
const TRUNCATION: f64 = 1e-3;

/// Maximum truncation error of the sum over the lines that one edge crosses, as a fraction of the
/// pixel's tolerance. It applies to edges that do not reach the horizon, in a polygon that does.
/// Edges that end on the horizon get the larger fraction [`ENDLESS_TAIL`], because they cross
/// infinitely many lines.
///
/// A polygon has noticeable errors on at most two edges that end before the horizon and two that
/// end on it. Together they are at most 2·(1/9 + 8/9), twice the tolerance. The area of a colour is
/// half of the polygon's area plus or minus half of the integral, so its error is at most the
/// tolerance.
const FINITE_TAIL: f64 = 1.0 / 9.0;
/// Maximum truncation error of the sum over the lines that one edge crosses, as a fraction of the
/// pixel's tolerance. It applies to edges that end on the horizon. Other edges of the same polygon
/// get only 1/9 ([`FINITE_TAIL`]).
const ENDLESS_TAIL: f64 = 8.0 / 9.0;
/// Maximum truncation error of the sum over the lines that one edge crosses, as a fraction of the
/// pixel's tolerance, if no edge of the polygon reaches the horizon. It is the whole tolerance,
/// because only the two edges that recede from the eye have long sums with noticeable truncation
/// errors.
const ONLY_FINITE_TAIL: f64 = 1.0;
/// Minimum share of the pixel's tolerance that a polygon gets for its truncated sums. The share is
/// the polygon's area, in square pixels, if this is greater. With a smaller minimum, the sums for
/// tiny polygons would become long. With a larger minimum, the errors of many tiny polygons could
/// exceed the tolerance.
const MIN_SHARE: f64 = 1.0 / 64.0;

/// Table of (k + 1)!/2, with the index k. At the depth m, one unit of the floor's area covers K/m³
/// square pixels, where K is a constant ([`Homography`]). The k-th derivative of K/m³ with respect
/// to m is ±K·(k + 2)!/2·m^(−3−k), which uses the entry k + 1. The series ([`EdgeSeries`]) and the
/// potential ([`potential`]) consist of such derivatives.
pub(super) const HALF_FACTORIAL: [f64; MAX_TERMS + 2] = {
    let mut all = [0.5; MAX_TERMS + 2];
    let mut k = 1;
    while k < MAX_TERMS + 2 {
        all[k] = all[k - 1] * (k + 1) as f64;
        k += 1;
    }
    all
};

/// Integrates the board's sign (1 on squares of one colour, −1 on the others) over a convex polygon
/// in which the depth changes little from square to square. The polygon may reach the horizon.
/// `visible` is a larger polygon that contains this one and shows only the floor.
pub(super) fn sum(
    board: &Homography,
    polygon: &[DVec2],
    visible: &VisiblePart,
    budget: &PixelBudget,
) -> BoundedSum {
    let (area, _) = measure(polygon);
    let corner = |&at: &DVec2| board.corner(at, visible);
    let corners: Vec<Corner> = polygon.iter().map(corner).collect();
    // The pixel's tolerance is divided among its polygons in proportion to their areas, but each
    // polygon gets at least the fraction `MIN_SHARE`. The limits `FINITE_TAIL`, `ENDLESS_TAIL` and
    // `ONLY_FINITE_TAIL` assume that a polygon has four edges. If it has more, each edge gets
    // proportionally less.
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
            // Term k of the potential Ψ is computed with at most 3k + 4 roundings and is less than
            // 2^−k times term 0. The rounding error is therefore at most Σ (3k + 4)/2^k = 14 unit
            // roundoffs, relative to term 0. The product with the density factor K adds two
            // roundings.
            sum.bound += (16.0 * UNIT + 2.0 * board.density_error) * size;
        }
    }
    sum.value *= board.orientation * area.signum();
    sum
}

/// Returns the number of terms of the series with which the truncation error of the polygon's
/// integral is at most `limit`, and a bound on this error. If no number of terms is enough, returns
/// the number with the smallest bound. `nearest` is the smallest depth in the polygon, and `area`
/// is the polygon's area in the picture.
fn terms(
    board: &Homography,
    nearest: f64,
    edges: &[Option<Edge>],
    area: f64,
    limit: f64,
) -> (usize, f64) {
    // The symbols are those of the module's documentation; n is the number of terms. Let p be the
    // larger of the slopes |∂m/∂a| and |∂m/∂b|, and m the smallest depth. Because |A_k| ≤ ½π^(1−k),
    // the truncation error of P has an integral of at most the polygon's area in the picture times
    //
    // ½π^(1−n)·(n+2)!/2·(p/m)^n.
    //
    // The truncation errors of Ψ and X on an edge have an integral of at most
    //
    // n·π^(1−n)·(n+2)!/2·(g/m)^n·∫ J |dt|.
    //
    // Here t is the coordinate (a or b) that changes more along the edge, and g is the larger of
    // |∂m/∂t| on the floor and |dm/dt| along the edge. The integral ∫ J |dt| is at most J·min(|Δt|,
    // m/2γ), with J at the near end.
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

/// Returns the potential and the floor's density at a corner of a polygon. The differences of the
/// potential between the ends of the edges are part of the polygon's integral. The potential is a
/// sum over derivatives of order 0 to `terms` − 1. The density is in square pixels per square of
/// the board. The rounding error of the potential is proportional to the density.
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
    // The potential is Ψ of the module's documentation, and the density is K/m³.
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

/// An edge of a polygon, directed from its near end to its far end. A point of the edge shows a
/// point (a, b) of the floor, in squares, at the depth m. The coordinate (a or b) that changes more
/// along the edge is called t, and the other one is called c. The sum over the edge's crossings
/// runs over the lines of the board on which c is constant.
struct Edge {
    /// +1 or −1: the sign with which the edge's contribution is added to the integral over the
    /// polygon. It depends on two conditions: whether the polygon's boundary runs from the edge's
    /// near end to its far end, and whether the floor's second coordinate changes at least as much
    /// along the edge as the first. The sign is +1 if both conditions hold or neither does.
    sign: f64,
    /// Factor by which the difference of the potential ([`potential`]) between the edge's ends is
    /// multiplied in the polygon's integral. It is 1 if the floor's second coordinate changes at
    /// least as much along the edge as the first, and 0 otherwise.
    potential: f64,
    c: f64,
    t: f64,
    depth: f64,
    /// Values at the far end: the coordinate of the floor that changes less along the edge, the one
    /// that changes more, and the depth. `None` if the far end is on the horizon.
    end: Option<(f64, f64, f64)>,
    /// Number of the board's lines of constant c that the edge crosses, where c is the coordinate
    /// of the floor that changes less along the edge. Infinite if the edge ends on the horizon.
    count: Double,
    /// Change of t from the near to the far end, where t is the coordinate of the floor that
    /// changes more along the edge. Infinite if the far end is on the horizon.
    length: f64,
    /// Slope dc/dt of the edge on the floor, where t is the floor coordinate that changes more
    /// along the edge, and c the one that changes less.
    rho: f64,
    /// Derivative dm/dt of the depth m along the edge, where t is the coordinate of the floor that
    /// changes more along the edge.
    climb: f64,
    /// Partial derivative ∂m/∂t of the depth m on the floor, where t is the coordinate that changes
    /// more along the edge.
    slope: f64,
    /// Change of t from one crossed line to the next, where t is the coordinate of the floor that
    /// changes more along the edge.
    stride: Double,
    /// Change of the depth m from one crossed line to the next.
    rise: f64,
    /// +1 or −1: whether c grows or falls from the near to the far end. c is the floor coordinate
    /// that changes less along the edge.
    sense: f64,
}

impl Edge {
    /// Returns the edge of the boundary from the corner `from` to the corner `to`. Returns `None`
    /// if the edge contributes nothing, because it lies on the horizon or has no length.
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
        // If the edge crosses no line, `lines` is 0 and `stride` is not used. It is then set to 0.
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

    /// Computes the edge's contribution to the polygon's integral, except for the potentials at the
    /// edge's ends. The contribution consists of the values of the series ([`EdgeSeries`]) at the
    /// two ends, and of a sum of its values at the crossed lines. `tolerance` limits the truncation
    /// error of this sum.
    fn integral(
        &self,
        board: &Homography,
        terms: usize,
        tolerance: f64,
        budget: &PixelBudget,
    ) -> BoundedSum {
        // In the symbols of the module's documentation, the contribution is ρ·∫ s(c) dX from the
        // near to the far end. Here, c is the floor coordinate that changes less along the edge.
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
            // At the first crossed line, the square wave s(c) changes by −2 times its value at the
            // near end. The changes at the following lines alternate in sign.
            let tolerance = 0.5 * tolerance / self.rho.abs();
            let jumps = tail::sum(&crossings, &series, tolerance, budget);
            sum.value += 2.0 * start * jumps.value;
            sum.bound += 2.0 * jumps.bound;
        }
        // Term k of the series X at an end of the edge is computed with 3k + 4 roundings and is
        // less than 2^−k times term 0. The roundings add up to at most 14 unit roundoffs, relative
        // to term 0. The constant 32 covers both ends. Every term is also proportional to the
        // density factor K, whose relative error is `density_error`.
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
