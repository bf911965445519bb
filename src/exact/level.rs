//! Sums over the very many lines that an edge crosses on which m hardly changes.
//!
//! Crossing j of N lies at t_j = t + τj, m_j = m + gj with gN < m, and s changes its sign at every one. As in `horizon`,
//! Σ (−1)^j A_k+1(t_j) m_j^(−2−k) is a sum of modes, over the odd n,
//!
//! Im (4/π) e^(inπt)/(n (inπ)^(k+1)) Σ_j e^(iθj) m_j^(−2−k), θ = nπ(τ + 1) less turns,
//!
//! of which a few hundred are enough: the n-th is at most n^−3 of the sum of all sizes. Σ_j is what one series of Lerch's
//! has more than another that begins where the edge ends; or a geometric sum, where m does not change.

use super::board::{Sum, UNIT};
use super::complex::{Complex, phase, square, times, turned_times};
use super::edge::{Crossings, Series};
use super::horizon::{NOTHING_KNOWN, lerch};
use super::modes::MOST;
use crate::math::{Double, Real};
use std::f64::consts::PI;

/// What is neglected of the modes, in square pixels.
const NEGLECTED: f64 = 1e-12;
/// Where m changes by less than one part in so many, it is taken to be the same at all crossings.
const STEADY: f64 = 3e6;
/// The waves that have modes; of the later ones just the size is known.
const WAVES: usize = 3;

/// Σ (−1)^j X over all crossings, where |X| adds up to no more than `trivial`; of which as much as `tolerance` may be neglected.
pub(super) fn crossings(all: &Crossings, series: &Series, trivial: f64, tolerance: f64) -> Sum {
    let lines = all.lines;
    let size = |k: usize| lines * series.size(k, all.depth);
    let middle = all.depth + 0.5 * lines * all.edge.rise;
    let is_steady = all.edge.rise * lines * STEADY < middle;
    let start = if is_steady { middle } else { all.depth };
    let u = 1.0 / start;
    // The amplitudes of the mode n = 1.
    let mut amplitudes = [0.0; WAVES];
    let mut amplitude = 4.0 / (PI * PI * PI) * u * u * u;
    for k in 1..=WAVES.min(series.terms) {
        amplitudes[k - 1] = amplitude * series.factors[k];
        amplitude *= u / PI;
    }
    let neglected = NEGLECTED.max(0.05 * tolerance);
    // Σ n^−3 over the odd n beyond Q is at most 1/4Q²; of the trivial bound a mode is at most 8/π² n^−3.
    let last = ((trivial / neglected).sqrt().ceil() + 1.0).clamp(3.0, MOST);
    let beyond = trivial / (4.0 * (last - 1.0) * (last - 1.0));
    if beyond.is_nan() || beyond >= NOTHING_KNOWN {
        return Sum {
            value: 0.0,
            bound: trivial,
        };
    }

    let turning = all.turning();
    // Of the first crossing, and of the one after the last with the sign that it would have.
    let ends = [Double::from_f64(0.0), all.count].map(|j| phase(all.turned_at(&j).hi * PI));
    let steps = ends.map(square);
    let mut places = match all.count.floor().1 {
        true => [ends[0], ends[1].map(|x| -x)],
        false => ends,
    };
    // By Abel Σ_j of a mode is at most 2/|1 − e^iθ| by its first term, and that π/|θ|. All modes that are left out for it together are not
    // much more than is neglected anyhow: Σ n^−2 over the odd n is π²/8.
    let abel = PI
        * amplitudes
            .iter()
            .map(|amplitude| amplitude.abs())
            .sum::<f64>();
    let (mut value, mut skipped) = (0.0, 0.0);
    let mut n = 1.0;
    while n <= last {
        let theta = turned_times(n, &turning) * PI;
        let per_mode = 1.0 / n;
        let cube = per_mode * per_mode * per_mode;
        let at_most = cube * abel;
        if at_most <= neglected * per_mode * per_mode * theta.abs() {
            skipped += at_most / theta.abs();
        } else {
            let sums = if is_steady {
                [geometric(theta, lines, places); WAVES]
            } else {
                partial(theta, start / all.edge.rise, lines, places)
            };
            // i^−2, i^−3 and i^−4 are −1, i and 1.
            let [first, second, third] = sums;
            let waves = -amplitudes[0] * first[1]
                + per_mode * (amplitudes[1] * second[0] + per_mode * amplitudes[2] * third[1]);
            value += cube * waves;
        }
        places = [0, 1].map(|end| times(places[end], steps[end]));
        n += 2.0;
    }
    let later: f64 = (WAVES + 1..=series.terms).map(size).sum();
    // m^−s is off by s·gN/2m from its value in the middle.
    let unsteady = if is_steady { 4.0 / STEADY } else { 0.0 };
    // The ends are off by a few roundings of a turn, n times that in the mode n, and θ by one of itself. The series of Lerch are good to
    // some 500 units in the last place of w/2 times their first term, and lack up to 0.04·s(s + 1)/w²; there are two.
    let lerch = if is_steady {
        0.0
    } else {
        let w = start / all.edge.rise;
        1000.0 * UNIT * w / lines + 2.4 / (w * lines)
    };
    let rounding = UNIT * (64.0 + 8.0 * last);
    Sum {
        value,
        bound: beyond + skipped + later + trivial * (unsteady + lerch + rounding),
    }
}

/// Σ e^(iθj) over j < N by the place of the first, where that of the N-th would be e^(iθN) as much.
fn geometric(theta: f64, lines: f64, [place, last]: [Complex; 2]) -> Complex {
    let half = 0.5 * theta;
    let sine = libm::sin(half);
    if (theta * lines).abs() < 1.0 {
        let ratio = match sine {
            0.0 => lines,
            sine => libm::sin(half * lines) / sine,
        };
        let middle = phase(half * (lines - 1.0));
        return times(place, middle.map(|x| ratio * x));
    }
    // 1 − e^(iθ) is −2i·sin(θ/2)·e^(iθ/2).
    let difference = [place[0] - last[0], place[1] - last[1]];
    let [x, y] = times(difference, phase(-half));
    [-0.5 * y / sine, 0.5 * x / sine]
}

/// Σ e^(iθj) (1 + j/w)^(−s) over j < N, for s = 3, 4, 5, by the same places.
fn partial(theta: f64, w: f64, lines: f64, [place, last]: [Complex; 2]) -> [Complex; WAVES] {
    let angle = phase(theta);
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
            let [x, y] = phase(theta * j);
            let size = libm::pow(1.0 + j / w, -f64::from(s));
            sum = [sum[0] + size * x, sum[1] + size * y];
            j += 1.0;
        }
        sum
    }

    /// Places from 0 on.
    fn places(theta: f64, lines: f64) -> [Complex; 2] {
        [phase(0.0), phase(theta * lines)]
    }

    fn close(found: Complex, expected: Complex, most: f64) {
        let error = (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs();
        assert!(error <= most, "{found:?}, not {expected:?}: {error:e}");
    }

    #[test]
    fn geometric_sums() {
        for theta in [0.0, 1e-9, -1e-3, 0.7, 3.0, -PI] {
            // The angles of one by one are off by up to 1000·3·2⁻⁵³.
            close(
                geometric(theta, 1000.0, places(theta, 1000.0)),
                one_by_one(theta, f64::INFINITY, 1000.0, 3),
                1e-9,
            );
        }
    }

    #[test]
    fn what_a_series_has_before_another_begins() {
        for theta in [0.0, 1e-6, -1e-3, 0.02, 0.7, 3.0, -PI] {
            let found = partial(theta, 5000.0, 3000.0, places(theta, 3000.0));
            for (s, found) in (3..).zip(found) {
                // Of what lerch neglects, 0.04·s(s + 1)/w², 5e-8 is left; 500 roundings of w/2 are 3e-10.
                close(found, one_by_one(theta, 5000.0, 3000.0, s), 1e-7);
            }
        }
    }
}
