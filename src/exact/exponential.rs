//! Exponential integrals of imaginary arguments: F_s(y) = e^z E_s(z) = ∫_0^∞ e^(iyv) (1 + v)^(−s) dv, z = −iy.
//!
//! F_s(−y) is the conjugate of F_s(y), and F_s+1 = (1 − z·F_s)/s (DLMF 8.19.12).

use super::complex::{Complex, over, phase, size, times};
use std::{f64::consts::FRAC_PI_2, sync::LazyLock};

/// Below this power series are good, from here on a continued fraction, and from there on an asymptotic series.
const SMALL: f64 = 3.0;
const LARGE: f64 = 64.0;

/// The continued fraction takes very long, so it is asked for just at numbers so far apart, and Taylor's series about them, of so many terms, gives
/// those in between: the first term that is left out is at most (¼/3)^16 = 5e-18.
const STEP: f64 = 0.5;
const TERMS: usize = 16;
type Expansion = [Complex; TERMS];
static EXPANSIONS: LazyLock<[Vec<Expansion>; 2]> =
    LazyLock::new(|| [expansions::<3>(), expansions::<4>()]);

/// F_3, F_4 and F_5.
pub(super) fn integrals(y: f64) -> [Complex; 3] {
    let third = third(y);
    let fourth = next(y, third, 3.0);
    [third, fourth, next(y, fourth, 4.0)]
}

/// F_3.
pub(super) fn third(y: f64) -> Complex {
    of_order::<3>(y, power_series)
}

/// F_4, without what its recurrence loses where y is large.
fn fourth(y: f64) -> Complex {
    of_order::<4>(y, |y| next(y, power_series(y), 3.0))
}

fn of_order<const ORDER: u32>(y: f64, small: impl Fn(f64) -> Complex) -> Complex {
    let size = y.abs();
    let integral = if size >= LARGE {
        asymptotic::<ORDER>(size)
    } else if size >= SMALL {
        expanded(&EXPANSIONS[ORDER as usize - 3], size)
    } else {
        small(size)
    };
    if y < 0.0 {
        [integral[0], -integral[1]]
    } else {
        integral
    }
}

fn next(y: f64, integral: Complex, order: f64) -> Complex {
    [(1.0 - y * integral[1]) / order, y * integral[0] / order]
}

/// F_3[y, y′] where F_3(y) and F_3(y′) are given, and the size of what it is made of.
pub(super) fn divided_difference(y: [f64; 2], integrals: [Complex; 2]) -> (Complex, f64) {
    /// Nearer neighbours than this, by their size, cancel too much.
    const CLOSE: f64 = 0.05;
    let step = y[1] - y[0];
    let [from, to] = integrals;
    let largest = y[0].abs().max(y[1].abs());
    if step.abs() >= CLOSE * largest {
        if largest >= SMALL {
            let quotient = [(to[0] - from[0]) / step, (to[1] - from[1]) / step];
            return (quotient, (size(from) + size(to)) / step.abs());
        }
        if step == 0.0 {
            return ([0.0, 0.5], 0.5);
        }
        // F_3 = ½(1 + iy − y²·F_1), whose last part is all that there is to cancel, however small y is.
        let [from, to] = y.map(|y| first(y).map(|part| y * y * part));
        let quotient = [(to[0] - from[0]) / step, (to[1] - from[1]) / step];
        let terms = 0.5 + 0.5 * (size(from) + size(to)) / step.abs();
        return ([-0.5 * quotient[0], 0.5 - 0.5 * quotient[1]], terms);
    }
    // The mean of the derivative, by Gauss's rule of four points, whose error is the step by y to the eighth power.
    const PLACES: [(f64, f64); 2] = [
        (0.430_568_155_797_026_3, 0.173_927_422_568_726_93),
        (0.169_990_521_792_428_13, 0.326_072_577_431_273_07),
    ];
    let middle = y[0] + 0.5 * step;
    let (mut sum, mut terms) = ([0.0; 2], 0.0);
    for (place, weight) in PLACES {
        for y in [middle - place * step, middle + place * step] {
            let (slope, of_slope) = derivative(y);
            sum = [sum[0] + weight * slope[0], sum[1] + weight * slope[1]];
            terms += weight * of_slope;
        }
    }
    (sum, terms)
}

/// F_3′, and the size of what it is made of: i·(F_2 − F_3) since v = (1 + v) − 1, or, where that cancels, (2·F_3 − 3·F_4)/y from
/// DLMF 8.19.13 and the recurrence.
fn derivative(y: f64) -> (Complex, f64) {
    if y.abs() < SMALL {
        let first = first(y);
        let second = [1.0 - y * first[1], y * first[0]];
        let third = [0.5 * (1.0 - y * second[1]), 0.5 * y * second[0]];
        return (
            [third[1] - second[1], second[0] - third[0]],
            size(second) + size(third),
        );
    }
    let [third, fourth] = [third(y), fourth(y)];
    (
        [0, 1].map(|i| (2.0 * third[i] - 3.0 * fourth[i]) / y),
        (2.0 * size(third) + 3.0 * size(fourth)) / y.abs(),
    )
}

/// DLMF 8.20.2: (1/z)·Σ (−1)^k (s)_k z^−k, until the terms vanish.
fn asymptotic<const ORDER: u32>(y: f64) -> Complex {
    let u = 1.0 / y;
    // 1/z = i/y, so that with every term the factor is −i(k + s)/y.
    let (mut term, mut sum) = (u, [0.0; 2]);
    for k in 0..40 {
        match k % 4 {
            0 => sum[1] += term,
            1 => sum[0] += term,
            2 => sum[1] -= term,
            _ => sum[0] -= term,
        }
        term *= f64::from(k + ORDER) * u;
        if term < 1e-17 * u {
            break;
        }
    }
    sum
}

/// Between 3 and 64.
fn expanded(expansions: &[Expansion], y: f64) -> Complex {
    let middle = f64::from((y / STEP + 0.5) as u32);
    let step = y - middle * STEP;
    let terms = &expansions[(middle - SMALL / STEP) as usize];
    terms.iter().rev().fold([0.0; 2], |sum, term| {
        [sum[0] * step + term[0], sum[1] * step + term[1]]
    })
}

/// Taylor's series from 3 to 64. That (s − 1)·F_s = 1 + iy·F_s−1 (DLMF 8.19.12) and F_s′ = i·(F_s−1 − F_s) is
/// y·F_s′ = (s − 1 − iy)·F_s − 1, so that (k + 1)·y·c_k+1 = (s − 1 − k − iy)·c_k − i·c_k−1, and 1 less where k is 0.
fn expansions<const ORDER: u32>() -> Vec<Expansion> {
    let middles = (SMALL / STEP) as u32..=(LARGE / STEP) as u32;
    let about = |middle: u32| {
        let y = f64::from(middle) * STEP;
        let mut terms = [[0.0; 2]; TERMS];
        terms[0] = continued_fraction::<ORDER>(y);
        for k in 1..TERMS {
            let done = (k - 1) as f64;
            let mut term = times([f64::from(ORDER) - 1.0 - done, -y], terms[k - 1]);
            match k.checked_sub(2) {
                Some(before) => {
                    let [re, im] = terms[before];
                    term = [term[0] + im, term[1] - re];
                }
                None => term[0] -= 1.0,
            }
            terms[k] = term.map(|part| part / (y * (done + 1.0)));
        }
        terms
    };
    middles.map(about).collect()
}

/// DLMF 8.19.17 contracted, as Lentz evaluates it: 1/(z+s − 1·s/(z+s+2 − 2·(s+1)/(z+s+4 − …))).
fn continued_fraction<const ORDER: u32>(y: f64) -> Complex {
    const TINY: f64 = 1e-300;
    let mut b = [f64::from(ORDER), -y];
    let mut c = [1.0 / TINY, 0.0];
    let mut d = over([1.0, 0.0], b);
    let mut h = d;
    for i in 1..200 {
        let a = -f64::from(i) * f64::from(i + ORDER - 1);
        b[0] += 2.0;
        d = over([1.0, 0.0], [b[0] + a * d[0], b[1] + a * d[1]]);
        c = over([a, 0.0], c);
        c = [c[0] + b[0], c[1] + b[1]];
        let delta = times(c, d);
        h = times(h, delta);
        if (delta[0] - 1.0).abs() + delta[1].abs() < 1e-16 {
            break;
        }
    }
    h
}

/// F_3 near 0, by twice the recurrence.
fn power_series(y: f64) -> Complex {
    let first = first(y);
    // 1 − z·h with −z = iy.
    let second = [1.0 - y * first[1], y * first[0]];
    [0.5 * (1.0 - y * second[1]), 0.5 * y * second[0]]
}

/// F_1 near 0: E_1(z) = −γ − ln z − Σ (−z)^k/(k·k!) (DLMF 6.6.2). At 0, where it has a pole of a logarithm, the 0 that y·F_1 is.
fn first(y: f64) -> Complex {
    const EULER: f64 = 0.577_215_664_901_532_9;
    if y == 0.0 {
        return [0.0; 2];
    }
    let mut first = [-EULER - libm::log(y.abs()), FRAC_PI_2.copysign(y)];
    let mut term = [1.0, 0.0];
    for k in 1..40 {
        let k = f64::from(k);
        // −z/k = iy/k.
        term = [-term[1] * y / k, term[0] * y / k];
        first = [first[0] - term[0] / k, first[1] - term[1] / k];
        if size(term) < 1e-17 {
            break;
        }
    }
    times(first, phase(-y))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: Complex, expected: Complex, relative: f64) {
        let error = (found[0] - expected[0]).abs() + (found[1] - expected[1]).abs();
        let size = expected[0].abs() + expected[1].abs();
        assert!(error <= relative * size, "{found:?}, not {expected:?}");
    }

    #[test]
    fn the_ways_of_computing_them_agree_where_they_meet() {
        close(continued_fraction::<3>(64.0), asymptotic::<3>(64.0), 1e-14);
        close(continued_fraction::<4>(64.0), asymptotic::<4>(64.0), 1e-14);
        close(continued_fraction::<3>(3.0), power_series(3.0), 1e-14);
        close(fourth(2.9999999999), fourth(3.0000000001), 1e-9);
        for y in [3.0, 3.249, 3.251, 4.7, 11.3, 40.24, 63.99] {
            close(third(y), continued_fraction::<3>(y), 1e-14);
            close(fourth(y), continued_fraction::<4>(y), 1e-14);
        }
    }

    #[test]
    fn close_neighbours_have_the_same_differences() {
        for y in [1e-3, 0.4, 2.0, 7.0, 40.0, 63.0, 500.0, 1e9, -0.7, -90.0] {
            // Close enough for the derivative's mean, far enough for the quotient.
            let ends = [y, 1.04 * y];
            let [from, to] = ends.map(third);
            let step = ends[1] - ends[0];
            let quotient = [(to[0] - from[0]) / step, (to[1] - from[1]) / step];
            let found = divided_difference(ends, [from, to]).0;
            // Each cancels: the quotient by the step, the derivative by y.
            close(found, quotient, 1e-12 / y.abs().min(1.0));
        }
    }

    #[test]
    fn differences_near_nothing() {
        // F_3 = ½(1 + iy + y²(ln y + γ − iπ/2) + …).
        for ends in [
            [1e-9, 1e-9],
            [0.0, 1e-12],
            [-1e-10, 2e-10],
            [0.0, 0.0],
            [1e-200, 1.01e-200],
        ] {
            let (found, terms) = divided_difference(ends, ends.map(third));
            close(found, [0.0, 0.5], 1e-7);
            assert!(terms < 4.0, "{ends:?}: {terms}");
        }
        let ends = [0.5, 0.9];
        let [from, to] = ends.map(third);
        let quotient = [(to[0] - from[0]) / 0.4, (to[1] - from[1]) / 0.4];
        close(divided_difference(ends, [from, to]).0, quotient, 1e-14);
        // One that is close, at both sides of where the formulas meet.
        let found = [[2.9, 2.9001], [3.1, 3.1001]].map(|y| divided_difference(y, y.map(third)).0);
        close(found[0], found[1], 0.2);
    }

    #[test]
    fn they_are_the_integrals() {
        // By the midpoint rule in x, v = x/(1 − x), where the integrand is (1 − x)·e^(iyv).
        const STEPS: u32 = 400_000;
        for y in [0.0, 0.01, 0.7, 3.5, 12.0] {
            let mut sum = [0.0; 2];
            for i in 0..STEPS {
                let x = (f64::from(i) + 0.5) / f64::from(STEPS);
                let wave = phase(y * x / (1.0 - x));
                sum = [sum[0] + (1.0 - x) * wave[0], sum[1] + (1.0 - x) * wave[1]];
            }
            // Near x = 1, where waves are too fast for the rule, (1 − x)² is left of them.
            close(third(y), sum.map(|x| x / f64::from(STEPS)), 1e-4);
        }
    }
}
