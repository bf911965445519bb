//! Random bits without a generator: a number is a hash of what it is for.
//!
//! A [`Key`] names a purpose (a seed, a method, a pixel, an axis), and `key.bits(i)` is the i-th 64-bit number of that
//! purpose. This is SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators") with its state
//! computed instead of carried: the numbers of a key are the outputs of a generator that starts at the key.

use std::ops::Range;

use multiversion::multiversion;

use crate::math::Vectors;

/// The odd number nearest to 2^64 divided by the golden ratio: the step of SplitMix64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// So many pairs are made at a time.
const BATCH: usize = 64;

/// What a number is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key(u64);

impl Key {
    /// The key of a seed and a method's own number.
    pub fn new(seed: u64, method: u64) -> Self {
        Self(mix(mix(seed.wrapping_add(GOLDEN)) ^ method))
    }

    /// The key of one part of this purpose, such as a pixel or an axis. Distinct parts have distinct keys.
    pub fn part(self, part: u64) -> Self {
        Self(mix(self.0 ^ mix(part.wrapping_add(GOLDEN))))
    }

    /// The 64 random bits with this index.
    #[inline(always)]
    pub fn bits(self, index: u64) -> u64 {
        mix(self
            .0
            .wrapping_add(index.wrapping_add(1).wrapping_mul(GOLDEN)))
    }

    /// Tells `each` two numbers for each of some points, with the indices 2i and 2i + 1: some at a time, and the index of the first of them.
    #[inline]
    pub fn pairs(
        self,
        points: Range<u64>,
        vectors: Vectors,
        mut each: impl FnMut(u64, &[[u64; 2]]),
    ) {
        let mut room = [[0; 2]; BATCH];
        let mut first = points.start;
        while first < points.end {
            let count = (points.end - first).min(BATCH as u64);
            let pairs = &mut room[..count as usize];
            self.fill(2 * first, vectors, pairs.as_flattened_mut());
            each(first, pairs);
            first += count;
        }
    }

    /// Fills `out` with the numbers whose indices are `first` and those behind it.
    pub fn fill(self, first: u64, vectors: Vectors, out: &mut [u64]) {
        match vectors {
            Vectors::Widest => fill_widely(self, first, out),
            Vectors::Baseline => fill(self, first, out),
        }
    }

    /// A number from 0 to `n` − 1. Its bias is below n/2^64 (Lemire 2019, without the rejection).
    pub fn below(self, index: u64, n: u64) -> u64 {
        scale(self.bits(index), n)
    }
}

#[multiversion(targets = "simd")]
fn fill_widely(key: Key, first: u64, out: &mut [u64]) {
    fill(key, first, out);
}

#[inline(always)]
fn fill(key: Key, first: u64, out: &mut [u64]) {
    for (index, out) in (first..).zip(out) {
        *out = key.bits(index);
    }
}

/// The place of random bits, read as a fraction of 1, among `n`: a number from 0 to `n` − 1.
#[inline]
pub fn scale(bits: u64, n: u64) -> u64 {
    ((u128::from(bits) * u128::from(n)) >> 64) as u64
}

/// The finaliser of SplitMix64 (Stafford's "Mix13"): a bijection of the 64-bit numbers.
#[inline(always)]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_of_every_argument_matters() {
        let base = Key::new(7, 1).part(3).bits(5);
        for bit in 0..53 {
            let flip = 1 << bit;
            for other in [
                Key::new(7 ^ flip, 1).part(3).bits(5),
                Key::new(7, 1).part(3 ^ flip).bits(5),
                Key::new(7, 1).part(3).bits(5 ^ flip),
            ] {
                let changed = (base ^ other).count_ones();
                assert!(
                    (10..=54).contains(&changed),
                    "bit {bit}: {changed} bits changed"
                );
            }
        }
    }

    #[test]
    fn vectors_of_any_width_make_the_same_numbers() {
        let key = Key::new(7, 1);
        for count in [0, 1, 2, 7, 8, 63, 64, 65, 200] {
            for first in [0, 5, u64::MAX / 2, u64::MAX - 300] {
                let expected: Vec<_> = (first..first + count).map(|i| key.bits(i)).collect();
                for vectors in [Vectors::Widest, Vectors::Baseline] {
                    let mut numbers = vec![0; count as usize];
                    key.fill(first, vectors, &mut numbers);
                    assert_eq!(numbers, expected, "{count} from {first} on, {vectors:?}");
                }
            }
        }
        for range in [0..0, 3..4, 1..64, 5..300] {
            let mut next = range.start;
            key.pairs(range.clone(), Vectors::Widest, |first, pairs| {
                assert_eq!(first, next);
                for pair in pairs {
                    assert_eq!(*pair, [key.bits(2 * next), key.bits(2 * next + 1)]);
                    next += 1;
                }
            });
            assert_eq!(next, range.end);
        }
    }

    #[test]
    fn numbers_below_n_are_even() {
        let key = Key::new(1, 2);
        let mut hits = [0_u32; 7];
        for index in 0..70_000 {
            hits[key.below(index, 7) as usize] += 1;
        }
        // Standard deviation: √(70 000 · 1/7 · 6/7) = 93.
        assert!(hits.iter().all(|&n| n.abs_diff(10_000) < 400), "{hits:?}");
    }
}
