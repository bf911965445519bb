//! Binomial random numbers: the number of successes in n trials, each with a probability p that is
//! a fraction.
//!
//! A trial draws a random number and succeeds if it is below p. The first binary digit in which the
//! random number differs from p decides whether it is below. Each digit decides about half of the
//! trials that are still undecided. Only the number of decided trials has to be drawn. It is
//! distributed as the number of heads if one fair coin is tossed for each undecided trial. For few
//! coins, random bits are counted. For many coins, the number of heads is drawn by transformed
//! rejection (BTRS of Hörmann 1993, "The generation of binomial random variates"), which is exact
//! except for the rounding of `f64`.
//!
//! The binomial distribution of `rand_distr` is not used: it calls the platform's `powf` and `ln`,
//! whose last bits differ between systems.

use rand::{Rng, RngExt};

/// Maximum number of fair coins whose heads are drawn by counting random bits, 64 per random
/// number. The heads of more coins are drawn by transformed rejection. With a much larger maximum,
/// counting would be slow, because its time grows with the number of coins. With a much smaller
/// maximum, transformed rejection would be inaccurate, because it uses Stirling's formula.
const MAX_COUNTED: u64 = 512;

/// Draws the number of successes in `n` trials, each with the success probability `part`/`whole`.
/// Requires `n` ≤ 2^53.
pub fn draw(rng: &mut impl Rng, n: u64, part: u64, whole: u64) -> u64 {
    let (mut open, mut successes) = (n, 0);
    // The binary digits of p = part/whole are used one after the other. `rest`/`whole` is the
    // fraction with the digits that are not yet used.
    let mut rest = part;
    while open > 0 && rest > 0 {
        let ones = heads(rng, open);
        rest *= 2;
        if rest < whole {
            // The digit of p is 0. If the same digit of a trial's random number is 1, the number is
            // above p, and the trial fails.
            open -= ones;
        } else {
            rest -= whole;
            successes += open - ones;
            open = ones;
        }
    }
    successes
}

fn heads(rng: &mut impl Rng, n: u64) -> u64 {
    if n > MAX_COUNTED {
        return reject(rng, n as f64) as u64;
    }
    let groups = (0..n).step_by(64).map(|tossed| (n - tossed).min(64));
    groups
        .map(|tosses| u64::from((rng.next_u64() >> (64 - tosses)).count_ones()))
        .sum()
}

/// Draws the number of heads of `n` fair coins by transformed rejection (the method BTRS of Hörmann
/// 1993). `n` must be more than about [`MAX_COUNTED`], because Stirling's formula is used.
fn reject(rng: &mut impl Rng, n: f64) -> f64 {
    let deviation = n.sqrt() / 2.0;
    let b = 1.15 + 2.53 * deviation;
    let a = -0.0823 + 0.0248 * b;
    let sure = 0.92 - 4.2 / b;
    let alpha = (2.83 + 5.1 / b) * deviation;
    let mode = (n / 2.0).floor();
    loop {
        let (u, v) = (rng.random::<f64>() - 0.5, rng.random::<f64>());
        let us = 0.5 - u.abs();
        let k = ((2.0 * a / us + b) * u + n / 2.0 + 0.5).floor();
        // Results farther than n/4 from n/2 are rejected. They would occur less than once in 10^27
        // draws (Hoeffding 1963).
        if (k - n / 2.0).abs() > n / 4.0 {
            continue;
        }
        if us >= 0.07 && v <= sure {
            return k;
        }
        let v = v * alpha / (a / (us * us) + b);
        if libm::log(v) <= ln_weight(k, n) - ln_weight(mode, n) {
            return k;
        }
    }
}

/// Returns the logarithm of the probability of `k` heads in `n` tosses, up to a constant, for `k`
/// within n/4 of n/2. It uses Stirling's formula for the factorials, with a term for the error of
/// the formula (Loader 2000, "Fast and accurate computation of binomial probabilities"). No term is
/// much larger than the result, so no digits are lost by cancellation even for n = 2^53.
fn ln_weight(k: f64, n: f64) -> f64 {
    let stirling_error = |n: f64| (1.0 / 12.0 - 1.0 / 360.0 / (n * n)) / n;
    let ratio = (2.0 * k - n) / n;
    let square = ratio * ratio;
    // Sums the power series of (1 + r) ln(1 + r) + (1 − r) ln(1 − r), where r is `ratio`, with |r|
    // ≤ 1/2.
    let (mut sum, mut power) = (0.0, square);
    for double in (2..).step_by(2) {
        let next = sum + 2.0 * power / f64::from(double * (double - 1));
        if next == sum {
            break;
        }
        (sum, power) = (next, power * square);
    }
    -n / 2.0 * sum - libm::log1p(-square) / 2.0 - stirling_error(k) - stirling_error(n - k)
}

#[cfg(test)]
mod tests {
    use super::{super::rng::Key, *};

    /// Checks 20,000 draws of the number of successes in `n` trials, each with the probability
    /// `part`/`whole`: their mean and variance must be within 4 standard errors of the exact
    /// values.
    fn check(n: u64, part: u64, whole: u64) {
        const DRAWS: u64 = 20_000;
        let p = part as f64 / whole as f64;
        let (mean, variance) = (n as f64 * p, n as f64 * p * (1.0 - p));
        let (mut sum, mut squares) = (0.0, 0.0);
        for seed in 0..DRAWS {
            let k = draw(&mut Key::new(seed, n).rng(), n, part, whole);
            assert!(k <= n);
            let deviation = (k as f64 - mean) / variance.sqrt();
            sum += deviation;
            squares += deviation * deviation;
        }
        let draws = DRAWS as f64;
        let excess = (1.0 - 6.0 * p * (1.0 - p)) / variance;
        let case = format!("{n} tries, {part}/{whole}");
        assert!((sum / draws.sqrt()).abs() < 4.0, "{case}: mean");
        let spread = (2.0 + excess).max(0.0).sqrt() + 1e-9;
        let off = (squares - draws) / draws.sqrt() / spread;
        assert!(off.abs() < 4.0, "{case}: variance");
    }

    #[test]
    fn draws_have_the_moments_of_the_distribution() {
        for (part, whole) in [(1, 2), (1, 3), (2, 3), (45, 77), (1, 1000), (1, 1 << 20)] {
            for n in [1, 7, 64, 65, 512, 513, 100_000, 1 << 40, 1 << 53] {
                check(n, part, whole);
            }
        }
    }

    /// Checks that the weights of k + 1 heads and of k heads have the same ratio as their
    /// probabilities, (n − k)/(k + 1).
    #[test]
    fn weights_have_the_ratios_of_binomial_coefficients() {
        for n in [513.0, 600.0, 4097.0, 1e6, 1e9] {
            for share in [0.25, 0.3, 0.4, 0.49, 0.5, 0.51, 0.6, 0.74] {
                let k = f64::ceil(share * n);
                let step = ln_weight(k + 1.0, n) - ln_weight(k, n);
                let expected = libm::log((n - k) / (k + 1.0));
                // `limit` bounds the error of `step`. Its first term covers rounding errors: a
                // value of `ln_weight` is at most n·ln 2/2 and is computed with a few roundings.
                // Its second term covers the first term of Stirling's series that `ln_weight`
                // omits, 1/(1260·k⁵), which changes by less than 1e-13 from k to k + 1.
                let limit = 4.0 * f64::EPSILON * n + 1e-13;
                assert!(
                    (step - expected).abs() < limit,
                    "{n} tosses, {k}: {step}, not {expected}"
                );
            }
        }
    }

    #[test]
    fn draws_have_the_probabilities_of_the_distribution() {
        // A χ² test compares the counts of all outcomes that are expected at least 10 times.
        for (n, part, whole) in [
            (6_u64, 1_u32, 3_u32),
            (30, 1, 2),
            (40, 2, 5),
            (600, 1, 2),
            (90, 1, 30),
        ] {
            const DRAWS: u64 = 30_000;
            let p = f64::from(part) / f64::from(whole);
            let mut hits = vec![0_u64; n as usize + 1];
            for seed in 0..DRAWS {
                let rng = &mut Key::new(seed, 3).rng();
                hits[draw(rng, n, part.into(), whole.into()) as usize] += 1;
            }
            let mut probability = (0..n).fold(1.0, |product, _| product * (1.0 - p));
            let (mut chi2, mut freedom) = (0.0, -1.0);
            for (k, &hits) in (0..).zip(&hits) {
                let expected = DRAWS as f64 * probability;
                if expected >= 10.0 {
                    chi2 += (hits as f64 - expected) * (hits as f64 - expected) / expected;
                    freedom += 1.0;
                }
                probability *= p / (1.0 - p) * (n - k) as f64 / (k + 1) as f64;
            }
            let limit = freedom + 4.0 * (2.0_f64 * freedom).sqrt() + 4.0;
            assert!(chi2 < limit, "{n} tries, {part}/{whole}: {chi2} of {limit}");
        }
    }
}
