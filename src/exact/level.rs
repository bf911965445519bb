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
use super::complex::{Complex, phase, square, times, turn};
use super::edge::{Crossings, Series};
use super::horizon::lerch;
use std::f64::consts::PI;

/// What is neglected of the modes, in square pixels.
const NEGLECTED: f64 = 1e-12;
/// Where m changes by less than one part in so many, it is taken to be the same at all crossings.
const STEADY: f64 = 3e6;
/// The waves that have modes; of the later ones just the size is known.
const WAVES: usize = 3;

/// Σ (−1)^j X over all crossings, where |X| adds up to no more than `trivial`.
pub(super) fn crossings(all: &Crossings, series: &Series, trivial: f64) -> Sum {
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
    // Σ n^−3 over the odd n beyond Q is at most 1/4Q²; of the trivial bound a mode is at most 8/π² n^−3.
    let last = ((trivial / NEGLECTED).sqrt().ceil() + 1.0).max(3.0);
    let beyond = trivial / (4.0 * (last - 1.0) * (last - 1.0));

    let stride = turn(all.edge.stride);
    let stride = stride - 1.0_f64.copysign(stride);
    let mut place = phase(turn(all.t) * PI);
    let place_step = square(place);
    let mut value = 0.0;
    let mut n = 1.0;
    while n <= last {
        let theta = turn(n * stride) * PI;
        let sums = if is_steady {
            [geometric(theta, lines); WAVES]
        } else {
            partial(theta, start / all.edge.rise, lines)
        };
        // i^−2, i^−3 and i^−4 are −1, i and 1.
        let [first, second, third] = sums.map(|sum| times(place, sum));
        let per_mode = 1.0 / n;
        let waves = -amplitudes[0] * first[1]
            + per_mode * (amplitudes[1] * second[0] + per_mode * amplitudes[2] * third[1]);
        value += per_mode * per_mode * per_mode * waves;
        place = times(place, place_step);
        n += 2.0;
    }
    let later: f64 = (WAVES + 1..=series.terms).map(size).sum();
    // m^−s is off by s·gN/2m from its value in the middle.
    let unsteady = if is_steady { 4.0 / STEADY } else { 0.0 };
    // A crossing is off by a few roundings of t, which X′, at most π X's bound, takes to X. The series of Lerch are good to
    // some 500 units in the last place of w/2 times their first term, and lack up to 0.04·s(s + 1)/w²; there are two.
    let reach = all.t.abs() + lines * all.edge.stride.abs();
    let lerch = if is_steady {
        0.0
    } else {
        let w = start / all.edge.rise;
        1000.0 * UNIT * w / lines + 2.4 / (w * lines)
    };
    let rounding = UNIT * (16.0 + 8.0 * PI * reach + last);
    Sum {
        value,
        bound: beyond + later + trivial * (unsteady + lerch + rounding),
    }
}

/// Σ e^(iθj) over j < N.
fn geometric(theta: f64, lines: f64) -> Complex {
    let half = 0.5 * theta;
    let ratio = match libm::sin(half) {
        0.0 => lines,
        sine => libm::sin(turn(half / PI * lines) * PI) / sine,
    };
    let middle = phase(turn(half / PI * (lines - 1.0)) * PI);
    [ratio * middle[0], ratio * middle[1]]
}

/// Σ e^(iθj) (1 + j/w)^(−s) over j < N, for s = 3, 4, 5.
fn partial(theta: f64, w: f64, lines: f64) -> [Complex; WAVES] {
    let angle = phase(theta);
    let (from, to) = (lerch(theta, angle, w), lerch(theta, angle, w + lines));
    let end = phase(turn(theta / PI * lines) * PI);
    let mut power = w * w;
    std::array::from_fn(|s| {
        power *= w;
        let rest = times(end, to[s]);
        [
            power * (from[s][0] - rest[0]),
            power * (from[s][1] - rest[1]),
        ]
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

    fn close(found: Complex, expected: Complex, most: f64) {
        let error = (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs();
        assert!(error <= most, "{found:?}, not {expected:?}: {error:e}");
    }

    #[test]
    fn geometric_sums() {
        for theta in [0.0, 1e-9, -1e-3, 0.7, 3.0, -PI] {
            // The angles of one by one are off by up to 1000·3·2⁻⁵³.
            close(
                geometric(theta, 1000.0),
                one_by_one(theta, f64::INFINITY, 1000.0, 3),
                1e-9,
            );
        }
    }

    #[test]
    fn what_a_series_has_before_another_begins() {
        for theta in [0.0, 1e-6, -1e-3, 0.02, 0.7, 3.0, -PI] {
            let found = partial(theta, 5000.0, 3000.0);
            for (s, found) in (3..).zip(found) {
                // Of what lerch neglects, 0.04·s(s + 1)/w², 5e-8 is left; 500 roundings of w/2 are 3e-10.
                close(found, one_by_one(theta, 5000.0, 3000.0, s), 1e-7);
            }
        }
    }
}
