//! `halton`: the points (φ₂(i), φ₃(i)) of Halton (1960), randomly shifted in each pixel (Cranley
//! and Patterson 1976).
//!
//! φ_b(i), the radical inverse, mirrors the digits of i in base b at the radix point. The sequence
//! begins at i = 0. A shifted point that leaves the pixel enters it again on the other side.
//! Coordinates are 64-bit fractions. Exactly one of the first b^m points lies in each interval from
//! k/b^m to (k + 1)/b^m, possibly on its lower end. Coordinates are therefore rounded up, because
//! rounding down could move a coordinate out of its interval.

use std::ops::Range;

use super::{lattice, rng::Key};

/// Maximum number of points whose radical inverses (mirrored digits) are stored. For pixels with
/// more points, the inverses are computed point by point, which takes longer. The stored numbers
/// take 1 MiB; a larger maximum would need more memory.
const MAX_STORED: u64 = 1 << 16;

/// The Halton sequence, with stored radical inverses (mirrored digits) in base 2 and in base 3.
#[derive(Debug)]
pub struct Halton {
    inverses: [Vec<u64>; 2],
}

impl Halton {
    /// Prepares the first `n` points of the Halton sequence.
    pub fn new(n: u64) -> Self {
        Self {
            inverses: [u64::reverse_bits, radical_inverse_3]
                .map(|inverse: fn(u64) -> u64| (0..n.min(MAX_STORED)).map(inverse).collect()),
        }
    }

    /// Places the points whose indices are in `range`, after a random shift that `key` determines.
    /// Writes their offsets from the pixel's centre to the two lists of coordinates in `out`.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, out: [&mut [f64]; 2]) {
        let inverses: [fn(u64) -> u64; 2] = [u64::reverse_bits, radical_inverse_3];
        for (axis, (out, inverse)) in out.into_iter().zip(inverses).enumerate() {
            let shift = key.bits(axis as u64);
            let place = |inverse: u64| lattice::offset_of_bits(inverse.wrapping_add(shift));
            // Indices up to `MAX_STORED` fit into any `usize`.
            if range.end <= self.inverses[axis].len() as u64 {
                let stored = &self.inverses[axis][range.start as usize..range.end as usize];
                for (out, &inverse) in out.iter_mut().zip(stored) {
                    *out = place(inverse);
                }
            } else {
                for (out, i) in out.iter_mut().zip(range.clone()) {
                    *out = place(inverse(i));
                }
            }
        }
    }
}

/// Returns the number i mirrored in base 3: its digits in reverse order after the radix point
/// (φ₃(i), the radical inverse). The result is in units of 2^−64 and rounded up. Requires i < 3^40.
pub fn radical_inverse_3(i: u64) -> u64 {
    // The mirrored digits are collected as a whole number, which is divided once at the end.
    let (mut rest, mut mirrored, mut power) = (i, 0_u64, 1_u64);
    while rest > 0 {
        mirrored = 3 * mirrored + rest % 3;
        power *= 3;
        rest /= 3;
    }
    // The result fits into 64 bits, because the greatest value, 1 − 3^−40, is less than 1 − 2^−64.
    (u128::from(mirrored) << 64).div_ceil(u128::from(power)) as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverses_lie_one_in_each_elementary_interval() {
        for digits in 0..8 {
            let n = 3_u64.pow(digits);
            for first in [0, n, 5 * n, (1 << 53) / n * n] {
                let mut seen = vec![false; n as usize];
                for i in first..first + n {
                    let interval = (u128::from(radical_inverse_3(i)) * u128::from(n)) >> 64;
                    assert!(!std::mem::replace(&mut seen[interval as usize], true));
                }
            }
        }
    }
}
