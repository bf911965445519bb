//! Random bits without a generator: a number is a hash of what it is for.
//!
//! A [`Key`] names a purpose (a seed, a method, a pixel, an axis), and `key.bits(i)` is the i-th 64-bit number of that
//! purpose. This is SplitMix64 (Steele, Lea and Flood 2014, "Fast splittable pseudorandom number generators") with its state
//! computed instead of carried: the numbers of a key are the outputs of a generator that starts at the key.

use std::ops::Range;

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
    #[inline(always)]
    pub fn pairs(self, points: Range<u64>, mut each: impl FnMut(u64, &[[u64; 2]])) {
        let mut room = [[0; 2]; BATCH];
        let mut first = points.start;
        while first < points.end {
            let count = (points.end - first).min(BATCH as u64);
            let pairs = &mut room[..count as usize];
            for (index, out) in (2 * first..).zip(pairs.as_flattened_mut()) {
                *out = self.bits(index);
            }
            each(first, pairs);
            first += count;
        }
    }
}

/// The place of random bits, read as a fraction of 1, among `n`: a number from 0 to `n` − 1. Its bias is below n/2^64 (Lemire 2019, without
/// the rejection).
#[inline]
pub fn scale(bits: u64, n: u64) -> u64 {
    ((u128::from(bits) * u128::from(n)) >> 64) as u64
}

/// The same for an `n` of at most 2^53, in steps that loops make vectors of.
///
/// Of the usual steps, by halves of 32 bits, compilers make the one product of 128 bits that vectors do not have.
#[inline(always)]
pub fn scale_by_parts(bits: u64, n: u64) -> u64 {
    const LOW: u64 = u32::MAX as u64;
    let (high, low) = (bits >> 32, bits & LOW);
    let (n_high, n_low) = (n >> 26 & LOW, n & ((1 << 26) - 1));
    // The product is high·n_high 2^58 + high·n_low 2^32 + low·n_high 2^26 + low·n_low, none of the four above 2^59. What is cut off on the way
    // is less than what is added next counts in.
    let rest = low * n_high + ((low * n_low) >> 26);
    let rest = high * n_low + (rest >> 6);
    (high * n_high + (rest >> 26)) >> 6
}

/// The same for a small `n`.
#[inline(always)]
pub fn scale_short(bits: u64, n: u32) -> u64 {
    let n = u64::from(n);
    let (high, low) = (bits >> 32, bits & u64::from(u32::MAX));
    (high * n + ((low * n) >> 32)) >> 32
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
    fn pairs_are_the_numbers_in_turn() {
        let key = Key::new(7, 1);
        for range in [0..0, 3..4, 1..64, 5..300] {
            let mut next = range.start;
            key.pairs(range.clone(), |first, pairs| {
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
    fn parts_make_the_same_product() {
        let key = Key::new(3, 4);
        let edges = [0, 1, u64::from(u32::MAX), 1 << 32, u64::MAX - 1, u64::MAX];
        let numbers: Vec<_> = edges
            .into_iter()
            .chain((0..300).map(|i| key.bits(i)))
            .collect();
        for (i, &bits) in numbers.iter().enumerate() {
            for &n in &numbers[i..] {
                for n in [n >> 11, n >> 38, n >> 40, 1 << 53] {
                    assert_eq!(scale_by_parts(bits, n), scale(bits, n), "{bits} {n}");
                }
                let n = (n >> 32) as u32;
                assert_eq!(scale_short(bits, n), scale(bits, u64::from(n)));
            }
        }
    }

    #[test]
    fn numbers_below_n_are_even() {
        let key = Key::new(1, 2);
        let mut hits = [0_u32; 7];
        for index in 0..70_000 {
            hits[scale(key.bits(index), 7) as usize] += 1;
        }
        // Standard deviation: √(70 000 · 1/7 · 6/7) = 93.
        assert!(hits.iter().all(|&n| n.abs_diff(10_000) < 400), "{hits:?}");
    }
}
