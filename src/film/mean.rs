//! The mean of a pixel's samples, rounded once.

use crate::math::{Double, Real, two_product};

/// Returns the mean of a pixel's samples, Σ count · colour / n, rounded once, where n is the sum of
/// the counts.
///
/// `seen` contains the count of each colour. Its order is always that of the palette, so that the
/// same counts give the same bits. The sum and the quotient are double-doubles with errors of about
/// 2^−100 of the mean. A single colour is returned unchanged.
pub fn mean(seen: impl Iterator<Item = (u64, [f64; 3])>) -> [f64; 3] {
    let mut samples = 0;
    let mut sums = [Double::from_f64(0.0); 3];
    for (count, color) in seen {
        samples += count;
        for (sum, channel) in sums.iter_mut().zip(color) {
            // A count is at most 2^53, so its conversion to `f64` is exact.
            *sum = sum.plus(&two_product(count as f64, channel));
        }
    }
    sums.map(|sum| quotient(&sum, samples as f64))
}

/// Returns sum/count by two steps of long division. The remainder of the first step is exact,
/// except for the rounding when `lo` is added. Therefore, a quotient halfway between two `f64` is
/// exact before it is rounded for the only time.
fn quotient(sum: &Double, count: f64) -> f64 {
    let first = sum.hi / count;
    let product = two_product(first, count);
    let rest = (sum.hi - product.hi) - product.lo + sum.lo;
    first + rest / count
}
