//! Random permutations of 0 … n − 1.

use super::rng::Key;

/// Up to this length a permutation is stored, and uniform among all; a longer one is computed entry
/// by entry.
const STORED: u64 = 1 << 12;

/// Lengths up to this need no allocation.
const SHORT: usize = 64;

/// Room for a short permutation. It stays where it is, since to move entries right after they are
/// written makes processors wait.
pub type Room = [u16; SHORT];

/// Room with nothing in it.
pub const ROOM: Room = [0; SHORT];

/// A permutation of 0 … n − 1 that a key decides.
#[derive(Debug)]
pub enum Shuffle<'a> {
    /// Short: its entries, and more behind them.
    Short(&'a Room),
    /// Of middling length: its entries.
    Stored(Vec<u16>),
    /// Long: how to compute an entry.
    Hashed {
        /// How many entries.
        n: u64,
        /// Decides them.
        key: Key,
    },
}

impl<'a> Shuffle<'a> {
    /// The permutation of 0 … n − 1 that `key` decides.
    #[inline(always)]
    pub fn new(n: u64, key: Key, room: &'a mut Room) -> Self {
        if n <= SHORT as u64 {
            fisher_yates(&mut room[..n as usize], key);
            Self::Short(room)
        } else if n <= STORED {
            let mut entries = vec![0; n as usize];
            fisher_yates(&mut entries, key);
            Self::Stored(entries)
        } else {
            Self::Hashed { n, key }
        }
    }

    /// Its entries, where they are stored, and perhaps more behind them.
    #[inline(always)]
    pub fn stored(&self) -> Option<&[u16]> {
        match self {
            Self::Short(entries) => Some(entries.as_slice()),
            Self::Stored(entries) => Some(entries),
            Self::Hashed { .. } => None,
        }
    }

    /// The entry at `index` < n.
    #[inline(always)]
    pub fn get(&self, index: u64) -> u64 {
        match self {
            Self::Short(entries) => u64::from(entries[index as usize]),
            Self::Stored(entries) => u64::from(entries[index as usize]),
            Self::Hashed { n, key } => permute(index, *n, *key),
        }
    }
}

/// Fills `entries` with a permutation (Durstenfeld 1964, "inside out").
#[inline(always)]
fn fisher_yates(entries: &mut [u16], key: Key) {
    for i in 0..entries.len() {
        // 32 random bits favour no place by more than one in 2^20.
        let j = (((key.bits(i as u64) >> 32) * (i as u64 + 1)) >> 32) as usize;
        entries[i] = entries[j];
        entries[j] = i as u16;
    }
}

/// The entry at `index` of a permutation of 0 … n − 1, computed alone: a keyed bijection of the
/// numbers of as many bits as n − 1 has, applied until the result is below n ("cycle walking",
/// Black and Rogaway 2002, which makes of it a bijection of the numbers below n). At least half of
/// the numbers of so many bits are, so twice is enough on average.
fn permute(index: u64, n: u64, key: Key) -> u64 {
    let bits = u64::BITS - (n - 1).leading_zeros();
    let mask = (1 << bits) - 1;
    let half = bits.div_ceil(2);
    let mut value = index;
    loop {
        for round in 0..4 {
            let random = key.bits(round);
            // Each step is a bijection modulo a power of two: times an odd number, plus a number,
            // upper half onto lower half.
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
            let mut room = ROOM;
            let shuffle = Shuffle::new(4, Key::new(seed, 0), &mut room);
            *hits
                .entry([0, 1, 2, 3].map(|i| shuffle.get(i)))
                .or_insert(0_u32) += 1;
        }
        assert_eq!(hits.len(), 24);
        // Standard deviation: √1000 = 32.
        assert!(hits.values().all(|&n| n.abs_diff(1000) < 150), "{hits:?}");
    }

    #[test]
    fn a_long_permutation_has_no_favourites_and_keeps_no_neighbours() {
        let n = 6007;
        let (mut sum, mut neighbours) = (0.0, 0);
        for seed in 0..2000 {
            let mut room = ROOM;
            let shuffle = Shuffle::new(n, Key::new(seed, 0), &mut room);
            sum += shuffle.get(17) as f64;
            neighbours += u32::from(shuffle.get(17).abs_diff(shuffle.get(18)) == 1);
        }
        // Mean 3003, standard deviation of the mean 6007/√12/√2000 = 39; two entries are neighbours
        // once in 3000.
        assert!((sum / 2000.0 - 3003.0).abs() < 160.0, "{}", sum / 2000.0);
        assert!(neighbours < 8, "{neighbours}");
    }
}
