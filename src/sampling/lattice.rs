//! The possible values of a random offset from a pixel's centre, and their division into strata,
//! which are equal intervals.
//!
//! Random offsets are the 2^53 odd multiples of 2^−54 between −1/2 and 1/2. Each of them is an
//! `f64`, and none lies on a pixel's edge or on its centre line. They are symmetric about 0, so
//! their mean is exactly the pixel's centre. An offset is represented by its place, i.e. by its
//! index among all offsets, from 0 to 2^53 − 1.

use super::rng::{scale, scale_by_parts};

/// Number of possible random offsets of a sample from its pixel's centre, along one axis. They are
/// the odd multiples of 2^−54 between −1/2 and 1/2, each of which is an `f64`.
const PLACES: u64 = 1 << 53;

/// Maximum number of strata (equal intervals of a pixel's side) that are stored. If there are more,
/// each is computed when it is used, which takes longer. The stored numbers take 512 KiB; a larger
/// maximum would need more memory.
pub const MAX_STORED: u64 = 1 << 16;

/// Returns the random offset with the index `place`, from 0 to 2^53 − 1.
#[inline(always)]
pub fn offset(place: u64) -> f64 {
    debug_assert!(place < PLACES);
    const ONE: u64 = 1.0f64.to_bits();
    const FIRST: u64 = (0.5 / PLACES as f64).to_bits();
    const SECOND: u64 = (1.5 / PLACES as f64).to_bits();
    // Let `place` be 2i + b, where b is 0 or 1. The offset, (2·`place` + 1)/2^54 − 1/2, is then the
    // sum of i/2^52 − 1/2 and of 2b + 1 units of 2^−54. The first summand is computed as a
    // difference of numbers between 1 and 2. All operations are exact, and every processor has
    // vector instructions for them. A conversion of `place` to `f64` would be slower, because few
    // processors can convert vectors of integers.
    let even = f64::from_bits(ONE | place >> 1) - 1.5;
    let odd = (place & 1).wrapping_neg();
    even + f64::from_bits(FIRST ^ (odd & (FIRST ^ SECOND)))
}

/// Converts 64 random bits to an offset from the pixel's centre. The bits are a fraction of the
/// pixel's side, measured from the left or top edge.
#[inline(always)]
pub fn offset_of_bits(bits: u64) -> f64 {
    offset(bits >> 11)
}

/// The 2^53 possible offsets along a pixel's width or height, divided into n strata (intervals), 1
/// ≤ n ≤ 2^53. The numbers of offsets in two strata differ by at most 1. An offset is represented
/// by its place, i.e. its index among all offsets.
#[derive(Debug)]
pub struct Strata {
    n: u64,
    /// Minimum number of possible offsets in a stratum, ⌊2^53/n⌋; some strata have one more.
    least: u64,
    /// All n strata, and one more at the index n, whose start is the end of the last stratum. Empty
    /// if n exceeds [`MAX_STORED`].
    stored: Vec<Stratum>,
}

/// One of the n strata (intervals) into which the 2^53 possible places along a pixel's side are
/// divided. A stratum has ⌊2^53/n⌋ places or one more. It is stored as one number: twice its first
/// place, plus 1 if it has one place more.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stratum(u64);

impl Stratum {
    /// Returns the first place in the stratum. A place is the index of a possible offset from the
    /// pixel's centre.
    #[inline(always)]
    pub fn start(self) -> u64 {
        self.0 >> 1
    }

    /// Returns the number of places that the stratum has beyond the minimum, ⌊2^53/n⌋: 0 or 1.
    #[inline(always)]
    pub fn more(self) -> u64 {
        self.0 & 1
    }

    /// Returns the stratum's bits as a floating-point number, whose value has no meaning. A list of
    /// offsets can store strata in this form until an offset is chosen in each stratum.
    #[inline(always)]
    pub fn to_f64(self) -> f64 {
        f64::from_bits(self.0)
    }

    /// Returns the stratum whose bits [`Self::to_f64`] returned.
    #[inline(always)]
    pub fn from_f64(bits: f64) -> Self {
        Self(bits.to_bits())
    }

    /// Chooses an offset in the stratum by 64 random bits. `least` is the minimum number of places
    /// in a stratum, ⌊2^53/n⌋.
    #[inline(always)]
    pub fn choose(self, least: u64, bits: u64) -> f64 {
        offset(self.start() + scale_by_parts(bits, least + self.more()))
    }
}

impl Strata {
    /// Divides the 2^53 possible offsets along a pixel's side into `n` strata, 1 ≤ n ≤ 2^53.
    pub fn new(n: u64) -> Self {
        let stored = (0..=n).take_while(|_| n <= MAX_STORED);
        Self {
            n,
            least: PLACES / n,
            stored: stored.map(|i| stratum(i, n)).collect(),
        }
    }

    /// Returns the stratum with the index `i`. Strata are the n equal intervals of a pixel's side.
    #[inline(always)]
    pub fn get(&self, i: u64) -> Stratum {
        match self.stored.get(i as usize) {
            Some(&stored) => stored,
            None => stratum(i, self.n),
        }
    }

    /// Returns all n strata. Returns `None` if they are not stored.
    #[inline(always)]
    pub fn stored(&self) -> Option<&[Stratum]> {
        (!self.stored.is_empty()).then(|| &self.stored[..self.n as usize])
    }

    /// Returns the minimum number of places in a stratum, ⌊2^53/n⌋; some strata have one more.
    pub fn least(&self) -> u64 {
        self.least
    }

    /// Replaces each stratum in a list, stored by [`Stratum::to_f64`], by an offset in this
    /// stratum. The offset is chosen by 64 random bits.
    #[inline(always)]
    pub fn choose_all(&self, strata: &mut [f64], random: impl Iterator<Item = u64>) {
        let chosen = strata.iter_mut().zip(random);
        if self.n.is_power_of_two() {
            // All strata have 2^53/n places, a power of two. The highest bits of the random number
            // are therefore the place within the stratum. They are shifted in two steps, because a
            // single shift by 64 bits, for n = 2^53, would overflow.
            let unused = u64::BITS - 1 - self.least.ilog2();
            for (out, bits) in chosen {
                *out = offset(Stratum::from_f64(*out).start() + (bits >> 1 >> unused));
            }
        } else {
            for (out, bits) in chosen {
                *out = Stratum::from_f64(*out).choose(self.least, bits);
            }
        }
    }

    /// Chooses an offset in the stratum with the index `i` by 64 random bits. Strata are the n
    /// equal intervals of a pixel's side.
    #[inline(always)]
    pub fn choose(&self, i: u64, bits: u64) -> f64 {
        let stratum = self.get(i);
        offset(stratum.start() + scale(bits, self.least + stratum.more()))
    }
}

/// Computes the stratum with the index `i` if a pixel's side has `n` strata. The index `n` gives a
/// stratum that starts at the end of the last one.
fn stratum(i: u64, n: u64) -> Stratum {
    let more = start(i + 1, n) - start(i, n) - PLACES / n;
    Stratum(2 * start(i, n) + more)
}

/// Returns the first place in the stratum with the index `i` if a pixel's side has `n` strata. It
/// is the least k ≥ 0 with (2k + 1)/2^54 ≥ i/n.
fn start(i: u64, n: u64) -> u64 {
    let (i, n) = (u128::from(i), u128::from(n));
    (i << 54).saturating_sub(n).div_ceil(2 * n) as u64
}

#[cfg(test)]
mod tests {
    use super::{super::rng::Key, *};

    #[test]
    fn offsets_are_symmetric_and_inside() {
        assert_eq!(offset(0), -0.5 + 0.5 / PLACES as f64);
        assert_eq!(offset(PLACES - 1), -offset(0));
        assert_eq!(offset(PLACES / 2), -offset(PLACES / 2 - 1));
        assert_eq!(offset_of_bits(u64::MAX), offset(PLACES - 1));
        for i in 0..100_000_u64 {
            let place = Key::new(i, 0).bits(0) >> 11;
            let expected = (2 * place as i64 + 1 - PLACES as i64) as f64 * (0.5 / PLACES as f64);
            assert_eq!(offset(place), expected, "{place}");
        }
    }

    #[test]
    fn strata_hold_the_places_between_their_bounds() {
        for n in (1..200).chain([65_535, 65_536, 65_537, PLACES - 1, PLACES]) {
            let strata = Strata::new(n);
            for i in (0..n.min(200)).chain([n / 3, n / 2, n - 1]) {
                let places = strata.get(i).start()..strata.get(i + 1).start();
                assert!(!places.is_empty());
                let more = places.end - places.start - strata.least();
                assert!(more <= 1);
                let stratum = strata.get(i);
                assert_eq!((stratum.start(), stratum.more()), (places.start, more));
                for bits in [0, u64::MAX / 3, u64::MAX] {
                    let place = places.start + scale(bits, places.end - places.start);
                    assert_eq!(strata.choose(i, bits), offset(place));
                }
                // The offset with the index k lies at (2k + 1)/2^54 of the pixel's side. The first
                // and the last offset of the stratum must lie between i/n and (i + 1)/n, and the
                // offsets before and after them must not.
                let stratum = |k: u64| (u128::from(2 * k + 1) * u128::from(n)) >> 54;
                assert_eq!(stratum(places.start), u128::from(i));
                assert_eq!(stratum(places.end - 1), u128::from(i));
                assert_eq!(stratum(places.end), u128::from(i) + 1);
                assert!(i == 0 || stratum(places.start - 1) == u128::from(i) - 1);
            }
        }
    }
}
