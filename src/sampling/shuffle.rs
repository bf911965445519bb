//! Random permutations of 0 … n − 1.

use super::rng::Key;

/// Maximum length of a permutation whose entries are stored, in 8 KiB. Such a permutation is chosen
/// among all permutations with equal probability. The entries of a longer permutation are computed
/// one by one by a hash, which makes some permutations more probable than others. A larger maximum
/// would need more memory. With a smaller maximum, the hash would be used more often.
const MAX_STORED: u64 = 1 << 12;

/// Maximum length of a permutation that is stored in a [`Buffer`] instead of allocated memory. With
/// a smaller maximum, memory would be allocated more often. A larger buffer would take longer to
/// clear for every pixel.
const SHORT: usize = 64;

/// Memory for the entries of a short permutation. A [`Shuffle`] borrows it instead of owning it,
/// because moving entries right after they are written stalls processors.
pub type Buffer = [u16; SHORT];

/// Buffer without entries, all zeros.
pub const EMPTY_BUFFER: Buffer = [0; SHORT];

/// A permutation of 0 … n − 1 that a key determines.
#[derive(Debug)]
pub enum Shuffle<'a> {
    /// The entries of a permutation with n ≤ 64, followed by unused entries.
    Short(&'a Buffer),
    /// The entries of a permutation with 64 < n ≤ 4096.
    Stored(Vec<u16>),
    /// A permutation with n > 4096, whose entries are computed one by one.
    Hashed {
        /// Number of entries.
        n: u64,
        /// Key that determines the entries.
        key: Key,
    },
}

impl<'a> Shuffle<'a> {
    /// Returns the permutation of 0 … n − 1 that `key` determines. If n ≤ 64, its entries are
    /// stored in `buffer`.
    #[inline(always)]
    pub fn new(n: u64, key: Key, buffer: &'a mut Buffer) -> Self {
        if n <= SHORT as u64 {
            fisher_yates(&mut buffer[..n as usize], key);
            Self::Short(buffer)
        } else if n <= MAX_STORED {
            let mut entries = vec![0; n as usize];
            fisher_yates(&mut entries, key);
            Self::Stored(entries)
        } else {
            Self::Hashed { n, key }
        }
    }

    /// Returns the stored entries. If n ≤ 64, the list is padded to 64 entries, and only its first
    /// n entries are valid. Returns `None` if entries are not stored but computed one by one.
    #[inline(always)]
    pub fn stored(&self) -> Option<&[u16]> {
        match self {
            Self::Short(entries) => Some(entries.as_slice()),
            Self::Stored(entries) => Some(entries),
            Self::Hashed { .. } => None,
        }
    }

    /// Returns the entry at `index`, which must be less than n.
    #[inline(always)]
    pub fn get(&self, index: u64) -> u64 {
        match self {
            Self::Short(entries) => u64::from(entries[index as usize]),
            Self::Stored(entries) => u64::from(entries[index as usize]),
            Self::Hashed { n, key } => permute(index, *n, *key),
        }
    }
}

/// Fills `entries` with a random permutation of 0 … n − 1, where n is the number of entries, by the
/// "inside out" shuffle of Fisher and Yates (Durstenfeld 1964).
#[inline(always)]
fn fisher_yates(entries: &mut [u16], key: Key) {
    for i in 0..entries.len() {
        // 32 random bits suffice: the probability of each j has a relative error of at most
        // 2^12/2^32 = 2^−20.
        let j = (((key.bits(i as u64) >> 32) * (i as u64 + 1)) >> 32) as usize;
        entries[i] = entries[j];
        entries[j] = i as u16;
    }
}

/// Computes a single entry of a permutation of 0 … n − 1. A function that depends on the key
/// permutes all numbers with as many bits as n − 1. It is applied again until the result is below n
/// ("cycle walking", Black and Rogaway 2002). This gives a permutation of the numbers below n. At
/// least half of all permuted numbers are below n, so the mean number of steps is at most two.
fn permute(index: u64, n: u64, key: Key) -> u64 {
    let bits = u64::BITS - (n - 1).leading_zeros();
    let mask = (1 << bits) - 1;
    let half = bits.div_ceil(2);
    let mut value = index;
    loop {
        for round in 0..4 {
            let random = key.bits(round);
            // Each operation is invertible modulo a power of two: a multiplication by an odd
            // number, an addition, and an exclusive or of the upper half onto the lower half.
            value = value.wrapping_mul(random | 1).wrapping_add(random >> 32) & mask;
            value ^= value >> half;
        }
        if value < n {
            return value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_permutations_are_equally_likely() {
        let mut hits = std::collections::HashMap::new();
        for seed in 0..24_000 {
            let mut buffer = EMPTY_BUFFER;
            let shuffle = Shuffle::new(4, Key::new(seed, 0), &mut buffer);
            *hits
                .entry([0, 1, 2, 3].map(|i| shuffle.get(i)))
                .or_insert(0_u32) += 1;
        }
        assert_eq!(hits.len(), 24);
        // Each permutation is expected 24,000/24 = 1000 times, with a standard deviation of √1000 =
        // 32, so a difference of 150 is very unlikely.
        assert!(hits.values().all(|&n| n.abs_diff(1000) < 150), "{hits:?}");
    }

    #[test]
    fn a_long_permutation_has_no_favourites_and_keeps_no_neighbours() {
        let n = 6007;
        let (mut sum, mut neighbours) = (0.0, 0);
        for seed in 0..2000 {
            let mut buffer = EMPTY_BUFFER;
            let shuffle = Shuffle::new(n, Key::new(seed, 0), &mut buffer);
            sum += shuffle.get(17) as f64;
            neighbours += u32::from(shuffle.get(17).abs_diff(shuffle.get(18)) == 1);
        }
        // The mean of the 2000 entries is expected to be 3003, with a standard deviation of
        // 6007/√12/√2000 = 39, so a difference of 160 is very unlikely. Two successive entries are
        // neighbouring numbers once in 3000 cases, so 8 such pairs in 2000 cases are very unlikely.
        assert!((sum / 2000.0 - 3003.0).abs() < 160.0, "{}", sum / 2000.0);
        assert!(neighbours < 8, "{neighbours}");
    }
}
