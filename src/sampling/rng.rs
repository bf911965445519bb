//! Counter-based random numbers: the i-th number is a function of i and of a key, without a state.
//!
//! A [`Key`] stands for one use of random numbers (a seed, a method, a pixel, an axis), and
//! `key.bits(i)` is the i-th 64-bit number for this use. The generator is SplitMix64 (Steele, Lea
//! and Flood 2014, "Fast splittable pseudorandom number generators"), but its state is computed
//! from i instead of stored. [`CounterRng`] returns the numbers of a key one after the other, as a
//! generator of the crate `rand`.

use std::{convert::Infallible, iter, ops::Range};

use rand::{SeedableRng, TryRng};

/// Step from one state of SplitMix64 to the next: the odd number nearest to 2^64/φ, where φ is the
/// golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Number of pairs of random numbers that [`Key::pairs`] generates at a time. Such a batch takes 1
/// KiB, which fits into the first-level cache of any processor.
const BATCH: usize = 64;

/// Key that selects a sequence of random numbers: a hash of a seed, a method, and further parts
/// such as a pixel or an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key(u64);

impl Key {
    /// Returns the key for a seed and a sampling method, given by its number.
    pub fn new(seed: u64, method: u64) -> Self {
        Self(mix(mix(seed.wrapping_add(GOLDEN)) ^ method))
    }

    /// Derives a key for a part, such as a pixel or an axis. Different parts get different keys.
    pub fn part(self, part: u64) -> Self {
        Self(mix(self.0 ^ mix(part.wrapping_add(GOLDEN))))
    }

    /// Returns the 64-bit random number with the index `index`.
    #[inline(always)]
    pub fn bits(self, index: u64) -> u64 {
        mix(self
            .0
            .wrapping_add(index.wrapping_add(1).wrapping_mul(GOLDEN)))
    }

    /// Returns the random numbers with the indices `first`, `first` + `step` and so on, without
    /// end. This takes less time than calling [`bits`](Self::bits) for each index, because it needs
    /// an addition instead of a multiplication per number. Few processors can multiply vectors of
    /// 64-bit numbers.
    #[inline(always)]
    pub fn series(self, first: u64, step: u64) -> impl Iterator<Item = u64> {
        let mut state = self
            .0
            .wrapping_add(first.wrapping_add(1).wrapping_mul(GOLDEN));
        iter::repeat_with(move || {
            let bits = mix(state);
            state = state.wrapping_add(step.wrapping_mul(GOLDEN));
            bits
        })
    }

    /// Generates two random numbers for each point with an index in `points`, and passes them to
    /// `each` in batches. `each` gets the index of the batch's first point, and a pair of numbers
    /// for each point. The two numbers of point i have the indices 2i and 2i + 1.
    #[inline(always)]
    pub fn pairs(self, points: Range<u64>, mut each: impl FnMut(u64, &[[u64; 2]])) {
        let mut batch = [[0; 2]; BATCH];
        for first in points.clone().step_by(BATCH) {
            let pairs = &mut batch[..(points.end - first).min(BATCH as u64) as usize];
            for (index, out) in (2 * first..).zip(pairs.as_flattened_mut()) {
                *out = self.bits(index);
            }
            each(first, pairs);
        }
    }

    /// Returns a generator that yields `bits(0)`, `bits(1)` and so on.
    pub fn rng(self) -> CounterRng {
        CounterRng { key: self, next: 0 }
    }
}

/// A random number generator. Its state is a key, which selects a sequence of numbers, and the
/// index of the next number.
#[derive(Clone, Debug)]
pub struct CounterRng {
    key: Key,
    next: u64,
}

impl SeedableRng for CounterRng {
    type Seed = [u8; 8];

    fn from_seed(seed: Self::Seed) -> Self {
        Key(u64::from_le_bytes(seed)).rng()
    }

    /// Returns the SplitMix64 generator whose initial state is `seed`.
    fn seed_from_u64(seed: u64) -> Self {
        Key(seed).rng()
    }
}

impl TryRng for CounterRng {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.try_next_u64().map(|bits| (bits >> 32) as u32)
    }

    #[inline(always)]
    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        let bits = self.key.bits(self.next);
        self.next += 1;
        Ok(bits)
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        rand::rand_core::utils::fill_bytes_via_next_word(bytes, || self.try_next_u64())
    }
}

/// Maps 64 random bits to a whole number from 0 to `n` − 1, as ⌊bits · n/2^64⌋. The probabilities
/// of the results differ from 1/n by a relative error below n/2^64 (Lemire 2019, without the
/// rejection).
#[inline(always)]
pub fn scale(bits: u64, n: u64) -> u64 {
    ((u128::from(bits) * u128::from(n)) >> 64) as u64
}

/// Computes the same as [`scale`], for `n` ≤ 2^53, by operations that compilers can vectorize.
///
/// `n` is split at bit 26. If both factors were split into halves of 32 bits, compilers would
/// replace the code by a 128-bit product, and there are no vector instructions for such products.
#[inline(always)]
pub fn scale_by_parts(bits: u64, n: u64) -> u64 {
    const LOW: u64 = u32::MAX as u64;
    let (high, low) = (bits >> 32, bits & LOW);
    let (n_high, n_low) = (n >> 26 & LOW, n & ((1 << 26) - 1));
    // The product `bits`·`n` is high·n_high·2^58 + high·n_low·2^32 + low·n_high·2^26 + low·n_low.
    // None of these four products of parts exceeds 2^59. The sum is divided by 2^64 in several
    // steps, and every step rounds down. This gives the same result as rounding down once, because
    // only whole numbers are added between the steps.
    let rest = low * n_high + ((low * n_low) >> 26);
    let rest = high * n_low + (rest >> 6);
    (high * n_high + (rest >> 26)) >> 6
}

/// Mixes the bits of a number. This is the last step of SplitMix64 (Stafford's "Mix13"). Different
/// numbers give different results.
#[inline(always)]
fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;

    #[test]
    fn a_series_has_the_numbers_at_its_indices() {
        let key = Key::new(5, 3);
        for (first, step) in [(0, 1), (7, 2), (u64::MAX, 3)] {
            let index = |i: u64| first.wrapping_add(step * i);
            let numbers = (0..100).map(|i| key.bits(index(i)));
            assert!(key.series(first, step).take(100).eq(numbers));
        }
    }

    #[test]
    fn the_numbers_are_those_of_splitmix64() {
        // The expected numbers are those of Vigna's splitmix64.c with the seed 1234567.
        let mut rng = CounterRng::seed_from_u64(1_234_567);
        let expected = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ];
        assert_eq!(expected.map(|_| rng.next_u64()), expected);
        let mut bytes = [0; 12];
        CounterRng::from_seed(1_234_567_u64.to_le_bytes()).fill_bytes(&mut bytes);
        assert_eq!(bytes[..8], expected[0].to_le_bytes());
        assert_eq!(bytes[8..], expected[1].to_le_bytes()[..4]);
    }

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
    fn a_product_by_parts_is_the_long_one() {
        let key = Key::new(3, 4);
        let edges = [0, 1, u64::from(u32::MAX), 1 << 32, u64::MAX - 1, u64::MAX];
        let numbers = edges.into_iter().chain((0..300).map(|i| key.bits(i)));
        let numbers: Vec<_> = numbers.collect();
        for (i, &bits) in numbers.iter().enumerate() {
            for &n in &numbers[i..] {
                for n in [n >> 11, n >> 38, n >> 40, 1 << 53] {
                    assert_eq!(scale_by_parts(bits, n), scale(bits, n), "{bits} {n}");
                }
            }
        }
    }
}
