//! Sums over the lines that an edge crosses, if the depth at least doubles along the edge. Each sum
//! is computed as a sum of Fourier modes. Green's theorem turns a board's integral into such sums
//! ([`green`](super::super::green)). The sum starts at a depth from which the expansion of the
//! Lerch series is accurate.

use std::{f64::consts::PI, ops::RangeInclusive};

use super::super::super::budget::PixelBudget;
use super::super::crossings::{EdgeSeries, LineCrossings};
use super::super::homography::{BoundedSum, UNIT};
use super::super::special::{cis, reduced_multiple, square, times};
use super::{
    LATER_TERMS_SHARE, MODE_TERMS, SKIPPED_SHARE, amplitudes, last_mode, lerch::lerch, mode,
};
use crate::math::Double;

/// Time to add one Fourier mode, divided by the time to add one crossing directly. The times were
/// measured as 12 ns and 3 ns. Their ratio decides after how many crossings the Fourier modes take
/// over.
const MODE_COST: f64 = 4.0;
/// Number n up to which every Fourier mode is computed. A later mode is skipped if its bound is
/// small. Measured: with 7, a picture of a horizon takes up to 20 % longer; with 123, it does not
/// become faster.
const FIRST_MODES: f64 = 31.0;
/// Fraction of an edge's tolerance that may be used up by leaving out all Fourier modes after the
/// last computed mode. The tolerance is divided among several kinds of errors. This kind gets the
/// largest fraction, because with a smaller fraction more modes would have to be computed.
const BEYOND_LAST_SHARE: f64 = 0.6;
/// Fraction of an edge's tolerance that may be used up by truncating the Lerch series ([`lerch`])
/// in the first term of the edge's series ([`EdgeSeries`]). Not critical: with 0.005 or 0.08, the
/// measured running time changes by less than 10 %.
const LERCH_SHARE: f64 = 0.02;
/// Minimum of w at which the Lerch series of the exponents s = 3 to 5 ([`lerch`]) are expanded in
/// 1/w. Here, w is the depth divided by its change from one crossing to the next. With this
/// minimum, each term of the expansion is at most about s/w < 1/3 times the previous term.
const MIN_W: f64 = 16.0;
/// Angle |θ| of a Fourier mode, in radians, below which |1 − e^iθ|² = 2 − 2·cos θ is replaced by a
/// lower bound proportional to θ². For such small angles, most digits of the difference cancel.
const SMALL_ANGLE: f64 = 0.2;
/// Lower bound of (2 − 2·cos θ)/θ² for |θ| < `SMALL_ANGLE`. The quotient differs from 1 by at most
/// θ²/12, a third of a percent.
const MIN_SQUARE_RATIO: f64 = 0.99;

/// Returns the depth at which the sum over an edge's crossings changes its method: crossings at a
/// smaller depth are added one by one, and Fourier modes give the sum over the others.
pub(super) fn start(all: &LineCrossings, series: &EdgeSeries, tolerance: f64) -> f64 {
    let g = all.rise;
    let factor = series.factors[1].abs();
    // At the depth `cheapest`, the total work is least. If the method changes at the depth m, (m −
    // m_0)/g crossings are added one by one, and κ/2m Fourier modes (κ is `kappa`) give the
    // remaining sum. Here m_0 is the depth at the first crossing, and g is the change of the depth
    // from one crossing to the next.
    let kappa =
        (factor * 4.0 / (PI * PI * PI) / (2.0 * g) / (4.0 * BEYOND_LAST_SHARE * tolerance)).sqrt();
    let cheapest = (0.5 * MODE_COST * kappa * g).sqrt();
    // From the depth `nothing` on, the rest of the sum is usually negligible: less than the
    // fraction `SKIPPED_SHARE` of the tolerance. Half of this fraction is reserved for the first
    // terms of the edge's series ([`EdgeSeries`]) at all these crossings. At the depth m, the first
    // term is at most `factor`·½/π·m^−3.
    let nothing = (factor * 0.25 / PI / g / (0.5 * SKIPPED_SHARE * tolerance)).sqrt() + g;
    // Two errors decrease with the depth m like m^−5. From the depth `steep` on, the truncation
    // error of the Fourier modes is within its fraction of the tolerance. From the depth `fourth`
    // on, the sum of the fourth and all later terms of the series X, which are not summed by modes,
    // is within its fraction. The factor of the fourth term is 0 if X has fewer terms.
    let steep = g * libm::pow(factor / (g * g * g) / (LERCH_SHARE * tolerance), 0.2);
    let fourth = series.factors[4].abs() / (10.0 * PI * PI * PI * PI * g);
    let fourth = libm::pow(fourth / (LATER_TERMS_SHARE * tolerance), 0.2);
    let least = cheapest.max(MIN_W * g).max(steep).max(fourth);
    least.min(nothing).max(all.depth)
}

/// Computes the alternating sum Σ (−1)^j·X over all crossings j from `crossing` to the horizon,
/// where j is 0 at `crossing`. `series` gives X, the edge's contribution at a crossing. `tolerance`
/// limits the truncation error. Returns 0 with a bound on the sum's absolute value if the sum is
/// negligible, or if the Fourier modes give no better bound or exceed the budget.
pub(super) fn sum_from(
    all: &LineCrossings,
    crossing: &Double,
    series: &EdgeSeries,
    tolerance: f64,
    budget: &PixelBudget,
) -> BoundedSum {
    let g = all.rise;
    let depth = all.depth + crossing.hi * g;
    let bound_of = |terms: RangeInclusive<usize>| -> f64 {
        terms.map(|k| absolute(series, k, depth, g)).sum()
    };
    let trivial = bound_of(1..=series.terms);
    let skipped = SKIPPED_SHARE * tolerance;
    if trivial <= skipped {
        return BoundedSum::zero_within(trivial);
    }
    let w = depth / g;
    // Term k of the series is proportional to w^(−2−k). The amplitudes do not contain this factor,
    // because the sums over crossings contain it.
    let amplitudes = amplitudes(series, 4.0 / (PI * PI * PI) / (g * g * g), |a| a / (PI * g));
    let [first, second, third] = amplitudes.map(f64::abs);
    let u = 1.0 / w;
    let u2 = u * u;
    let u3 = u2 * u;
    // Ratio of the truncation error of all terms of the edge's series to that of the first term.
    let all_terms = if first > 0.0 {
        1.0 + (second * u + third * u2) / first
    } else {
        1.0
    };
    // Mode n is at most `largest`·n^−3, because the Lerch series V_3 is at most w^−3 + w^−2/2.
    let largest = first * all_terms * (0.5 * u2 + u3);
    let limit = 4.0 * BEYOND_LAST_SHARE * tolerance;
    let Some((last, beyond)) = last_mode(largest, limit, trivial, budget) else {
        return BoundedSum::zero_within(trivial);
    };
    // By Abel's inequality, the Lerch series V_3 is at most 2·w^−3/|1 − e^iθ|. After `FIRST_MODES`,
    // mode n is skipped if this bound is below an allowance proportional to n^−2.
    let allowance = skipped * 2.0 * (FIRST_MODES - 1.0);
    let threshold = 2.0 * first * all_terms * u3 / allowance;
    let threshold = threshold * threshold;

    let step = all.alternating_step();
    let mut phase = cis(all.reduced_at(crossing).hi * PI);
    let mut angle = cis(step.hi * PI);
    let (phase_rotation, angle_rotation) = (square(phase), square(angle));
    let mut value = 0.0;
    let mut n = 1.0;
    while n <= last {
        let theta = reduced_multiple(n, &step) * PI;
        // `gap` is |1 − e^iθ|², or a lower bound if θ is so small that the cosine is inaccurate.
        let gap = if theta.abs() < SMALL_ANGLE {
            MIN_SQUARE_RATIO * theta * theta
        } else {
            2.0 - 2.0 * angle[0]
        };
        if n <= FIRST_MODES || gap * n * n < threshold {
            let sums = lerch(theta, angle, w).map(|v| times(phase, v));
            value += mode(n, &amplitudes, sums);
        }
        phase = times(phase, phase_rotation);
        angle = times(angle, angle_rotation);
        n += 2.0;
    }
    // The expansion of the Lerch series V_s stops before the term with the second derivative of the
    // regular function R (`tail`). For |θ| ≤ π, |R″|/2 ≤ 0.04, so that the truncation error of V_s
    // is at most 0.04·s·(s + 1)·w^(−s−2). Mode n has a factor of at most n^−3, and the sum of n^−3
    // over the odd n is less than 1.06.
    let curvature = 1.06 * 0.04 * u2 * u3 * (12.0 * first + 20.0 * second * u + 30.0 * third * u2);
    let later = bound_of(MODE_TERMS + 1..=series.terms);
    // The exponential integral F_3 has an error of up to 1e-14, or 90 unit roundoffs. F_5 has an
    // error of up to 1e-13, but it is divided by the square of the depth. The error of a Lerch
    // series V_s is less than 500 roundings, relative to w^−2. In mode n, the rotation of the phase
    // adds n roundings.
    let rounding = 1000.0 * UNIT * first * all_terms * u2;
    BoundedSum {
        value,
        bound: beyond + skipped + curvature + later + rounding,
    }
}

/// Returns an upper bound of the sum of the absolute values of term `k` of an edge's series
/// ([`EdgeSeries`]). The sum is over all points, from the depth `depth` on, at which the edge
/// crosses a line of the board. `rise` is the change of the depth from one of these points to the
/// next.
fn absolute(series: &EdgeSeries, k: usize, depth: f64, rise: f64) -> f64 {
    series.size(k, depth) * (1.0 + depth / (rise * (k + 1) as f64))
}
