//! The mean colour of a pixel's samples, computed with a single rounding.

use crate::math::{Double, Real, two_product};

/// Returns the mean colour of a pixel's samples, Σ count · colour / n. The iterator `seen` yields
/// each colour with the count of its samples, and n is the sum of the counts.
///
/// Sums and quotients are computed with double-doubles, i.e. sums of two `f64`, with relative
/// errors of about 2^−100. So only the final rounding to `f64` is noticeable. The order of the
/// colours may still change the last bit, so callers pass them in a fixed order. A single colour is
/// returned unchanged.
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

/// Returns `sum`/`count`. The quotient is computed in two steps of long division: first the leading
/// part of `sum` is divided, then the remainder. The last addition rounds the result to `f64`; the
/// other rounding errors, of the remainder and of its quotient, are far smaller.
fn quotient(sum: &Double, count: f64) -> f64 {
    let first = sum.hi / count;
    let product = two_product(first, count);
    let rest = (sum.hi - product.hi) - product.lo + sum.lo;
    first + rest / count
}
