//! The lines that one edge of a polygon crosses, and the direct sum over these crossings.
//!
//! By Green's theorem ([`green`](super::green)), the integral of a board's sign over a polygon is a
//! sum over the points where the polygon's edges cross lines of the board. The contribution of a
//! point is the value of a function X there, which is given as a truncated series ([`EdgeSeries`]).
//!
//! In: the function X of an edge, and the point where the edge crosses its first line. Out: the
//! alternating sum Σ (−1)^j·X over the crossings j, with a bound on truncation and rounding errors.
//! The compiler vectorises the sum. It is divided into blocks of consecutive crossings. Far from
//! the eye, the terms of X decrease faster, so blocks there use fewer terms.

use super::homography::{BoundedSum, UNIT};
use super::special::{reduce_double, waves};
use crate::math::{Double, Real};
use std::f64::consts::PI;

use multiversion::multiversion;

/// Maximum number of terms of the series ([`EdgeSeries`]) by which a checkerboard is integrated
/// along an edge. The error bound includes the omitted terms. The series is used only where the
/// distance from the line with the depth 0 is more than 18 squares (`NEAR_SQUARES`). The bound of
/// the omitted terms is then proportional to 22!/2·(18π)⁻²⁰, about 5e-15. Fewer terms would make
/// this factor larger.
pub(super) const MAX_TERMS: usize = 20;
/// Upper limit on the number of blocks into which the sum over an edge's crossings is divided. Each
/// block may have a truncation error of the tolerance divided by this number. The error of all
/// blocks together is then within the tolerance. The longest sum has 300,000 crossings: about 15
/// blocks that grow up to `MAX_BLOCK` crossings, and about 74 blocks of `MAX_BLOCK` crossings.
const MAX_BLOCKS: f64 = 128.0;

/// Minimum number of crossings in a block of the sum over an edge's crossings. In a block of 16
/// crossings, choosing the number of terms is only a small part of the work. Not critical: with 4
/// or 64, the measured running time changes by at most about 10 %.
const MIN_BLOCK: f64 = 16.0;
/// Maximum number of crossings in a block of the sum over an edge's crossings, which limits the
/// rounding error of the block. Not critical: with 1024 or 16,384, the measured running time
/// changes by at most about 10 %.
const MAX_BLOCK: f64 = 4096.0;

/// Number of running sums in which the alternating terms of an edge's crossings are added: crossing
/// j goes to sum j mod `LANES`. The compiler vectorises the loop, and the widest vectors hold eight
/// `f64`. Because the number is even, all terms in one running sum have the same sign (−1)^j.
const LANES: usize = 8;
/// Number of crossings of an edge after which the position along the edge is computed anew in
/// double-double. In between, the position advances in `f64`, with an error that grows with the
/// number of steps. A larger number would make the error larger; a smaller number would require the
/// slow double-double more often.
const CHUNK: usize = 64;

/// A truncated series X, a function of the position along an edge of a polygon. Added up with
/// alternating signs over the points where the edge crosses lines of a board, it gives the edge's
/// contribution to the integral of the board's sign over the polygon.
///
/// X = Σ `factors[k]`·A_k+1(t)·m^(−2−k), k = 1 … `terms`
///
/// Here t is the coordinate along the edge, m is the depth of the point, and the A_k are the
/// periodic Euler polynomials ([`waves`]).
#[derive(Debug)]
pub(super) struct EdgeSeries {
    pub terms: usize,
    pub factors: [f64; MAX_TERMS + 1],
}

impl EdgeSeries {
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

    /// Returns an upper bound of the absolute value of term `k` of the series ([`EdgeSeries`]) at
    /// the depth `depth`. It uses |A_k+1| ≤ ½π^(−k), which holds for the periodic Euler polynomials
    /// A_k.
    pub(super) fn size(&self, k: usize, depth: f64) -> f64 {
        let u = 1.0 / depth;
        let mut size = 0.5 * self.factors[k].abs() * u * u;
        for _ in 0..k {
            size *= u / PI;
        }
        size
    }

    /// Returns the least number of terms of the series with which the truncation error of a sum
    /// over `lines` crossings is at most `limit`, and a bound on this error. `depth` is the
    /// smallest depth of a crossing.
    fn terms_for(&self, depth: f64, lines: f64, limit: f64) -> (usize, f64) {
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

/// The points where one edge of a polygon crosses the lines between the columns of a board, or the
/// lines between its rows.
#[derive(Debug)]
pub(super) struct LineCrossings {
    /// Coordinate t along the edge at the first crossed line, and the change of t from one crossed
    /// line to the next, in double-double. The unit is the side of a square. Multiples of 2, the
    /// period of the square wave, are subtracted.
    pub reduced: [Double; 2],
    /// Depth m of the edge at the first line that it crosses.
    pub depth: f64,
    /// Change of the edge's depth m from one crossed line to the next.
    pub rise: f64,
    /// Number of crossed lines, an integer; infinite if the edge ends on the horizon.
    pub count: Double,
}

impl LineCrossings {
    /// Computes the alternating sum Σ (−1)^j·X over the first `lines` crossings j, one by one, in
    /// blocks. `series` gives X, the edge's contribution at a crossing. `tolerance` limits the
    /// truncation error.
    ///
    /// A block ends where the depth has grown by half, but it contains at least [`MIN_BLOCK`]
    /// crossings (or all that are left) and at most [`MAX_BLOCK`]. Each block uses as few terms of
    /// the series as the tolerance allows.
    pub(super) fn one_by_one(&self, series: &EdgeSeries, lines: f64, tolerance: f64) -> BoundedSum {
        let limit = tolerance / MAX_BLOCKS;
        let mut sum = BoundedSum::default();
        let mut done = 0.0;
        while done < lines {
            let depth = self.depth + done * self.rise;
            let most = (0.5 * depth / self.rise)
                .floor()
                .clamp(MIN_BLOCK, MAX_BLOCK);
            let count = most.min(lines - done);
            let (terms, left) = series.terms_for(depth, count, limit);
            let block = block(self, series, terms, [done, count]);
            sum.value += if done % 2.0 == 0.0 { block } else { -block };
            // The rounding errors, in unit roundoffs, consist of three parts. First, the coordinate
            // t has an error of at most 2, plus 3 for each crossing since t was last computed in
            // double-double. The mean of this error over the block is at most 4·`reach`. The slope
            // of X is at most π·`series.size`, so an error of t causes an error of X of at most
            // π·`series.size` times the error of t. Second, X is computed with 14 roundings
            // (derived in `green`). Third, each number that is added to one of the `LANES` running
            // sums adds one rounding.
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
        series: &EdgeSeries,
        done: f64,
        count: f64,
    ) -> f64 {
        let mut sums = [0.0; LANES];
        let mut left = count as usize;
        let mut j = done;
        while left > 0 {
            let now = left.min(CHUNK);
            // The compiler vectorises this loop only if the number of values is a multiple of
            // `LANES`. Up to `LANES` − 1 surplus values are therefore computed, and then set to 0.
            let mut values = [0.0; CHUNK];
            let filled = now.next_multiple_of(LANES);
            let t = self.reduced_at(&Double::from_f64(j)).hi;
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

    /// Returns the coordinate t along the edge at crossing `j`, in squares, with multiples of 2,
    /// the period of the square wave, subtracted.
    pub(super) fn reduced_at(&self, j: &Double) -> Double {
        let [t, stride] = &self.reduced;
        reduce_double(&t.plus(&stride.times(j)))
    }

    /// Returns the change of the coordinate t from one crossing to the next, plus 1, in squares.
    /// The added 1 is half a period of the square wave. It accounts for the sign (−1)^j, which
    /// alternates from crossing to crossing. Multiples of the period, 2, are subtracted.
    pub(super) fn alternating_step(&self) -> Double {
        reduce_double(&self.reduced[1].plus(&Double::from_f64(1.0)))
    }

    /// Computes the series ([`EdgeSeries`]) at crossing `j` + `i`. `t` is the coordinate along the
    /// edge at crossing `j`, in squares.
    #[inline(always)]
    fn at<const TERMS: usize, const ROWS: usize>(
        &self,
        series: &EdgeSeries,
        t: f64,
        j: f64,
        i: f64,
    ) -> f64 {
        let waves = waves::<TERMS, ROWS>(t + i * self.reduced[1].hi);
        let u = 1.0 / (self.depth + (j + i) * self.rise);
        let (mut x, mut k) = (0.0, TERMS);
        while k > 0 {
            x = (x + series.factors[k] * waves[k + 1]) * u;
            k -= 1;
        }
        x * u * u
    }
}

/// Computes the alternating sum Σ (−1)^j·X over `count` consecutive crossings of an edge. j is 0 at
/// the first of them; the edge has `done` other crossings before it. `series` gives X, the edge's
/// contribution at a crossing, truncated after `terms` terms. `terms` is rounded up to a number of
/// terms for which the loop is compiled.
#[multiversion(targets(
    "x86_64+avx512bw+avx512cd+avx512dq+avx512f+avx512vl+bmi1+bmi2+fma+lzcnt+popcnt",
    "x86_64+avx2+bmi1+bmi2+fma+lzcnt+popcnt",
))]
fn block(all: &LineCrossings, series: &EdgeSeries, terms: usize, [done, count]: [f64; 2]) -> f64 {
    match terms {
        1 => all.block::<1, 3>(series, done, count),
        2 => all.block::<2, 4>(series, done, count),
        3 => all.block::<3, 5>(series, done, count),
        4 => all.block::<4, 6>(series, done, count),
        5 => all.block::<5, 7>(series, done, count),
        6 => all.block::<6, 8>(series, done, count),
        7..=9 => all.block::<9, 11>(series, done, count),
        10..=12 => all.block::<12, 14>(series, done, count),
        _ => all.block::<MAX_TERMS, { MAX_TERMS + 2 }>(series, done, count),
    }
}
