//! `multi_jittered`: one point in each cell of a grid and, at once, one in each of n columns and n rows (Kensler 2013, "Correlated
//! multi-jittered sampling"). `n_rooks` is the grid of one row, where only the second remains (McKay, Beckman and Conover
//! 1979, Latin hypercube; Shirley 1991 calls it n-rooks).
//!
//! n = a·b points have a grid of a columns and b rows, b the greatest divisor of n that is not above √n. The point of cell (i, j) lies in
//! the fine column i·b + σ(j) and in the fine row j·a + τ(i), for two random permutations σ of the b rows and τ of the a columns. Both
//! are the same for the whole pixel, and that is the correlation which Kensler adds to Chiu, Shirley and Wang 1994. A prime n
//! has b = 1: the Latin hypercube.

use std::ops::Range;

use super::{
    hash::{Key, scale_by_halves},
    lattice::{self, Strata},
    shuffle::Shuffle,
};

/// So many points are placed at a time.
const BATCH: usize = 64;

/// A grid of cells, with the fine strata that they are made of.
#[derive(Debug)]
pub struct MultiJittered {
    columns: u64,
    rows: u64,
    /// The pixel's width, and its height, in n parts.
    strata: Strata,
}

impl MultiJittered {
    /// The grid for `n` points that is nearest to a square.
    pub fn new(n: u64) -> Self {
        let rows = (1..=n.isqrt()).rev().find(|&b| n.is_multiple_of(b));
        Self::with_rows(n, rows.unwrap_or(1))
    }

    /// The grid of one row: n-rooks.
    pub fn n_rooks(n: u64) -> Self {
        Self::with_rows(n, 1)
    }

    fn with_rows(n: u64, rows: u64) -> Self {
        Self {
            columns: n / rows,
            rows,
            strata: Strata::new(n),
        }
    }

    /// Places the points with these indices, row by row.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
        if range.is_empty() {
            return;
        }
        let sigma = Shuffle::new(self.rows, key.part(0));
        let tau = Shuffle::new(self.columns, key.part(1));
        let (mut i, mut j) = (range.start % self.columns, range.start / self.columns);
        let mut first = 2 * range.start;
        let (mut columns, mut rows) = (Bounds::default(), Bounds::default());
        for (x, y) in x.chunks_mut(BATCH).zip(y.chunks_mut(BATCH)) {
            for point in 0..x.len() {
                columns.set(point, self.strata.bounds(i * self.rows + sigma.get(j)));
                rows.set(point, self.strata.bounds(j * self.columns + tau.get(i)));
                i += 1;
                if i == self.columns {
                    (i, j) = (0, j + 1);
                }
            }
            columns.choose(key, first, x);
            rows.choose(key, first + 1, y);
            first += 2 * BATCH as u64;
        }
    }
}

/// The strata of some points on one axis: the first of their places, and the first behind them.
struct Bounds {
    starts: [u64; BATCH],
    ends: [u64; BATCH],
}

impl Default for Bounds {
    fn default() -> Self {
        Self {
            starts: [0; BATCH],
            ends: [0; BATCH],
        }
    }
}

impl Bounds {
    #[inline(always)]
    fn set(&mut self, point: usize, [start, end]: [u64; 2]) {
        (self.starts[point], self.ends[point]) = (start, end);
    }

    /// Chooses a place in each stratum by the numbers of a key, every other one from `first` on.
    #[inline(always)]
    fn choose(&self, key: Key, first: u64, out: &mut [f64]) {
        let bounds = self.starts.iter().zip(&self.ends);
        for (point, (out, (&start, &end))) in (0..).zip(out.iter_mut().zip(bounds)) {
            let place = start + scale_by_halves(key.bits(first + 2 * point), end - start);
            *out = lattice::offset(place);
        }
    }
}
