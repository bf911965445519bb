//! Sums over the lines that an edge crosses, if the depth less than doubles along the edge. Each
//! sum is computed as a sum of Fourier modes. Green's theorem turns a board's integral into such
//! sums ([`green`](super::super::green)).

use std::f64::consts::PI;

use super::super::super::budget::PixelBudget;
use super::super::crossings::{EdgeSeries, LineCrossings};
use super::super::homography::{BoundedSum, UNIT};
use super::super::special::{Complex, cis, reduced_multiple, square, times};
use super::{LATER_TERMS_SHARE, MODE_TERMS, amplitudes, last_mode, lerch::lerch, mode};
use crate::math::{Double, Real};

/// Maximum truncation error of a sum over an edge's crossings, as a fraction of the pixel's
/// tolerance, if the depth less than doubles along the edge. A thousandth hardly adds to the
/// pixel's error. The maximum is never less than the fraction [`LATER_TERMS_SHARE`] of the edge's
/// own tolerance.
const LEVEL_TRUNCATION: f64 = 1e-3;
/// Minimum ratio of the depth in the middle of an edge to the change of the depth along the edge,
/// at which the depth is treated as constant. This approximation adds at most the fraction
/// 4/`STEADY`, about 1e-6, of the sum of the terms' absolute values to the error bound. Measured:
/// with 7.5e5 or 1.2e7, no bound changes.
const STEADY: f64 = 3e6;

/// Computes the alternating sum Σ (−1)^j·X over the crossings j of an edge along which the depth
/// less than doubles. `series` gives X, the edge's contribution at a crossing. `trivial` is an
/// upper bound of the sum's absolute value, and `tolerance` limits the truncation error. Returns 0
/// with the bound `trivial` if the Fourier modes give no better bound or exceed the budget.
pub(super) fn sum(
    all: &LineCrossings,
    series: &EdgeSeries,
    trivial: f64,
    tolerance: f64,
    budget: &PixelBudget,
) -> BoundedSum {
    let lines = all.count.hi;
    let middle = all.depth + 0.5 * lines * all.rise;
    let is_steady = all.rise * lines * STEADY < middle;
    let start = if is_steady { middle } else { all.depth };
    let (w, u) = (start / all.rise, 1.0 / start);
    let amplitudes = amplitudes(series, 4.0 / (PI * PI * PI) * u * u * u, |a| a * (u / PI));
    let neglected = (LEVEL_TRUNCATION * budget.tolerance).max(LATER_TERMS_SHARE * tolerance);
    // The Fourier mode n is at most 8/π²·n^−3 times `trivial`, the bound of the whole sum. This is
    // at most `trivial`·n^−3, as `last_mode` requires.
    let Some((last, beyond)) = last_mode(trivial, neglected, trivial, budget) else {
        return BoundedSum::zero_within(trivial);
    };

    let step = all.alternating_step();
    // e^(iφ) at the first crossing, and at the position of a crossing that would follow the last. φ
    // is the phase of mode 1 there.
    let ends = [Double::from_f64(0.0), all.count].map(|j| cis(all.reduced_at(&j).hi * PI));
    let rotations = ends.map(square);
    let mut phases = ends;
    if all.count.floor().1 {
        phases[1] = ends[1].map(|x| -x);
    }
    // By Abel's inequality, the sum of a mode over the crossings is at most 2/|1 − e^iθ| ≤ π/|θ|
    // times the mode's first term. Mode n is skipped if this bound is at most n^−2·`neglected`. All
    // skipped modes together are then at most π²/8·`neglected`, because Σ n^−2 over the odd n is
    // π²/8.
    let abel = PI
        * amplitudes
            .iter()
            .map(|amplitude| amplitude.abs())
            .sum::<f64>();
    let (mut value, mut skipped) = (0.0, 0.0);
    let mut n = 1.0;
    while n <= last {
        let theta = reduced_multiple(n, &step) * PI;
        let per_mode = 1.0 / n;
        let at_most = per_mode * per_mode * per_mode * abel;
        if at_most <= neglected * per_mode * per_mode * theta.abs() {
            skipped += at_most / theta.abs();
        } else {
            let sums = if is_steady {
                [geometric(theta, lines, phases); MODE_TERMS]
            } else {
                partial(theta, w, lines, phases)
            };
            value += mode(n, &amplitudes, sums);
        }
        phases = [0, 1].map(|end| times(phases[end], rotations[end]));
        n += 2.0;
    }
    let later: f64 = (MODE_TERMS + 1..=series.terms)
        .map(|k| lines * series.size(k, all.depth))
        .sum();
    // If the depth m is treated as constant, m^−s is replaced by its value in the middle of the
    // edge, where s is 3, 4 or 5. The relative error is at most s·gN/2m, where N is the number of
    // crossings, and g is the change of m from one crossing to the next.
    //
    // Otherwise, the sum is a difference of two Lerch series. Relative to its first term, each
    // series has a rounding error of about 500·w/2 unit roundoffs and a truncation error of at most
    // 0.04·s·(s + 1)/w².
    let model = if is_steady {
        4.0 / STEADY
    } else {
        500.0 * UNIT * w / lines + 2.4 / (w * w * lines)
    };
    // Up to mode n, the phase at each end of the edge is multiplied n/2 times by a rotation. Each
    // product is computed with four roundings, which makes 4n roundings at the two ends. The
    // rounding errors of the rotations add up to another 4n. A mode requires about 30 more
    // operations at each end.
    let rounding = UNIT * (64.0 + 8.0 * last);
    BoundedSum {
        value,
        bound: beyond + skipped + later + trivial * (model + rounding),
    }
}

/// Returns e^(iφ)·Σ e^(iθj) over 0 ≤ j < N, where N is `lines`. `place` is the phase e^(iφ) of the
/// first term, and `last` is e^(iφ + iθN).
fn geometric(theta: f64, lines: f64, [place, last]: [Complex; 2]) -> Complex {
    let half = 0.5 * theta;
    let sine = libm::sin(half);
    if (theta * lines).abs() < 1.0 {
        let ratio = match sine {
            0.0 => lines,
            sine => libm::sin(half * lines) / sine,
        };
        let middle = cis(half * (lines - 1.0));
        return times(place, middle.map(|x| ratio * x));
    }
    // The sum is `difference` divided by 1 − e^(iθ) = −2i·sin(θ/2)·e^(iθ/2).
    let difference = [place[0] - last[0], place[1] - last[1]];
    let [x, y] = times(difference, cis(-half));
    [-0.5 * y / sine, 0.5 * x / sine]
}

/// Returns e^(iφ)·Σ e^(iθj)·(1 + j/w)^(−s) over 0 ≤ j < N for s = 3, 4, 5, where N is `lines`.
/// `place` is the phase e^(iφ) of the first term, and `last` is e^(iφ + iθN).
fn partial(theta: f64, w: f64, lines: f64, [place, last]: [Complex; 2]) -> [Complex; MODE_TERMS] {
    let angle = cis(theta);
    let (from, to) = (lerch(theta, angle, w), lerch(theta, angle, w + lines));
    let mut power = w * w;
    std::array::from_fn(|s| {
        power *= w;
        let (sum, rest) = (times(place, from[s]), times(last, to[s]));
        [power * (sum[0] - rest[0]), power * (sum[1] - rest[1])]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_by_one(theta: f64, w: f64, lines: f64, s: i32) -> Complex {
        let mut sum = [0.0; 2];
        let mut j = 0.0;
        while j < lines {
            let [x, y] = cis(theta * j);
            let size = libm::pow(1.0 + j / w, -f64::from(s));
            sum = [sum[0] + size * x, sum[1] + size * y];
            j += 1.0;
        }
        sum
    }

    /// Returns the last argument of [`geometric`] and [`partial`] for φ = 0: the numbers 1 and
    /// e^(iθN), where N is `lines`.
    fn places(theta: f64, lines: f64) -> [Complex; 2] {
        [cis(0.0), cis(theta * lines)]
    }

    fn close(found: Complex, expected: Complex, most: f64) {
        let error = (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs();
        assert!(error <= most, "{found:?}, not {expected:?}: {error:e}");
    }

    #[test]
    fn geometric_sums() {
        for theta in [0.0, 1e-9, -1e-3, 0.7, 3.0, -PI] {
            // The tolerance covers the errors of the direct sum, whose angles have errors of up to
            // 1000·3·2⁻⁵³.
            close(
                geometric(theta, 1000.0, places(theta, 1000.0)),
                one_by_one(theta, f64::INFINITY, 1000.0, 3),
                1e-9,
            );
        }
    }

    #[test]
    fn partial_sums_of_lerch_series() {
        for theta in [0.0, 1e-6, -1e-3, 0.02, 0.7, 3.0, -PI] {
            let found = partial(theta, 5000.0, 3000.0, places(theta, 3000.0));
            for (s, found) in (3..).zip(found) {
                // `partial` is a difference of two Lerch series. Relative to the first term, a
                // series has a truncation error of at most 0.04·s·(s + 1)/w², which is 5e-8 at w =
                // 5000 and s = 5. The rounding errors of both series add up to 3e-10.
                close(found, one_by_one(theta, 5000.0, 3000.0, s), 1e-7);
            }
        }
    }
}
