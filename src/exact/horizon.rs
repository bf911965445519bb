//! Sums over the lines that an edge crosses on its way to the horizon, which never end.
//!
//! Crossing j lies at t_j = t + τj, m_j = g(w + j), and s changes its sign at every one. With
//! A_k = Im (4/π) Σ_n e^(inπt)/(n (inπ)^k) over the odd n, Σ_j (−1)^j A_k+1(t_j) m_j^(−2−k) is the sum of the modes
//!
//! g^(−2−k) Im (4/π) e^(inπt)/(n (inπ)^(k+1)) V(θ), V_s(θ) = Σ_j e^(iθj) (w + j)^(−s), s = k + 2, θ = nπ(τ + 1) less turns,
//!
//! a Lerch series. (w + j)^(−s) = ∫ x^(s−1) e^(−(w+j)x) dx/Γ(s), so that V = ∫ x^(s−1) e^(−wx)/(1 − e^(iθ−x)) dx/Γ(s); the
//! pole at x = iθ gives w^(1−s)·e^z E_s(z), z = −iθw, an exponential integral (DLMF 8.19), and Taylor's series of the
//! regular rest R(ζ) = 1/(1 − e^(−ζ)) − 1/ζ about ζ = −iθ gives w^(−s)·(R + R′·s/w + …), term by term. It is
//! the Euler–Maclaurin sum at θ = 0 (a direction along the board's diagonal), and Boole's at θ = π.

use super::board::{Sum, UNIT};
use super::complex::{Complex, phase, square, times, turned_times};
use super::edge::{Crossings, Edge, Series};
use super::exponential::integrals;
use super::level;
use super::modes::{GRADUAL, Lines, MOST as MOST_MODES};
use crate::math::{Double, Real};
use std::f64::consts::PI;

/// Modes of a sum that leave so much of a pixel in doubt are not worth their time.
pub(super) const NOTHING_KNOWN: f64 = 1.0;
/// Below so many crossings one by one is as good as by modes.
const SHORT: f64 = 20_000.0;
/// The same where m hardly grows; and so many are summed one by one where modes would need waves of high orders.
const SHORT_LEVEL: f64 = 100_000.0;
/// More take longer than modes at any distance do.
const MOST: f64 = 300_000.0;
/// Where an edge crosses more lines than this, squares are so many that it may neglect the other, in square pixels.
const DENSE: f64 = 512.0;
const CRUMB: f64 = 2e-12;
/// The time that a mode takes, in crossings.
const MODE_COST: f64 = 2.0;
/// The modes that are always computed; a later one may be skipped where it is small.
const FIRST_MODES: f64 = 31.0;

/// Σ (−1)^j X over all crossings, of which as much as `tolerance` may be neglected.
pub(super) fn crossings(all: &Crossings, series: &Series, tolerance: f64) -> Sum {
    let trivial = all.lines
        * (1..=series.terms)
            .map(|k| series.size(k, all.depth))
            .sum::<f64>();
    let is_crumb = all.lines > DENSE && trivial <= CRUMB.min(tolerance);
    if is_crumb || (all.lines > SHORT && trivial <= 0.25 * tolerance) {
        return Sum {
            value: 0.0,
            bound: trivial,
        };
    }
    let is_level = all.edge.rise * all.lines < all.depth;
    if all.lines <= if is_level { SHORT_LEVEL } else { SHORT } {
        return all.one_by_one(series, all.lines);
    }
    if is_level {
        // Where m hardly grows the modes of the ends do not fall off.
        let sum = level::crossings(all, series, trivial, tolerance);
        if sum.bound <= tolerance {
            return sum;
        }
        if all.lines <= MOST {
            return all.one_by_one(series, all.lines);
        }
        let by_modes = by_modes(all, series, tolerance);
        return if by_modes.bound < sum.bound {
            by_modes
        } else {
            sum
        };
    }
    let direct = ((start(all, series, tolerance) - all.depth) / all.edge.rise)
        .ceil()
        .max(0.0);
    if direct + SHORT >= all.lines && all.lines <= MOST {
        return all.one_by_one(series, all.lines);
    }
    if direct > MOST {
        return by_modes(all, series, tolerance);
    }
    let mut sum = all.one_by_one(series, direct);
    let ends = [
        Some(Double::from_f64(direct)),
        all.lines.is_finite().then_some(all.count),
    ];
    let share = tolerance / ends.iter().flatten().count() as f64;
    for (end, lines) in ends.iter().enumerate() {
        let Some(lines) = lines else { continue };
        let rest = rest(all, lines, series, share);
        let odd = lines.floor().1 != (end == 1);
        sum.value += if odd { -rest.value } else { rest.value };
        sum.bound += rest.bound;
    }
    sum
}

/// Σ (−1)^j X over all crossings, where the series in the distance has too many terms that are not small.
fn by_modes(all: &Crossings, series: &Series, tolerance: f64) -> Sum {
    let Edge { rise, rho, .. } = all.edge;
    let direct = (GRADUAL - all.depth / rise).ceil().max(0.0);
    if direct >= all.lines {
        return all.one_by_one(series, all.lines);
    }
    let mut sum = all.one_by_one(series, direct);
    let factor = series.per_slope.value / rho;
    let done = Double::from_f64(direct);
    let first = [
        all.turned_at(&done),
        Double::from_f64(all.depth + direct * rise),
    ];
    let step = [all.edge.stride, Double::from_f64(*rise)];
    let count = match all.lines.is_finite() {
        true => all.count.minus(&done),
        false => all.count,
    };
    let lines = Lines::new(&first, &step, &count, all.edge.slope);
    let modes = lines.sum(tolerance / factor.abs(), MOST_MODES);
    let alternating = |lines: &Double, x: f64| if lines.floor().1 { -x } else { x };
    // There the ends count half.
    let mut rest = factor * modes.value + 0.5 * all.line(series, &done);
    if all.lines.is_finite() {
        rest -= 0.5 * alternating(&count, all.line(series, &all.count));
    }
    sum.value += alternating(&done, rest);
    let ends: f64 = (1..=series.terms)
        .map(|k| series.size(k, all.depth + direct * rise))
        .sum();
    sum.bound += 16.0 * UNIT * ends;
    sum.bound += factor.abs() * (modes.bound + series.per_slope.bound * modes.value.abs());
    sum
}

/// A bound on Σ |X| of everything from a depth on, of term k.
fn absolute(series: &Series, k: usize, depth: f64, rise: f64) -> f64 {
    series.size(k, depth) * (1.0 + depth / (rise * (k + 1) as f64))
}

/// The depth from which to sum by modes.
fn start(all: &Crossings, series: &Series, tolerance: f64) -> f64 {
    let g = all.edge.rise;
    let factor = series.factors[1].abs();
    // The cheapest: (m − m_0)/g crossings and κ/2m modes.
    let kappa = (factor * 4.0 / (PI * PI * PI) / (2.0 * g) / (4.0 * 0.25 * tolerance)).sqrt();
    let cheapest = (0.5 * MODE_COST * kappa * g).sqrt();
    // Where so little is left that it may be neglected, the first term's bound being ½/π of its factor.
    let nothing = (factor * 0.25 / PI / g / (0.125 * tolerance)).sqrt() + g;
    // What is neglected of a mode is w^−5, of the waves A_5 and on m^−5.
    let steep = g * libm::pow(factor / (g * g * g) / (0.02 * tolerance), 0.2);
    let fourth = match series.terms {
        4.. => libm::pow(
            series.factors[4].abs() / (10.0 * PI * PI * PI * PI * g) / (0.05 * tolerance),
            0.2,
        ),
        _ => 0.0,
    };
    cheapest
        .max(16.0 * g)
        .max(steep)
        .max(fourth)
        .min(nothing)
        .max(all.depth)
}

/// Σ (−1)^j X from crossing `direct` on, with j counted from there.
fn rest(all: &Crossings, direct: &Double, series: &Series, tolerance: f64) -> Sum {
    let g = all.edge.rise;
    let depth = all.depth + direct.hi * g;
    let everything: f64 = (1..=series.terms)
        .map(|k| absolute(series, k, depth, g))
        .sum();
    if everything <= 0.25 * tolerance {
        return Sum {
            value: 0.0,
            bound: everything,
        };
    }
    let w = depth / g;
    let f = &series.factors;
    // The amplitudes of the three waves in the mode n = 1, in which w^(−2−k) is still missing.
    let mut amplitudes = [0.0; 3];
    let mut amplitude = 4.0 / (PI * PI * PI) / (g * g * g);
    for k in 1..=3.min(series.terms) {
        amplitudes[k - 1] = f[k] * amplitude;
        amplitude /= PI * g;
    }
    let first = amplitudes[0].abs();
    let u = 1.0 / w;
    let u2 = u * u;
    let u3 = u2 * u;
    // The later waves' share in what is neglected.
    let waves = if first > 0.0 {
        1.0 + (amplitudes[1].abs() * u + amplitudes[2].abs() * u2) / first
    } else {
        1.0
    };
    // |V_3| ≤ w^−3 + w^−2/2, and Σ n^−3 over the odd n > Q is at most 1/4(Q)², for odd Q + 1 … .
    let largest = first * waves * (0.5 * u2 + u3);
    let last = ((largest / tolerance).sqrt().ceil() + 1.0).clamp(3.0, MOST_MODES);
    let beyond = largest / (4.0 * (last - 1.0) * (last - 1.0));
    if beyond.is_nan() || beyond >= NOTHING_KNOWN {
        return Sum {
            value: 0.0,
            bound: everything,
        };
    }
    // By Abel |V_3| ≤ 2w^−3/|1 − e^iθ|: a late mode n is skipped where this is below an allowance that falls as n^−2.
    let allowance = 0.25 * tolerance * 2.0 * (FIRST_MODES - 1.0);
    let skipped = allowance / (2.0 * (FIRST_MODES - 1.0));
    let threshold = 2.0 * first * waves * u3 / allowance;
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
        let gap = match theta.abs() < 0.2 {
            true => 0.99 * theta * theta,
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
    // V's are good to some 500 units in the last place of w^−2; rotation adds n of them, to the n-th mode.
    let rounding = 1000.0 * UNIT * first * waves * u2;
    Sum {
        value,
        bound: beyond + skipped + curvature + later + rounding,
    }
}

/// V_3, V_4 and V_5 at θ, |θ| ≤ π, of which e^iθ is given as well, up to R″.
pub(super) fn lerch(theta: f64, turn: Complex, w: f64) -> [Complex; 3] {
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
pub(super) fn rest_of_pole(theta: f64, turn: Complex) -> (f64, f64) {
    let square = theta * theta;
    if square < 0.04 {
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
