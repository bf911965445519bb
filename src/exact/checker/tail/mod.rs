//! Sums over very many lines that an edge crosses, or over infinitely many.
//!
//! In: an edge's crossings with the lines of one family, and the series X of
//! [`green`](super::green). Out: Σ (−1)^j X with a bound on truncation and rounding errors.
//!
//! Crossing j lies at t_j = t + τj, m_j = g(w + j), and s changes its sign at every crossing. With
//! A_k = Im (4/π) Σ_n e^(iπnt)/(n (iπn)^k) over the odd n, Σ_j (−1)^j A_k+1(t_j) m_j^(−2−k) is the
//! sum of the Fourier modes
//!
//! g^(−2−k) Im (4/π) e^(iπnt)/(n (iπn)^(k+1)) V(θ), V_s(θ) = Σ_j e^(iθj) (w + j)^(−s), s = k + 2, θ
//! = nπ(τ + 1) reduced by whole turns.
//!
//! V is a Lerch series. (w + j)^(−s) = ∫ x^(s−1) e^(−(w+j)x) dx/Γ(s), so that V = ∫ x^(s−1)
//! e^(−wx)/(1 − e^(iθ−x)) dx/Γ(s). The pole at x = iθ contributes w^(1−s)·e^z E_s(z), z = −iθw, an
//! exponential integral (DLMF 8.19). The Taylor series of the regular rest R(ζ) = 1/(1 − e^(−ζ)) −
//! 1/ζ about ζ = −iθ contributes w^(−s)·(R + R′·s/w + …), term by term. This is the Euler–Maclaurin
//! sum at θ = 0 (a direction along the board's diagonal), and Boole's at θ = π.
//!
//! If m at least doubles along the edge, the first crossings are added one by one, and modes give
//! the rest ([`receding`]).
//!
//! If m hardly changes along N crossings, the n-th mode is at most n^−3 of the sum of all absolute
//! terms, so that a few hundred modes are enough. Σ_j is then the difference of two Lerch series,
//! of which the second starts where the edge ends, or a geometric sum if m does not change
//! ([`level`]).

mod lerch;
mod level;
mod receding;

use super::super::budget::PixelBudget;
use super::crossings::{EdgeSeries, LineCrossings};
use super::homography::BoundedSum;
use super::special::Complex;
use crate::math::{Double, Real};

/// Number of terms of X that are summed by Fourier modes; later terms are only bounded.
const MODE_TERMS: usize = 3;

/// Number of crossings up to which they are added one by one: 60 µs, at 3 ns each. (Measured: with
/// 5000 or 80,000, times differ by less than a tenth.)
const MAX_DIRECT: f64 = 20_000.0;
/// Maximum number of crossings, or of modes, that are added for an edge, which takes some
/// milliseconds. The rest is only bounded.
const MAX_TERMS_ADDED: f64 = 300_000.0;
/// Fraction of the tolerance for a sum that is left out, and again for modes that are skipped. All
/// fractions together are less than 1.
const SKIPPED_SHARE: f64 = 0.25;
/// Fraction of the tolerance for the terms of X that have no modes. (Measured: a quarter and four
/// times as much change times by less than a tenth.)
const LATER_TERMS_SHARE: f64 = 0.05;
/// Work per crossing, in units of about 50 ns.
const CROSSING_WORK: f64 = 1.0 / 16.0;
/// Work per mode, in units of about 50 ns.
const MODE_WORK: f64 = 1.0 / 4.0;

/// Computes Σ (−1)^j X over all crossings; `tolerance` limits the truncation error.
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
        // If m does not even double, the modes of the ends do not decay.
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
        // Crossing j has the sign (−1)^j, and the sum beyond the last crossing is subtracted.
        let odd = crossing.floor().1 != (end == 1);
        sum.value += if odd { -rest.value } else { rest.value };
        sum.bound += rest.bound;
    }
    sum
}

/// Returns the amplitudes of X's first terms in the mode n = 1. `first` is that of a first term
/// with the factor 1, and `next` leads from each term to the next.
fn amplitudes(series: &EdgeSeries, first: f64, next: impl Fn(f64) -> f64) -> [f64; MODE_TERMS] {
    let (mut amplitudes, mut unit) = ([0.0; MODE_TERMS], first);
    for (amplitude, factor) in amplitudes.iter_mut().zip(&series.factors[1..=series.terms]) {
        *amplitude = unit * factor;
        unit = next(unit);
    }
    amplitudes
}

/// Returns the last mode to compute and a bound on all later ones. `size` bounds the modes without
/// their factor n^−3; the later ones are less than a quarter of `limit`, unless the modes are too
/// many. Returns `None` if the bound `trivial` is no worse, or the budget does not afford the
/// modes.
fn last_mode(size: f64, limit: f64, trivial: f64, budget: &PixelBudget) -> Option<(f64, f64)> {
    // Σ n^−3 over the odd n beyond an integer Q is at most 1/4Q².
    let last = ((size / limit).sqrt().ceil() + 1.0).clamp(3.0, MAX_TERMS_ADDED);
    let beyond = size / (4.0 * (last - 1.0) * (last - 1.0));
    if beyond.is_nan() || beyond >= trivial || !budget.try_charge(last * MODE_WORK) {
        return None;
    }
    Some((last, beyond))
}

/// Returns mode n of X's first terms from their amplitudes and their sums
/// Σ e^(iπnt + iθj) (w + j)^(−s).
fn mode(n: f64, amplitudes: &[f64; MODE_TERMS], sums: [Complex; MODE_TERMS]) -> f64 {
    let per_mode = 1.0 / n;
    let cube = per_mode * per_mode * per_mode;
    // i^−2, i^−3 and i^−4 are −1, i and 1; these are the imaginary parts of those times the sums.
    let [first, second, third] = [-sums[0][1], sums[1][0], sums[2][1]];
    let [a, b, c] = amplitudes;
    cube * (a * first + per_mode * (b * second + per_mode * c * third))
}
