//! Sums over the very many lines that an edge crosses, or that never end.
//!
//! In: an edge's crossings with the lines of one family, and the series X of
//! [`green`](super::green). Out: Σ (−1)^j X with a bound: what is neglected of modes and of the
//! series, and the roundings of what is added.
//!
//! Crossing j lies at t_j = t + τj, m_j = g(w + j), and s changes its sign at every one. With
//! A_k = Im (4/π) Σ_n e^(iπnt)/(n (iπn)^k) over the odd n, Σ_j (−1)^j A_k+1(t_j) m_j^(−2−k) is the
//! sum of the modes
//!
//! g^(−2−k) Im (4/π) e^(iπnt)/(n (iπn)^(k+1)) V(θ), V_s(θ) = Σ_j e^(iθj) (w + j)^(−s), s = k + 2, θ
//! = nπ(τ + 1) less turns,
//!
//! a Lerch series. (w + j)^(−s) = ∫ x^(s−1) e^(−(w+j)x) dx/Γ(s), so that V = ∫ x^(s−1) e^(−wx)/(1 −
//! e^(iθ−x)) dx/Γ(s); the pole at x = iθ gives w^(1−s)·e^z E_s(z), z = −iθw, an exponential
//! integral (DLMF 8.19), and Taylor's series of the regular rest R(ζ) = 1/(1 − e^(−ζ)) − 1/ζ about
//! ζ = −iθ gives w^(−s)·(R + R′·s/w + …), term by term. It is the Euler–Maclaurin sum at θ = 0 (a
//! direction along the board's diagonal), and Boole's at θ = π.
//!
//! Where m hardly changes along N crossings, the n-th mode is at most n^−3 of the sum of all sizes,
//! so that a few hundred are enough. Σ_j is then what one Lerch series has more than another that
//! begins where the edge ends; or a geometric sum, where m does not change.

use super::super::budget::Budget;
use super::crossings::{LineCrossings, Series};
use super::homography::{Sum, UNIT};
use super::special::{Complex, integrals, phase, square, times, turned_times};
use crate::math::{Double, Real};
use std::f64::consts::PI;

/// What is neglected of the modes, as a part of the bound that is asked for.
const NEGLECTED: f64 = 1e-3;
/// Where m changes by less than one part in so many, it is taken to be the same at all crossings;
/// the bound adds 4/STEADY of the sum for that, which is 1e-6 of something that is itself small
/// where crossings are many. (Measured: a quarter and four times as much change no bound.)
const STEADY: f64 = 3e6;
/// The terms of X that are summed by Fourier modes; later terms are only bounded.
const MODE_TERMS: usize = 3;

/// Up to so many crossings are added one by one: 60 µs, at 3 ns each. (Measured: with 5000 or
/// 80,000 times differ by less than a tenth.)
const SHORT: f64 = 20_000.0;
/// No more crossings than these, nor modes, are added for an edge: that takes some milliseconds. Of
/// the rest the bound says how much it may be.
const MOST: f64 = 300_000.0;
/// The time that a mode takes, in crossings: 12 ns against 3, as measured.
const MODE_COST: f64 = 4.0;
/// The modes up to this one are always computed; a later one may be skipped where it is small.
/// (Measured: with 7 a horizon takes up to a fifth longer, and with 123 no less.)
const FIRST_MODES: f64 = 31.0;
/// Shares of the tolerance, which together are less than all of it: of a sum that is left out, and
/// as much for modes that are; of the modes beyond the last one; of what V_s lacks in the first
/// term of X, and of the terms that have no modes. (Measured: the last two, a quarter and four
/// times as great, change times by less than a tenth.)
const LEFT_OUT: f64 = 0.25;
const BEYOND: f64 = 0.6;
const LACKING: f64 = 0.02;
const LATER: f64 = 0.05;
/// The series in 1/w is not used below this w: its terms fall by s/w and more, to a third each.
const LEAST_W: f64 = 16.0;
/// Below this |θ|, 2 − 2cos θ is θ² to within θ²/12, a third of a percent, and at least this part
/// of it; a computed cosine leaves little of it.
const SMALL_ANGLE: f64 = 0.2;
const PART_OF_SQUARE: f64 = 0.99;
/// Up to this |θ| Taylor's series stand for the rest of the pole: the next term, θ⁹/47900160, is
/// 100 roundings of the 500 that V may be off by.
const NEAR_POLE: f64 = 0.2;
/// Units of work (some 50 ns each) for a crossing, and for a mode.
const CROSSING_WORK: f64 = 1.0 / 16.0;
const MODE_WORK: f64 = 1.0 / 4.0;

/// Σ (−1)^j X over all crossings, of which as much as `tolerance` may be neglected.
pub(super) fn sum(all: &LineCrossings, series: &Series, tolerance: f64, budget: &Budget) -> Sum {
    let lines = all.count.hi;
    let trivial = lines
        * (1..=series.terms)
            .map(|k| series.size(k, all.depth))
            .sum::<f64>();
    let is_little = lines > SHORT && trivial <= LEFT_OUT * tolerance;
    let trivial_sum = Sum {
        value: 0.0,
        bound: trivial,
    };
    let one_by_one = |lines: f64| {
        budget
            .spend(lines * CROSSING_WORK)
            .then(|| all.one_by_one(series, lines, tolerance))
    };
    if is_little {
        return trivial_sum;
    }
    if lines <= SHORT {
        return one_by_one(lines).unwrap_or(trivial_sum);
    }
    if all.rise * lines < all.depth {
        // Where m does not even double, the modes of the ends do not fall off.
        let sum = level(all, series, trivial, tolerance, budget);
        let is_better_one_by_one = sum.bound > tolerance && lines <= MOST;
        let other = is_better_one_by_one.then(|| one_by_one(lines));
        return other.flatten().unwrap_or(sum);
    }
    let direct = ((start(all, series, tolerance) - all.depth) / all.rise)
        .ceil()
        .clamp(0.0, MOST);
    if direct + SHORT >= lines && lines <= MOST {
        return one_by_one(lines).unwrap_or(trivial_sum);
    }
    let Some(mut sum) = one_by_one(direct) else {
        return trivial_sum;
    };
    let ends = [
        Some(Double::from_f64(direct)),
        lines.is_finite().then_some(all.count),
    ];
    let share = tolerance / ends.iter().flatten().count() as f64;
    for (end, lines) in ends.iter().enumerate() {
        let Some(lines) = lines else { continue };
        let rest = rest(all, lines, series, share, budget);
        // Crossing j has the sign (−1)^j; and what lies beyond the last one is subtracted.
        let odd = lines.floor().1 != (end == 1);
        sum.value += if odd { -rest.value } else { rest.value };
        sum.bound += rest.bound;
    }
    sum
}

/// A bound on Σ |X| of everything from a depth on, of term k.
fn absolute(series: &Series, k: usize, depth: f64, rise: f64) -> f64 {
    series.size(k, depth) * (1.0 + depth / (rise * (k + 1) as f64))
}

/// The depth from which to sum by modes.
fn start(all: &LineCrossings, series: &Series, tolerance: f64) -> f64 {
    let g = all.rise;
    let factor = series.factors[1].abs();
    // The cheapest: (m − m_0)/g crossings and κ/2m modes.
    let kappa = (factor * 4.0 / (PI * PI * PI) / (2.0 * g) / (4.0 * BEYOND * tolerance)).sqrt();
    let cheapest = (0.5 * MODE_COST * kappa * g).sqrt();
    // Where so little is left that it may be neglected, the first term's bound being ½/π of its
    // factor.
    let nothing = (factor * 0.25 / PI / g / (0.5 * LEFT_OUT * tolerance)).sqrt() + g;
    // What is neglected of a mode is w^−5, of the terms from A_5 on m^−5.
    let steep = g * libm::pow(factor / (g * g * g) / (LACKING * tolerance), 0.2);
    let fourth = match series.terms {
        4.. => libm::pow(
            series.factors[4].abs() / (10.0 * PI * PI * PI * PI * g) / (LATER * tolerance),
            0.2,
        ),
        _ => 0.0,
    };
    cheapest
        .max(LEAST_W * g)
        .max(steep)
        .max(fourth)
        .min(nothing)
        .max(all.depth)
}

/// Σ (−1)^j X from crossing `direct` on, with j counted from there.
fn rest(
    all: &LineCrossings,
    direct: &Double,
    series: &Series,
    tolerance: f64,
    budget: &Budget,
) -> Sum {
    let g = all.rise;
    let depth = all.depth + direct.hi * g;
    let everything: f64 = (1..=series.terms)
        .map(|k| absolute(series, k, depth, g))
        .sum();
    if everything <= LEFT_OUT * tolerance {
        return Sum {
            value: 0.0,
            bound: everything,
        };
    }
    let w = depth / g;
    let f = &series.factors;
    // The amplitudes of X's first three terms in the mode n = 1, in which w^(−2−k) is still
    // missing.
    let mut amplitudes = [0.0; MODE_TERMS];
    let mut amplitude = 4.0 / (PI * PI * PI) / (g * g * g);
    for k in 1..=MODE_TERMS.min(series.terms) {
        amplitudes[k - 1] = f[k] * amplitude;
        amplitude /= PI * g;
    }
    let first = amplitudes[0].abs();
    let u = 1.0 / w;
    let u2 = u * u;
    let u3 = u2 * u;
    // The later terms' share in what is neglected.
    let all_terms = if first > 0.0 {
        1.0 + (amplitudes[1].abs() * u + amplitudes[2].abs() * u2) / first
    } else {
        1.0
    };
    // |V_3| ≤ w^−3 + w^−2/2, and Σ n^−3 over the odd n beyond a whole number Q is at most 1/4Q².
    let largest = first * all_terms * (0.5 * u2 + u3);
    let last = ((largest / (4.0 * BEYOND * tolerance)).sqrt().ceil() + 1.0).clamp(3.0, MOST);
    let beyond = largest / (4.0 * (last - 1.0) * (last - 1.0));
    if beyond.is_nan() || beyond >= everything || !budget.spend(last * MODE_WORK) {
        return Sum {
            value: 0.0,
            bound: everything,
        };
    }
    // By Abel |V_3| ≤ 2w^−3/|1 − e^iθ|: a late mode n is skipped where this is below an allowance
    // that falls as n^−2.
    let allowance = LEFT_OUT * tolerance * 2.0 * (FIRST_MODES - 1.0);
    let skipped = LEFT_OUT * tolerance;
    let threshold = 2.0 * first * all_terms * u3 / allowance;
    let threshold = threshold * threshold;

    let turning = all.turning();
    let mut place = phase(all.turned_at(direct).hi * PI);
    let mut angle = phase(turning.hi * PI);
    let (place_step, angle_step) = (square(place), square(angle));
    let mut value = 0.0;
    let mut n = 1.0;
    while n <= last {
        let theta = turned_times(n, &turning) * PI;
        // |1 − e^iθ|², of which a cosine would leave nothing where θ is small.
        let gap = match theta.abs() < SMALL_ANGLE {
            true => PART_OF_SQUARE * theta * theta,
            false => 2.0 - 2.0 * angle[0],
        };
        if n <= FIRST_MODES || gap * n * n < threshold {
            let v = lerch(theta, angle, w);
            let per_mode = 1.0 / n;
            let n3 = per_mode * per_mode * per_mode;
            // i^−2, i^−3 and i^−4 are −1, i and 1; the imaginary parts of those times e^(inπt)·V.
            let e = place;
            let k1 = -(e[0] * v[0][1] + e[1] * v[0][0]);
            let k2 = e[0] * v[1][0] - e[1] * v[1][1];
            let k3 = e[0] * v[2][1] + e[1] * v[2][0];
            value += n3
                * (amplitudes[0] * k1
                    + per_mode * (amplitudes[1] * k2 + per_mode * amplitudes[2] * k3));
        }
        place = times(place, place_step);
        angle = times(angle, angle_step);
        n += 2.0;
    }
    // |R″|/2 ≤ 0.04 for |θ| ≤ π, so that V_s lacks at most 0.04·s(s + 1)·w^(−s−2); Σ n^−3 < 1.06.
    let curvature = 1.06
        * 0.04
        * u2
        * u3
        * (12.0 * first + 20.0 * amplitudes[1].abs() * u + 30.0 * amplitudes[2].abs() * u2);
    let later: f64 = (4..=series.terms)
        .map(|k| absolute(series, k, depth, g))
        .sum();
    // The integrals are good to 1e-14, which is 90 units in the last place, and V to 500 for
    // certain, of w^−2; rotation adds n of them, to the n-th mode.
    let rounding = 1000.0 * UNIT * first * all_terms * u2;
    Sum {
        value,
        bound: beyond + skipped + curvature + later + rounding,
    }
}

/// V_3, V_4 and V_5 at θ, |θ| ≤ π, of which e^iθ is given as well, up to R″.
fn lerch(theta: f64, turn: Complex, w: f64) -> [Complex; 3] {
    let (r, slope) = rest_of_pole(theta, turn);
    let h = integrals(theta * w);
    let u = 1.0 / w;
    let mut power = u * u;
    [0, 1, 2].map(|i| {
        let s = (i + 3) as f64;
        let v = [
            power * (h[i][0] + u * (0.5 + slope * s * u)),
            power * (h[i][1] + u * r),
        ];
        power *= u;
        v
    })
}

/// R at −iθ is ½ + i(½ cot(θ/2) − 1/θ); this is the bracket, and R′ = 1/4sin²(θ/2) − 1/θ².
fn rest_of_pole(theta: f64, turn: Complex) -> (f64, f64) {
    let square = theta * theta;
    if theta.abs() < NEAR_POLE {
        let r = -theta
            * (1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30240.0 + square / 1209600.0)));
        let slope =
            1.0 / 12.0 + square * (1.0 / 240.0 + square * (1.0 / 6048.0 + square / 172800.0));
        return (r, slope);
    }
    let gap = 1.0 / (1.0 - turn[0]);
    let inverse = 1.0 / theta;
    (0.5 * turn[1] * gap - inverse, 0.5 * gap - inverse * inverse)
}

/// Σ (−1)^j X for an edge on which m does not double. It is at most `trivial`, and as much as
/// `tolerance` of it may be neglected.
fn level(
    all: &LineCrossings,
    series: &Series,
    trivial: f64,
    tolerance: f64,
    budget: &Budget,
) -> Sum {
    let lines = all.count.hi;
    let size = |k: usize| lines * series.size(k, all.depth);
    let middle = all.depth + 0.5 * lines * all.rise;
    let is_steady = all.rise * lines * STEADY < middle;
    let start = if is_steady { middle } else { all.depth };
    let u = 1.0 / start;
    // The amplitudes of the mode n = 1.
    let mut amplitudes = [0.0; MODE_TERMS];
    let mut amplitude = 4.0 / (PI * PI * PI) * u * u * u;
    for k in 1..=MODE_TERMS.min(series.terms) {
        amplitudes[k - 1] = amplitude * series.factors[k];
        amplitude *= u / PI;
    }
    let neglected = (NEGLECTED * budget.tolerance).max(LATER * tolerance);
    // Σ n^−3 over the odd n beyond Q is at most 1/4Q²; of the trivial bound a mode is at most 8/π²
    // n^−3.
    let last = ((trivial / neglected).sqrt().ceil() + 1.0).clamp(3.0, MOST);
    let beyond = trivial / (4.0 * (last - 1.0) * (last - 1.0));
    if beyond.is_nan() || beyond >= trivial || !budget.spend(last * MODE_WORK) {
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
    // By Abel Σ_j of a mode is at most 2/|1 − e^iθ| by its first term, and that π/|θ|. All modes
    // that are left out for it together are not much more than is neglected anyhow: Σ n^−2 over
    // the odd n is π²/8.
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
                [geometric(theta, lines, places); MODE_TERMS]
            } else {
                partial(theta, start / all.rise, lines, places)
            };
            // i^−2, i^−3 and i^−4 are −1, i and 1.
            let [first, second, third] = sums;
            let terms = -amplitudes[0] * first[1]
                + per_mode * (amplitudes[1] * second[0] + per_mode * amplitudes[2] * third[1]);
            value += cube * terms;
        }
        places = [0, 1].map(|end| times(places[end], steps[end]));
        n += 2.0;
    }
    let later: f64 = (MODE_TERMS + 1..=series.terms).map(size).sum();
    // m^−s is off by s·gN/2m from its value in the middle.
    let unsteady = if is_steady { 4.0 / STEADY } else { 0.0 };
    // To reach the mode n the place of an end is turned n/2 times, by products of four roundings:
    // 4n for two ends, and as many for the steps that they are turned by. A mode has some 30
    // operations of its own, at either end. The series of Lerch are good to some 500 units in
    // the last place of w/2 times their first term, and lack up to 0.04·s(s + 1)/w²; there are two.
    let lerch = if is_steady {
        0.0
    } else {
        let w = start / all.rise;
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
fn partial(theta: f64, w: f64, lines: f64, [place, last]: [Complex; 2]) -> [Complex; MODE_TERMS] {
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
                // Of what lerch neglects, 0.04·s(s + 1)/w², 5e-8 is left; 500 roundings of w/2 are
                // 3e-10.
                close(found, one_by_one(theta, 5000.0, 3000.0, s), 1e-7);
            }
        }
    }
}
