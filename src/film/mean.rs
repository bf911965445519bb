//! The mean of a pixel's samples, rounded once.

use crate::math::{Double, Real, two_product};

/// The mean of a pixel's samples: Σ count · colour / n, n being the sum of the counts, rounded
/// once.
///
/// The colours come in the order of the palette, so that the same counts give the same bits in
/// whichever order they were made. The sum and the quotient are double-doubles: their errors are
/// some 2^−100 of the mean, and a colour alone comes back as it was.
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
    sums.map(|sum| quotient(&sum, samples as f64))
}

/// sum / count by two steps of long division: the rest of the first is exact but for the rounding
/// of what `lo` adds, so a quotient that lies in the middle between two f64 is exact before its
/// only rounding, too.
fn quotient(sum: &Double, count: f64) -> f64 {
    let first = sum.hi / count;
    let product = two_product(first, count);
    let rest = (sum.hi - product.hi) - product.lo + sum.lo;
    first + rest / count
}
