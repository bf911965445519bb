//! The lines that one edge of a polygon crosses, and the sum over them one by one.
//!
//! In: the series X of [`green`](super::green) along an edge, and where its first line is crossed.
//! Out: Σ (−1)^j X over crossings, in lanes that the compiler makes vectors of, with a bound: the
//! terms that the series is cut off by, and roundings.

use super::homography::{Sum, UNIT};
use super::special::{turn_exactly, waves};
use crate::math::{Double, Real};
use std::f64::consts::PI;

use multiversion::multiversion;

/// The most terms of the asymptotic series.
pub(super) const MAX_TERMS: usize = 20;
/// A sum has fewer blocks than this: m grows by half in each until, after 15, they have MOST_BLOCK
/// crossings, and 300,000 crossings are 74 of those.
const BLOCKS: f64 = 128.0;

/// The crossings of a block: enough that choosing its number of terms is a small part of the work,
/// and few enough for the roundings of a sum. (Measured: a quarter and four times as many change
/// times by about a tenth at most.)
const LEAST_BLOCK: f64 = 16.0;
const MOST_BLOCK: f64 = 4096.0;

/// There are eight running sums, since the terms' signs alternate; and t is computed in
/// double-double again every 64 crossings.
const LANES: usize = 8;
const CHUNK: usize = 64;

/// X on an edge: Σ `factors[k]`·A_k+1(t)·m^(−2−k), k = 1 … terms.
pub(super) struct Series {
    pub terms: usize,
    pub factors: [f64; MAX_TERMS + 1],
}

impl Series {
    pub(super) fn at(&self, t: f64, depth: f64) -> f64 {
        match self.terms {
            0..=2 => self.at_with::<2, 4>(t, depth),
            3..=4 => self.at_with::<4, 6>(t, depth),
            5..=7 => self.at_with::<7, 9>(t, depth),
            8..=12 => self.at_with::<12, 14>(t, depth),
            _ => self.at_with::<MAX_TERMS, { MAX_TERMS + 2 }>(t, depth),
        }
    }

    fn at_with<const MOST: usize, const ROWS: usize>(&self, t: f64, depth: f64) -> f64 {
        let waves = waves::<MOST, ROWS>(t);
        let u = 1.0 / depth;
        let sum = (1..=self.terms)
            .rev()
            .fold(0.0, |sum, k| (sum + self.factors[k] * waves[k + 1]) * u);
        sum * u * u
    }

    /// A bound on the k-th term, by |A_k+1| ≤ ½π^(−k).
    pub(super) fn size(&self, k: usize, depth: f64) -> f64 {
        let u = 1.0 / depth;
        let mut size = 0.5 * self.factors[k].abs() * u * u;
        for _ in 0..k {
            size *= u / PI;
        }
        size
    }

    /// How many terms a sum over so many crossings needs from some depth on, for what is left to be
    /// below `limit`; and what is left.
    fn enough(&self, depth: f64, lines: f64, limit: f64) -> (usize, f64) {
        let (mut terms, mut left) = (self.terms, 0.0);
        while terms > 1 {
            let more = left + lines * self.size(terms, depth);
            if more > limit {
                break;
            }
            left = more;
            terms -= 1;
        }
        (terms, left)
    }
}

/// The lines of one family that an edge crosses: t and m at the first, and how many there are.
pub(super) struct LineCrossings {
    /// t and its step from line to line, without whole turns, in half turns.
    pub turned: [Double; 2],
    pub depth: f64,
    /// m's step from line to line.
    pub rise: f64,
    /// How many there are, a whole number; infinite for an edge that ends at the horizon.
    pub count: Double,
}

impl LineCrossings {
    /// Σ (−1)^j X over the first `lines` crossings, one by one.
    ///
    /// In blocks over which m grows by half, each with as many terms as it needs for `tolerance`.
    pub(super) fn one_by_one(&self, series: &Series, lines: f64, tolerance: f64) -> Sum {
        let limit = tolerance / BLOCKS;
        let mut sum = Sum::default();
        let mut done = 0.0;
        while done < lines {
            let depth = self.depth + done * self.rise;
            let most = (0.5 * depth / self.rise)
                .floor()
                .clamp(LEAST_BLOCK, MOST_BLOCK);
            let count = most.min(lines - done);
            let (terms, left) = series.enough(depth, count, limit);
            let block = block(self, series, terms, [done, count]);
            sum.value += if done % 2.0 == 0.0 { block } else { -block };
            // t is off by two roundings, and three of the way that it goes within a chunk, which
            // X′, at most π X's bound, takes to X; half that way on the average, and
            // four times all that for certain. A term has 14 roundings of its own, counted as in
            // `green`; the sum of the block as many as are added in a lane.
            let reach = 2.0 + 0.5 * count.min(CHUNK as f64);
            let added = count / LANES as f64 + 4.0;
            let rounding = UNIT * series.size(1, depth) * (added + 16.0 + 4.0 * PI * reach);
            sum.bound += left + count * rounding;
            done += count;
        }
        sum
    }

    #[inline(always)]
    fn block<const TERMS: usize, const ROWS: usize>(
        &self,
        series: &Series,
        done: f64,
        count: f64,
    ) -> f64 {
        let mut sums = [0.0; LANES];
        let mut left = count as usize;
        let mut j = done;
        while left > 0 {
            let now = left.min(CHUNK);
            // A loop that the compiler makes vectors of, to the end of the last of them; what is
            // too much is not added.
            let mut values = [0.0; CHUNK];
            let filled = now.next_multiple_of(LANES);
            let t = self.turned_at(&Double::from_f64(j)).hi;
            for (i, value) in values[..filled].iter_mut().enumerate() {
                *value = self.at::<TERMS, ROWS>(series, t, j, f64::from(i as u32));
            }
            values[now..filled].fill(0.0);
            for values in values[..filled].chunks_exact(LANES) {
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += value;
                }
            }
            left -= now;
            j += now as f64;
        }
        ((sums[0] - sums[1]) + (sums[2] - sums[3])) + ((sums[4] - sums[5]) + (sums[6] - sums[7]))
    }

    /// t at crossing j, without whole turns.
    pub(super) fn turned_at(&self, j: &Double) -> Double {
        let [t, stride] = &self.turned;
        turn_exactly(&t.plus(&stride.times(j)))
    }

    /// t's step from line to line and a half turn, by which s turns; without whole turns.
    pub(super) fn turning(&self) -> Double {
        turn_exactly(&self.turned[1].plus(&Double::from_f64(1.0)))
    }

    /// X at crossing j + i, where t is that of crossing j.
    #[inline(always)]
    fn at<const TERMS: usize, const ROWS: usize>(
        &self,
        series: &Series,
        t: f64,
        j: f64,
        i: f64,
    ) -> f64 {
        let waves = waves::<TERMS, ROWS>(t + i * self.turned[1].hi);
        let u = 1.0 / (self.depth + (j + i) * self.rise);
        let (mut x, mut k) = (0.0, TERMS);
        while k > 0 {
            x = (x + series.factors[k] * waves[k + 1]) * u;
            k -= 1;
        }
        x * u * u
    }
}

/// Σ (−1)^j X over so many crossings after those that are done, of the series so many terms.
#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn block(crossings: &LineCrossings, series: &Series, terms: usize, [done, count]: [f64; 2]) -> f64 {
    match terms {
        1 => crossings.block::<1, 3>(series, done, count),
        2 => crossings.block::<2, 4>(series, done, count),
        3 => crossings.block::<3, 5>(series, done, count),
        4 => crossings.block::<4, 6>(series, done, count),
        5 => crossings.block::<5, 7>(series, done, count),
        6 => crossings.block::<6, 8>(series, done, count),
        7..=9 => crossings.block::<9, 11>(series, done, count),
        10..=12 => crossings.block::<12, 14>(series, done, count),
        _ => crossings.block::<MAX_TERMS, { MAX_TERMS + 2 }>(series, done, count),
    }
}
