//! The mean of a pixel's samples, rounded once.

use crate::math::{Double, Real, two_product};

/// The mean of a pixel's samples: Σ count · colour / n, n being the sum of the counts, rounded once.
///
/// The colours come in the order of the palette, so that the same counts give the same bits in whichever order they were made. The sum
/// and the quotient are double-doubles: their errors are some 2^−100 of the mean, and a colour alone comes back as it was.
pub fn mean(seen: impl Iterator<Item = (u64, [f64; 3])>) -> [f64; 3] {
    let mut samples = 0;
    let mut sums = [Double::from_f64(0.0); 3];
    for (count, color) in seen {
        samples += count;
        for (sum, channel) in sums.iter_mut().zip(color) {
            // A count is at most 2^53, so it is an f64.
            *sum = sum.plus(&two_product(count as f64, channel));
        }
    }
    let count = samples as f64;
    sums.map(|sum| quotient(&sum, count))
}

/// sum / count, rounded as the quotient of double-doubles is.
fn quotient(sum: &Double, count: f64) -> f64 {
    let first = sum.hi / count;
    let product = two_product(first, count);
    let rest = (sum.hi - product.hi) - product.lo + sum.lo;
    let second = rest / count;
    // `second` is off by a few roundings of the numbers that it is made of. Where that cannot matter, and it does so nowhere but
    // close to the middle between two f64, there is no need for the long division.
    let off = (first.abs() * f64::EPSILON + sum.lo.abs() / count) * 1e-9;
    let (low, high) = (first + (second - off), first + (second + off));
    if low == high {
        low
    } else {
        sum.over(&Double::from_f64(count)).to_f64()
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};

    use super::*;
    use crate::{color::Color, sampling::CounterRng};

    #[test]
    fn a_colour_alone_is_its_own_mean() {
        for bytes in 0..=255 {
            let color = Color::from_bytes([bytes, 255 - bytes, 1]).to_linear();
            for count in [1, 3, 7, 16, 1_000_003, (1 << 53) - 1, 1 << 53] {
                assert_eq!(mean([(count, color)].into_iter()), color);
            }
        }
    }

    #[test]
    fn the_short_division_is_the_long_one() {
        let mut rng = CounterRng::seed_from_u64(1);
        let mut next = || rng.next_u64() >> 11;
        for round in 0..200_000 {
            let count = (next() >> (next() % 53)).max(1) as f64;
            let hi = next() as f64 / (1_u64 << 53) as f64 * count;
            let lo = (next() as f64 / (1_u64 << 53) as f64 - 0.5) * hi * f64::EPSILON / 2.0;
            let sum = match round % 3 {
                0 => Double::from_f64(hi),
                // What lies in the middle between two f64, or is a whole multiple.
                1 => two_product(hi.next_up(), count).plus(&two_product(hi, count)),
                _ => Double::from_f64(hi).plus(&Double::from_f64(lo)),
            };
            let long = sum.over(&Double::from_f64(count)).to_f64();
            assert_eq!(quotient(&sum, count), long, "{sum:?} / {count}");
        }
        assert_eq!(quotient(&Double::from_f64(0.0), 7.0), 0.0);
    }

    #[test]
    fn a_mean_is_rounded_once() {
        // 3 · 0.1 + 7 · 0.3, of which 0.1 is 0.1000000000000000055511151231257827 and 0.3 is 0.299999999999999988897769753748: 0.24
        // within 6e-18, a quarter of the distance between neighbours there.
        let mean = mean([(3, [0.1; 3]), (7, [0.3; 3])].into_iter());
        assert_eq!(mean, [0.24; 3]);
        // 1 of 2^53 samples is half a unit in the last place of the others: exact, where a running sum would lose it.
        let mean = super::mean([((1 << 53) - 1, [1.0; 3]), (1, [0.0; 3])].into_iter());
        assert_eq!(mean, [1.0 - f64::EPSILON / 2.0; 3]);
    }
}
