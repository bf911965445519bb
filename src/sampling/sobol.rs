//! `sobol`: Sobol' points (Sobol' 1967), scrambled in each pixel by Owen's method (Owen 1995,
//! "Randomly permuted (t, m, s)-nets").
//!
//! The first coordinate of point i is i with its bits mirrored at the binary point. For the second
//! coordinate, the bits of i are first multiplied by Pascal's triangle modulo 2. The sequence
//! begins at i = 0, which must not be left out (Owen 2020). Of the first 2^m points, exactly one
//! lies in every aligned rectangle of width 2^−a and height 2^(a−m), for each a from 0 to m. The
//! same holds for every further block of 2^m points.
//!
//! Owen's scrambling flips some bits of each coordinate. Whether a bit is flipped depends on a
//! random bit, and there is a separate random bit for each combination of all higher bits. These
//! combinations are the nodes of a binary tree. In a pixel with n points, no two points agree in
//! the first m = ⌈log₂ n⌉ bits of a coordinate. Below these m levels, every subtree therefore
//! contains at most one point, and the point's further bits are simply independent random bits. The
//! result is the true scrambling, with m decisions per coordinate instead of 53. One 64-bit hash
//! decides six levels of the tree. The scrambling of Laine and Karras by multiplications was not
//! tried: it is known to have weak bits, and it would save no time for the numbers of points that
//! pictures use.

use std::ops::Range;

use super::{lattice, rng::Key};

/// Number of levels of the tree of random bits, in Owen's scrambling, that one hash decides. Six
/// levels have 2^6 − 1 nodes, for which the 64 bits of a hash are just enough.
const LEVELS: u32 = 6;

/// Number of levels of the tree that are looked up at a time, in [`SCRAMBLED`].
const BLOCK: u32 = 3;

/// Maximum number of points whose bits before the scrambling are stored. The first 12 bits
/// distinguish all of these points, so two hashes, of six levels each, are enough to scramble a
/// point. For more points, the bits are computed point by point.
const MAX_STORED: u64 = 1 << (2 * LEVELS);

/// The first points of the Sobol' sequence, prepared for scrambling.
#[derive(Clone, Debug)]
pub struct Sobol {
    /// Number of leading bits that distinguish all points: the least m for which there are at most
    /// 2^m points. No two points agree in all m leading bits of a coordinate.
    depth: u32,
    /// The `depth` highest bits of both coordinates of each point, before the scrambling. Empty for
    /// more than 4096 points.
    tops: [Vec<u16>; 2],
}

impl Sobol {
    /// Prepares the first `n` points of the Sobol' sequence.
    pub fn new(n: u64) -> Self {
        let depth = u64::BITS - (n - 1).leading_zeros();
        let stored = if n <= MAX_STORED { n } else { 0 };
        let tops = |coordinate: fn(u64) -> u64| {
            let points = (0..stored).map(|i| high_bits(coordinate(i), depth) as u16);
            points.collect()
        };
        Self {
            depth,
            tops: [tops(first), tops(second)],
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
        if !self.tops[0].is_empty() {
            for ((axis, tops), out) in axes.iter().zip(&self.tops).zip([x, y]) {
                let tops = &tops[range.start as usize..range.end as usize];
                // `place` first clears a list of a fixed length. The length is chosen by the number
                // of points, because a shorter list takes less time.
                match self.depth {
                    0..=6 => axis.place::<{ 1 << 6 }>(tops, out),
                    7..=9 => axis.place::<{ (1 << 9) + (1 << BLOCK) }>(tops, out),
                    _ => axis.place::<{ (1 << 12) + (1 << BLOCK) }>(tops, out),
                }
            }
            return;
        }
        for (i, (x, y)) in range.zip(x.iter_mut().zip(y)) {
            *x = lattice::offset_of_bits(axes[0].scramble(first(i)));
            *y = lattice::offset_of_bits(axes[1].scramble(second(i)));
        }
    }
}

/// Returns the first coordinate of point `i`, as a fraction of the pixel's side in units of 2^−64.
fn first(i: u64) -> u64 {
    i.reverse_bits()
}

/// Returns the second coordinate of point `i`, as a fraction of the pixel's side in units of 2^−64.
fn second(i: u64) -> u64 {
    pascal(i).reverse_bits()
}

/// Multiplies the bits of a number by Pascal's triangle modulo 2. Bit j of the result is the sum
/// over all k of bit k times the binomial coefficient "k choose j", modulo 2. The coefficient is
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
    top: [u16; 1 << LEVELS],
}

impl Owen {
    fn new(key: Key, depth: u32) -> Self {
        let levels = depth.min(LEVELS);
        let mut top = [0; 1 << LEVELS];
        subtree(key.bits(1), levels, 0, &mut top);
        Self {
            key,
            depth,
            levels,
            top,
        }
    }

    /// Writes the offsets of points to `out`. `tops` contains the `depth` highest bits of each
    /// point's coordinate, before the scrambling. `depth` must be at most 12, so that two hashes
    /// are enough for each combination of these bits. `MOST` must be at least the number of
    /// combinations.
    #[inline(always)]
    fn place<const MOST: usize>(&self, tops: &[u16], out: &mut [f64]) {
        let mut scrambled = [0; MOST];
        self.scramble_all(&mut scrambled);
        // The scrambled bits are looked up in a loop of their own, so that the compiler vectorizes
        // the second loop. They are stored in `out` between the two loops, because clearing a
        // separate buffer would take time.
        for (out, &top) in out.iter_mut().zip(tops) {
            *out = f64::from_bits(u64::from(scrambled[usize::from(top)]));
        }
        for (out, &top) in out.iter_mut().zip(tops) {
            let hash = self.key.bits(1 << self.depth | u64::from(top));
            // The bits are shifted in two steps, because a single shift by 64 bits, for depth 0,
            // would overflow.
            let top = out.to_bits() << 1 << (u64::BITS - 1 - self.depth);
            *out = lattice::offset_of_bits(top | hash >> self.depth);
        }
    }

    /// Scrambles each combination of the `depth` highest bits of a coordinate, in ascending order.
    #[inline(always)]
    fn scramble_all<const MOST: usize>(&self, scrambled: &mut [u16; MOST]) {
        if self.depth <= LEVELS {
            scrambled[..self.top.len()].copy_from_slice(&self.top);
            return;
        }
        let below = self.depth - LEVELS;
        let mut flips = [0; 1 << LEVELS];
        for (part, flips) in (1 << LEVELS..).zip(&mut flips) {
            *flips = self.key.bits(part);
        }
        for (part, (flips, &top)) in flips.into_iter().zip(&self.top).enumerate() {
            subtree(flips, below, top << below, &mut scrambled[part << below..]);
        }
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
        // No other point has the same `depth` highest bits, so the remaining bits are simply those
        // of the last hash.
        scrambled << (u64::BITS - self.depth) | flips >> self.depth
    }
}

/// Writes the scrambled value of each combination of `levels` bits, at most six, to `out`, after
/// the higher bits `above`. Always writes whole blocks of eight numbers, so entries of `out` after
/// the last combination may be overwritten. A combination of bits is a path from the root of a
/// binary tree to a leaf. `flips` contains a random bit for each inner node of the tree: bit 1 for
/// the root, bits 2 and 3 for its children, and so on. If a node's bit is set, the bit of the path
/// at this node is flipped.
#[inline(always)]
fn subtree(flips: u64, levels: u32, above: u16, out: &mut [u16]) {
    let top_levels = levels.saturating_sub(BLOCK);
    let tops = &SCRAMBLED[top_levels as usize][(flips >> 1 & 127) as usize];
    let bottoms = &SCRAMBLED[(levels - top_levels) as usize];
    let blocks = out.chunks_exact_mut(1 << BLOCK).zip(tops);
    for (part, (out, &top)) in (0..1_u32 << top_levels).zip(blocks) {
        // `flips` contains the random bits of the tree level by level. The random bits of a block's
        // seven nodes are therefore in three separate groups, one for each level.
        let level = |depth: u32| {
            let nodes = 1_u32 << depth;
            flips >> ((nodes << top_levels) + (part << depth)) & ((1 << nodes) - 1)
        };
        let nodes = level(0) | level(1) << 1 | level(2) << 3;
        for (out, &bottom) in out.iter_mut().zip(&bottoms[nodes as usize]) {
            *out = above | top << BLOCK | bottom;
        }
    }
}

/// Scrambled values of all combinations of up to three bits. The first index is the number of bits.
/// The second index consists of the random bits of the tree's nodes: bit 0 for the root, bits 1 and
/// 2 for its children, and so on. The entry contains the scrambled value of each combination.
static SCRAMBLED: [[[u16; 1 << BLOCK]; 128]; BLOCK as usize + 1] = {
    let mut scrambled = [[[0; 1 << BLOCK]; 128]; BLOCK as usize + 1];
    let mut levels = 1;
    while levels <= BLOCK {
        let mut nodes = 0;
        while nodes < 128 {
            let mut path = 0;
            while path < 1 << levels {
                let value = path ^ flips_along(nodes << 1, path, levels);
                scrambled[levels as usize][nodes as usize][path as usize] = value as u16;
                path += 1;
            }
            nodes += 1;
        }
        levels += 1;
    }
    scrambled
};

/// Returns the random bits of the nodes on a path down a tree. The `levels` bits of `part` describe
/// the path from the root. `flips` contains a random bit for each node: bit 1 for the root, bits 2
/// and 3 for its children, and so on.
const fn flips_along(flips: u64, part: u64, levels: u32) -> u64 {
    let (mut found, mut level) = (0, 0);
    while level < levels {
        let node = 1 << level | part >> (levels - level);
        found = found << 1 | (flips >> node & 1);
        level += 1;
    }
    found
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
        let numbers = [
            2, 3, 5, 8, 17, 64, 65, 100, 128, 300, 512, 513, 1000, 2048, 4095, 4096, 5000,
        ];
        for (seed, n) in (0..20).flat_map(|seed| numbers.map(|n| (seed, n))) {
            let key = Key::new(seed, 5).part(3);
            let sobol = Sobol::new(n);
            assert_eq!(sobol.tops[0].is_empty(), n > MAX_STORED);
            let axes = [0, 1].map(|axis| Owen::new(key.part(axis), sobol.depth));
            let (mut x, mut y) = (vec![0.0; n as usize], vec![0.0; n as usize]);
            sobol.place(key, 0..n, [&mut x, &mut y]);
            for (i, place) in (0..n).zip(x.into_iter().zip(y)) {
                let [a, b] = [first(i), second(i)];
                let [a, b] = [axes[0].scramble(a), axes[1].scramble(b)];
                let alone = (lattice::offset_of_bits(a), lattice::offset_of_bits(b));
                assert_eq!(place, alone, "{i} of {n}");
            }
        }
    }
}
