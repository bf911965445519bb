//! Sums over the lines that an edge crosses, if there are very many or infinitely many of these
//! lines.
//!
//! In: an edge's crossings with the lines of one family, and the series X of
//! [`green`](super::green). Out: Σ (−1)^j·X over the crossings j, with a bound on truncation and
//! rounding errors.
//!
//! Crossing j has the coordinate t_j = t + τ·j along the edge and the depth m_j = g·(w + j). Here τ
//! and g are the changes of the coordinate and of the depth from one crossing to the next, and g·w
//! is the depth at the first crossing. The square wave changes its sign at every crossing. The
//! periodic Euler polynomials are the Fourier series
//!
//! A_k(t) = Im (4/π)·Σ_n e^(iπnt)/(n·(iπn)^k) over the odd n.
//!
//! The part of X with A_k+1 therefore has the sum Σ_j (−1)^j·A_k+1(t_j)·m_j^(−2−k), which is the
//! sum over n of the Fourier modes
//!
//! g^(−2−k)·Im (4/π)·e^(iπnt)/(n·(iπn)^(k+1))·V_s(θ), where V_s(θ) = Σ_j e^(iθj)·(w + j)^(−s),
//!
//! s = k + 2, and θ = n·π·(τ + 1) reduced by whole turns.
//!
//! V is a Lerch series. From (w + j)^(−s) = ∫ x^(s−1)·e^(−(w+j)x) dx/Γ(s) follows
//!
//! V_s(θ) = ∫ x^(s−1)·e^(−wx)/(1 − e^(iθ−x)) dx/Γ(s).
//!
//! The pole at x = iθ contributes w^(1−s)·e^z·E_s(z), z = −iθw, an exponential integral (DLMF
//! 8.19). The rest of the integrand contains the regular function R(ζ) = 1/(1 − e^(−ζ)) − 1/ζ. Its
//! Taylor series about ζ = −iθ contributes w^(−s)·(R + R′·s/w + …), term by term. At θ = 0, the
//! direction of a diagonal of the board, this is the Euler–Maclaurin sum; at θ = π, it is Boole's
//! sum.
//!
//! If m at least doubles along the edge, the first crossings are added one by one, and the Fourier
//! modes give the sum over the remaining crossings ([`receding`]).
//!
//! If m less than doubles along the edge's N crossings, the n-th mode is at most n^−3 of the sum of
//! all absolute terms, so that a few hundred modes are enough. The sum of a mode over j is then the
//! difference of two Lerch series, one from the edge's start and one from its end. If m is
//! practically constant, the sum is geometric ([`level`]).

mod lerch;
mod level;
mod receding;
#[cfg(test)]
mod tests;

use super::super::budget::PixelBudget;
use super::crossings::{EdgeSeries, LineCrossings};
use super::homography::BoundedSum;
use super::special::Complex;
use crate::math::{Double, Real};

/// Number of terms of an edge's series ([`EdgeSeries`]), counted from the first, whose sums over
/// the edge's crossings are computed by Fourier modes. The later terms decrease faster with the
/// depth, and a bound of their sum is added to the error. Along an edge that recedes from the eye,
/// the first crossings are added one by one, with all terms, until this error is small enough.
const MODE_TERMS: usize = 3;

/// Maximum number of crossings of an edge at which all of them are added one by one, without trying
/// Fourier modes. Adding 20,000 crossings takes 60 µs, 3 ns each. Not critical: with 5000 or
/// 80,000, the measured running time changes by less than 10 %.
const MAX_DIRECT: f64 = 20_000.0;
/// Maximum number of an edge's crossings that are added one by one if Fourier modes alone do not
/// give the sum within the tolerance. It is also the maximum number n of a Fourier mode. A bound of
/// the remaining crossings or modes is added to the error. Adding 300,000 crossings or modes takes
/// a few milliseconds.
const MAX_TERMS_ADDED: f64 = 300_000.0;
/// Fraction of an edge's tolerance. If the sum over the edge's crossings is certainly smaller, it
/// is neglected: it is treated as 0, and its upper bound is added to the error. Skipped Fourier
/// modes may use up the same fraction. The fractions of all kinds of errors must add up to less
/// than 1.
const SKIPPED_SHARE: f64 = 0.25;
/// Fraction of an edge's tolerance that may be used up by leaving out those terms of the edge's
/// series ([`EdgeSeries`]) that are not summed by Fourier modes. Not critical: with 0.0125 or 0.2,
/// the measured running time changes by less than 10 %.
const LATER_TERMS_SHARE: f64 = 0.05;
/// Approximate time to add one crossing directly, in units of about 50 ns. It is charged to the
/// pixel's budget, and need not be precise, because the budget only stops computations that take
/// too long.
const CROSSING_WORK: f64 = 1.0 / 16.0;
/// Half of the approximate time to compute one Fourier mode, in units of about 50 ns. The work
/// charged to the pixel's budget is this time multiplied by the number n of the last mode. There
/// are only n/2 modes, because their numbers are odd. A rough value is enough, because the budget
/// only stops computations that take too long.
const MODE_WORK: f64 = 1.0 / 4.0;

/// Computes the alternating sum Σ (−1)^j·X over all crossings j of an edge with lines of the board.
/// `series` gives X, the edge's contribution at a crossing. `tolerance` limits the truncation
/// error. Returns 0 with an upper bound of the sum's absolute value if the sum is negligible or the
/// budget is too small.
pub(super) fn sum(
    all: &LineCrossings,
    series: &EdgeSeries,
    tolerance: f64,
    budget: &PixelBudget,
) -> BoundedSum {
    let lines = all.count.hi;
    let size: f64 = (1..=series.terms).map(|k| series.size(k, all.depth)).sum();
    let trivial = lines * size;
    let unknown = BoundedSum::zero_within(trivial);
    let one_by_one = |lines: f64| {
        let is_affordable = budget.try_charge(lines * CROSSING_WORK);
        is_affordable.then(|| all.one_by_one(series, lines, tolerance))
    };
    if lines <= MAX_DIRECT {
        return one_by_one(lines).unwrap_or(unknown);
    }
    if trivial <= SKIPPED_SHARE * tolerance {
        return unknown;
    }
    if all.rise * lines < all.depth {
        // The depth less than doubles between the edge's ends. The sums from its ends to infinity
        // (`receding`) would extend to much greater depths than the edge, and their Fourier modes
        // would decay too slowly. `level` uses the modes of the sum between the two ends.
        let sum = level::sum(all, series, trivial, tolerance, budget);
        if sum.bound > tolerance && lines <= MAX_TERMS_ADDED {
            return one_by_one(lines).unwrap_or(sum);
        }
        return sum;
    }
    let start = receding::start(all, series, tolerance);
    let direct = ((start - all.depth) / all.rise)
        .ceil()
        .clamp(0.0, MAX_TERMS_ADDED);
    if direct + MAX_DIRECT >= lines && lines <= MAX_TERMS_ADDED {
        return one_by_one(lines).unwrap_or(unknown);
    }
    let Some(mut sum) = one_by_one(direct) else {
        return unknown;
    };
    let ends = [
        Some(Double::from_f64(direct)),
        lines.is_finite().then_some(all.count),
    ];
    let share = tolerance / ends.iter().flatten().count() as f64;
    for (end, crossing) in ends.iter().enumerate() {
        let Some(crossing) = crossing else { continue };
        let rest = receding::sum_from(all, crossing, series, share, budget);
        // `rest` is the sum from `crossing` to the horizon, in which the first term is positive. In
        // the whole sum, crossing j has the sign (−1)^j. If the edge ends before the horizon, the
        // sum from its end to the horizon is subtracted.
        let odd = crossing.floor().1 != (end == 1);
        sum.value += if odd { -rest.value } else { rest.value };
        sum.bound += rest.bound;
    }
    sum
}

/// Returns the amplitudes of the first three terms of the series ([`EdgeSeries`]) in the Fourier
/// mode n = 1. The amplitude of a term is its factor in `series.factors`, multiplied by a number
/// that depends only on the term's position. For the first term, this number is `first`. `next`
/// maps the number of one term to that of the next.
fn amplitudes(series: &EdgeSeries, first: f64, next: impl Fn(f64) -> f64) -> [f64; MODE_TERMS] {
    let (mut amplitudes, mut unit) = ([0.0; MODE_TERMS], first);
    for (amplitude, factor) in amplitudes.iter_mut().zip(&series.factors[1..=series.terms]) {
        *amplitude = unit * factor;
        unit = next(unit);
    }
    amplitudes
}

/// Returns the number of the last Fourier mode to compute, and a bound on the sum of all later
/// modes. `size` must be such that mode n is at most `size`·n^−3. The later modes add up to less
/// than a quarter of `limit`, unless [`MAX_TERMS_ADDED`] limits the number. Returns `None` if the
/// bound is not less than `trivial`, or if the budget is too small for the modes.
fn last_mode(size: f64, limit: f64, trivial: f64, budget: &PixelBudget) -> Option<(f64, f64)> {
    // The sum of n^−3 over the odd n beyond an integer Q is at most 1/(4Q²). Here, Q is `last` − 1.
    let last = ((size / limit).sqrt().ceil() + 1.0).clamp(3.0, MAX_TERMS_ADDED);
    let beyond = size / (4.0 * (last - 1.0) * (last - 1.0));
    if beyond.is_nan() || beyond >= trivial || !budget.try_charge(last * MODE_WORK) {
        return None;
    }
    Some((last, beyond))
}

/// Returns the Fourier mode `n` of the first three terms of the series ([`EdgeSeries`]), summed
/// over an edge's crossings. `amplitudes` are those of mode 1 ([`amplitudes`]). `sums` contains the
/// sum of e^(iφ)·m^(−s) over the crossings for s = 3, 4 and 5, where φ is the mode's phase and m
/// the depth at a crossing. `amplitudes` and `sums` must have the same unit of depth.
fn mode(n: f64, amplitudes: &[f64; MODE_TERMS], sums: [Complex; MODE_TERMS]) -> f64 {
    let per_mode = 1.0 / n;
    let cube = per_mode * per_mode * per_mode;
    // Only the imaginary parts of the products are needed. The sums are multiplied by i^−2, i^−3
    // and i^−4, which are −1, i and 1.
    let [first, second, third] = [-sums[0][1], sums[1][0], sums[2][1]];
    let [a, b, c] = amplitudes;
    cube * (a * first + per_mode * (b * second + per_mode * c * third))
}
