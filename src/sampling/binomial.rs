//! Binomial random numbers: how many of n tries succeed, when each does with probability p.

use std::f64::consts::TAU;

use super::{hash::Key, lattice};

/// Up to so many tries of probability 1/2 are tried one by one, 64 to a hash.
const COUNTED: u64 = 512;

/// The number of successes among `n` ≤ 2^53 tries, each of which succeeds with the probability `part`/`whole`.
///
/// Few tries of probability 1/2 are random bits, counted. Otherwise, where few successes (or few failures) are expected, inversion
/// by adding up probabilities (BINV of Kachitvichyanukul and Schmeiser 1988), and transformed rejection elsewhere (BTRS of Hörmann
/// 1993, "The generation of binomial random variates"): exact in distribution but for the rounding of f64.
pub fn draw(key: Key, n: u64, part: u64, whole: u64) -> u64 {
    if 2 * part == whole && n <= COUNTED {
        return coin_tosses(key, n);
    }
    if 2 * part > whole {
        return n - draw(key, n, whole - part, whole);
    }
    let p = part as f64 / whole as f64;
    let mut uniforms = (0..).map(|index| lattice::offset_of_bits(key.bits(index)) + 0.5);
    if (n as f64) * p < 10.0 {
        invert(n, p, &mut uniforms)
    } else {
        reject(n, p, &mut uniforms)
    }
}

fn coin_tosses(key: Key, n: u64) -> u64 {
    (0..n.div_ceil(64))
        .map(|index| {
            let tosses = (n - 64 * index).min(64);
            u64::from((key.bits(index) >> (64 - tosses)).count_ones())
        })
        .sum()
}

/// BINV; p ≤ 1/2, and n·p is small.
fn invert(n: u64, p: f64, uniforms: &mut impl Iterator<Item = f64>) -> u64 {
    let odds = p / (1.0 - p);
    let none = libm::exp(n as f64 * libm::log1p(-p));
    for mut uniform in uniforms {
        let (mut successes, mut probability) = (0, none);
        while uniform >= probability {
            uniform -= probability;
            successes += 1;
            probability *= odds * ((n + 1 - successes) as f64 / successes as f64);
            // What is left once the probabilities are used up is their rounding: draw again.
            if probability == 0.0 {
                break;
            }
        }
        if probability > 0.0 {
            return successes;
        }
    }
    unreachable!("the uniform numbers do not end")
}

/// BTRS; p ≤ 1/2, and n·p ≥ 10.
fn reject(n: u64, p: f64, uniforms: &mut impl Iterator<Item = f64>) -> u64 {
    let tries = n as f64;
    let deviation = (tries * p * (1.0 - p)).sqrt();
    let b = 1.15 + 2.53 * deviation;
    let a = -0.0873 + 0.0248 * b + 0.01 * p;
    let center = tries * p + 0.5;
    let sure = 0.92 - 4.2 / b;
    let alpha = (2.83 + 5.1 / b) * deviation;
    let mode = ((tries + 1.0) * p).floor();
    let ln_of_mode = ln_probability(mode, tries, p);
    loop {
        let (Some(u), Some(v)) = (uniforms.next(), uniforms.next()) else {
            unreachable!("the uniform numbers do not end")
        };
        let u = u - 0.5;
        let us = 0.5 - u.abs();
        let k = ((2.0 * a / us + b) * u + center).floor();
        if !(0.0..=tries).contains(&k) {
            continue;
        }
        if us >= 0.07 && v <= sure {
            return k as u64;
        }
        let v = v * alpha / (a / (us * us) + b);
        if libm::log(v) <= ln_probability(k, tries, p) - ln_of_mode {
            return k as u64;
        }
    }
}

/// The logarithm of the probability of k successes, by Loader's saddle-point expansion (2000, "Fast and accurate computation of
/// binomial probabilities"): no term is much larger than the result, so that nothing cancels even for n = 2^53.
fn ln_probability(k: f64, n: f64, p: f64) -> f64 {
    if k == 0.0 {
        return n * libm::log1p(-p);
    }
    if k == n {
        return n * libm::log(p);
    }
    let rest = n - k;
    stirling_error(n)
        - stirling_error(k)
        - stirling_error(rest)
        - deviance(k, n * p)
        - deviance(rest, n * (1.0 - p))
        + 0.5 * libm::log(n / (TAU * k * rest))
}

/// ln n! less Stirling's formula for it.
fn stirling_error(n: f64) -> f64 {
    if n < 16.0 {
        libm::lgamma(n + 1.0) - (n + 0.5) * libm::log(n) + n - 0.5 * libm::log(TAU)
    } else {
        let square = n * n;
        (1.0 / 12.0 - (1.0 / 360.0 - (1.0 / 1260.0 - 1.0 / 1680.0 / square) / square) / square) / n
    }
}

/// k·ln(k/mean) + mean − k, as a series where k is near the mean.
fn deviance(k: f64, mean: f64) -> f64 {
    let ratio = (k - mean) / (k + mean);
    if ratio.abs() >= 0.1 {
        return k * libm::log(k / mean) + mean - k;
    }
    let square = ratio * ratio;
    let mut sum = (k - mean) * ratio;
    let mut power = 2.0 * k * ratio;
    for odd in (3..).step_by(2) {
        power *= square;
        let next = sum + power / f64::from(odd);
        if next == sum {
            break;
        }
        sum = next;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean and the variance of many draws, in standard errors from what they should be.
    fn check(n: u64, part: u64, whole: u64) {
        const DRAWS: u64 = 20_000;
        let p = part as f64 / whole as f64;
        let (mean, variance) = (n as f64 * p, n as f64 * p * (1.0 - p));
        let (mut sum, mut squares, mut cubes) = (0.0, 0.0, 0.0);
        for seed in 0..DRAWS {
            let k = draw(Key::new(seed, n), n, part, whole);
            assert!(k <= n);
            let deviation = (k as f64 - mean) / variance.sqrt();
            sum += deviation;
            squares += deviation * deviation;
            cubes += deviation * deviation * deviation;
        }
        let draws = DRAWS as f64;
        let skewness = (1.0 - 2.0 * p) / variance.sqrt();
        let excess = (1.0 - 6.0 * p * (1.0 - p)) / variance;
        let case = format!("{n} tries, {part}/{whole}");
        assert!((sum / draws.sqrt()).abs() < 4.0, "{case}: mean");
        let spread = (2.0 + excess).max(0.0).sqrt() + 1e-9;
        assert!(
            ((squares - draws) / draws.sqrt() / spread).abs() < 4.0,
            "{case}: variance"
        );
        // Where few successes are expected, the third moment is all in rare draws.
        if variance > 1.0 {
            let error = 15.0_f64.sqrt() / draws.sqrt() * (1.0 + skewness);
            assert!(
                (cubes / draws - skewness).abs() < 6.0 * error,
                "{case}: skewness"
            );
        }
    }

    #[test]
    fn draws_have_the_moments_of_the_distribution() {
        for (part, whole) in [(1, 2), (1, 3), (2, 3), (45, 77), (1, 1000), (1, 1 << 20)] {
            for n in [1, 7, 64, 65, 512, 513, 100_000, 1 << 40, 1 << 53] {
                check(n, part, whole);
            }
        }
    }

    #[test]
    fn draws_have_the_probabilities_of_the_distribution() {
        // χ² over all outcomes of which at least 10 are expected.
        for (n, part, whole) in [
            (6, 1, 3),
            (30, 1, 2),
            (40, 2, 5),
            (60, 1, 3),
            (600, 1, 2),
            (90, 1, 30),
        ] {
            const DRAWS: u64 = 30_000;
            let p = part as f64 / whole as f64;
            let mut hits = vec![0_u64; n as usize + 1];
            for seed in 0..DRAWS {
                hits[draw(Key::new(seed, 3), n, part, whole) as usize] += 1;
            }
            let (mut chi2, mut freedom, mut total) = (0.0, -1.0, 0.0);
            for (k, &hits) in hits.iter().enumerate() {
                let probability = libm::exp(ln_probability(k as f64, n as f64, p));
                total += probability;
                let expected = DRAWS as f64 * probability;
                if expected >= 10.0 {
                    chi2 += (hits as f64 - expected) * (hits as f64 - expected) / expected;
                    freedom += 1.0;
                }
            }
            assert!((total - 1.0).abs() < 1e-12, "{n}: {total}");
            let limit = freedom + 4.0 * (2.0_f64 * freedom).sqrt() + 4.0;
            assert!(chi2 < limit, "{n} tries, {part}/{whole}: {chi2} of {limit}");
        }
    }

    #[test]
    fn nothing_is_drawn_from_nothing() {
        assert_eq!(draw(Key::new(0, 0), 0, 1, 3), 0);
        assert_eq!(draw(Key::new(0, 0), 0, 1, 2), 0);
    }
}
