//! `sobol`: Sobol' points (Sobol' 1967), scrambled in each pixel by Owen's method (Owen 1995,
//! "Randomly permuted (t, m, s)-nets").
//!
//! The first coordinate of point i is i with its bits mirrored at the binary point. For the second
//! coordinate, the bits of i are first multiplied by Pascal's triangle modulo 2. The sequence
//! begins at i = 0, which must not be left out (Owen 2020). Of the first 2^m points, exactly one
//! lies in every aligned rectangle of width 2^−a and height 2^(a−m), for each a from 0 to m. The
//! same holds for every further block of 2^m points.
//!
//! Owen's scrambling flips some bits of each coordinate. A random bit decides whether a bit is
//! flipped; there is one random bit for each combination of all higher bits. These combinations are
//! the nodes of a binary tree. In a pixel with n points, no two points agree in the first m = ⌈log₂
//! n⌉ bits of a coordinate. Below these m levels, every subtree therefore contains at most one
//! point, and the point's further bits are simply independent random bits. The result is the true
//! scrambling, with m decisions per coordinate instead of 53. One 64-bit hash decides six levels of
//! the tree. The scrambling of Laine and Karras by multiplications was not tried: it is known to
//! have weak bits, and it would save no time for the numbers of points that pictures use.

use std::ops::Range;

use super::{lattice, rng::Key};

/// Number of levels of the tree of random bits, in Owen's scrambling, that one hash decides. Six
/// levels have 2^6 − 1 nodes, for which the 64 bits of a hash are just enough.
const LEVELS: u32 = 6;

/// Maximum number of points whose bits before the scrambling are stored. Any two of these points
/// differ in one of their first 12 bits, so that two hashes, of six levels each, scramble a point.
/// For more points, the bits are computed point by point.
const MAX_STORED: u64 = 1 << (2 * LEVELS);

/// The first points of the Sobol' sequence, prepared for scrambling.
#[derive(Clone, Debug)]
pub struct Sobol {
    /// Number of leading bits that distinguish all points: the least m for which there are at most
    /// 2^m points. No two points agree in all m leading bits of a coordinate.
    depth: u32,
    /// The `depth` highest bits of both coordinates of each point, before the scrambling. Empty for
    /// more than 4096 points.
    tops: Vec<[u16; 2]>,
}

impl Sobol {
    /// Prepares the first `n` points of the Sobol' sequence.
    pub fn new(n: u64) -> Self {
        let depth = u64::BITS - (n - 1).leading_zeros();
        let top = |fraction: u64| high_bits(fraction, depth) as u16;
        let stored = if n <= MAX_STORED { n } else { 0 };
        Self {
            depth,
            tops: (0..stored)
                .map(|i| [top(i.reverse_bits()), top(pascal(i).reverse_bits())])
                .collect(),
        }
    }

    /// Places the points whose indices are in `range`, after the scrambling that `key` determines.
    /// Writes their offsets from the pixel's centre to the lists `x` and `y`.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
        let axes = [
            Owen::new(key.part(0), self.depth),
            Owen::new(key.part(1), self.depth),
        ];
        if !self.tops.is_empty() {
            let tops = &self.tops[range.start as usize..range.end as usize];
            // `at_leaves` first clears a list of a fixed length. The length is chosen by the number
            // of points, because a shorter list takes less time.
            return match self.depth {
                0..=6 => at_leaves::<{ 1 << 6 }>(&axes, tops, [x, y]),
                7..=9 => at_leaves::<{ 1 << 9 }>(&axes, tops, [x, y]),
                _ => at_leaves::<{ 1 << 12 }>(&axes, tops, [x, y]),
            };
        }
        for (i, (x, y)) in range.zip(x.iter_mut().zip(y)) {
            *x = lattice::offset_of_bits(axes[0].scramble(i.reverse_bits()));
            *y = lattice::offset_of_bits(axes[1].scramble(pascal(i).reverse_bits()));
        }
    }
}

/// Writes the offsets of points to `x` and `y`. `tops` contains the highest bits of each point's
/// two coordinates. A coordinate has at most `MOST` different values of these bits. The offset for
/// each value is computed once and then looked up.
#[inline(always)]
fn at_leaves<const MOST: usize>(axes: &[Owen; 2], tops: &[[u16; 2]], [x, y]: [&mut [f64]; 2]) {
    let leaves = [axes[0].leaves::<MOST>(), axes[1].leaves::<MOST>()];
    for (top, (x, y)) in tops.iter().zip(x.iter_mut().zip(y)) {
        *x = leaves[0][usize::from(top[0])];
        *y = leaves[1][usize::from(top[1])];
    }
}

/// Multiplies the bits of a number by Pascal's triangle modulo 2: bit j of the result is the sum,
/// over all k, of the binomial coefficient "k choose j" times bit k, modulo 2. The coefficient is
/// odd if all bits of j are also set in k. The positions j and k, from 0 to 63, have six bits, so
/// six steps are enough: one for each of these bits.
fn pascal(mut bits: u64) -> u64 {
    bits ^= (bits >> 1) & 0x5555_5555_5555_5555;
    bits ^= (bits >> 2) & 0x3333_3333_3333_3333;
    bits ^= (bits >> 4) & 0x0f0f_0f0f_0f0f_0f0f;
    bits ^= (bits >> 8) & 0x00ff_00ff_00ff_00ff;
    bits ^= (bits >> 16) & 0x0000_ffff_0000_ffff;
    bits ^ (bits >> 32)
}

/// Owen's scrambling of one coordinate, in one pixel.
struct Owen {
    key: Key,
    depth: u32,
    /// Number of levels of the tree of random bits that the first hash decides, at most six.
    /// Further hashes decide the levels below.
    levels: u32,
    /// Scrambled value of each combination of the first `levels` bits.
    top: [u8; 1 << LEVELS],
}

impl Owen {
    fn new(key: Key, depth: u32) -> Self {
        let levels = depth.min(LEVELS);
        Self {
            key,
            depth,
            levels,
            top: subtree(key.bits(1), levels),
        }
    }

    /// Returns the offset, after scrambling, for each combination of the `depth` highest bits of a
    /// coordinate. `depth` must be at most 12, so that two hashes suffice for each combination.
    #[inline(always)]
    fn leaves<const MOST: usize>(&self) -> [f64; MOST] {
        let mut prefixes = [0; MOST];
        match self.depth - self.levels {
            0 => {
                for (prefix, &top) in prefixes.iter_mut().zip(&self.top) {
                    *prefix = u16::from(top);
                }
            }
            below => {
                let parts = prefixes.chunks_exact_mut(1 << below);
                for ((part, prefixes), &top) in (1 << self.levels..).zip(parts).zip(&self.top) {
                    let bottom = subtree(self.key.bits(part), below);
                    for (prefix, bottom) in prefixes.iter_mut().zip(bottom) {
                        *prefix = u16::from(top) << below | u16::from(bottom);
                    }
                }
            }
        }
        let mut leaves = [0.0; MOST];
        let count = 1 << self.depth;
        let hashes = (count..2 * count).map(|index| self.key.bits(index));
        for ((leaf, &prefix), hash) in leaves.iter_mut().zip(&prefixes).zip(hashes) {
            // The shift is done in two parts, because a single shift by 64 bits, for depth 0, would
            // overflow.
            let bits = u64::from(prefix) << 1 << (u64::BITS - 1 - self.depth) | hash >> self.depth;
            *leaf = lattice::offset_of_bits(bits);
        }
        leaves
    }

    /// Scrambles a coordinate. `fraction` and the result are fractions of the pixel's side, in
    /// units of 2^−64.
    fn scramble(&self, fraction: u64) -> u64 {
        // A node of the tree is identified by a leading 1, followed by the bits on the path from
        // the root to the node.
        let mut above = self.levels;
        let part = high_bits(fraction, above);
        let mut scrambled = u64::from(self.top[part as usize]);
        let mut flips = self.key.bits(1 << above | part);
        while above < self.depth {
            let levels = (self.depth - above).min(LEVELS);
            let below = above + levels;
            let part = high_bits(fraction << above, levels);
            scrambled = scrambled << levels | (part ^ flips_along(flips, part, levels));
            let node = 1 << below | high_bits(fraction, below);
            flips = self.key.bits(node);
            above = below;
        }
        // No other point agrees with this one in the `depth` highest bits, so the last hash gives
        // all remaining bits.
        scrambled << (u64::BITS - self.depth) | flips >> self.depth
    }
}

/// Returns the scrambled value of each combination of `levels` bits. A combination is a path from
/// the root of a binary tree to a leaf. `flips` contains a random bit for each inner node of the
/// tree: bit 1 for the root, bits 2 and 3 for its children, and so on. If it is set, the bit of the
/// path at this node is flipped.
#[inline(always)]
fn subtree(flips: u64, levels: u32) -> [u8; 1 << LEVELS] {
    let mut bits = [0; 1 << LEVELS];
    for level in 0..levels {
        // Replaces each node by its two children. The last node comes first, so that none is
        // overwritten before it is read.
        for node in (0..1 << level).rev() {
            let scrambled = bits[node] << 1;
            let flip = (flips >> (1 << level | node) & 1) as u8;
            (bits[2 * node], bits[2 * node + 1]) = (scrambled | flip, scrambled | (flip ^ 1));
        }
    }
    bits
}

/// Returns the random bits of the nodes on a path down a tree. The `levels` bits of `part` describe
/// the path from the root. `flips` contains a random bit for each node: bit 1 for the root, bits 2
/// and 3 for its children, and so on.
fn flips_along(flips: u64, part: u64, levels: u32) -> u64 {
    (0..levels).fold(0, |found, level| {
        let node = 1 << level | part >> (levels - level);
        found << 1 | (flips >> node & 1)
    })
}

/// Returns the `count` highest bits of a number.
fn high_bits(number: u64, count: u32) -> u64 {
    number.checked_shr(u64::BITS - count).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_placed_together_are_those_placed_one_by_one() {
        let key = Key::new(7, 5).part(3);
        for n in [
            2, 3, 17, 64, 65, 100, 128, 300, 512, 513, 1000, 4095, 4096, 5000,
        ] {
            let sobol = Sobol::new(n);
            assert_eq!(sobol.tops.is_empty(), n > MAX_STORED);
            let axes = [0, 1].map(|axis| Owen::new(key.part(axis), sobol.depth));
            let (mut x, mut y) = (vec![0.0; n as usize], vec![0.0; n as usize]);
            sobol.place(key, 0..n, [&mut x, &mut y]);
            for (i, place) in (0..n).zip(x.into_iter().zip(y)) {
                let [a, b] = [i.reverse_bits(), pascal(i).reverse_bits()];
                let [a, b] = [axes[0].scramble(a), axes[1].scramble(b)];
                let alone = (lattice::offset_of_bits(a), lattice::offset_of_bits(b));
                assert_eq!(place, alone, "{i} of {n}");
            }
        }
    }
}
