//! `multi_jittered`: one point in each cell of a grid and, at once, one in each of n columns and n rows (Kensler 2013, "Correlated
//! multi-jittered sampling"). `n_rooks` is the grid of one row, where only the second remains (McKay, Beckman and Conover
//! 1979, Latin hypercube; Shirley 1991 calls it n-rooks).
//!
//! n = a·b points have a grid of a columns and b rows, b the greatest divisor of n that is not above √n. The point of cell (i, j) lies in
//! the fine column i·b + σ(j) and in the fine row j·a + τ(i), for two random permutations σ of the b rows and τ of the a columns. Both
//! are the same for the whole pixel, and that is the correlation which Kensler adds to Chiu, Shirley and Wang 1994. A prime n
//! has b = 1: the Latin hypercube.

use std::ops::Range;

use glam::DVec2;

use super::{hash::Key, lattice::Strata, shuffle::Shuffle};
use crate::math::Vectors;

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

    /// Appends the points with these indices, row by row.
    pub fn points(&self, key: Key, range: Range<u64>, vectors: Vectors, out: &mut Vec<DVec2>) {
        if range.is_empty() {
            return;
        }
        let sigma = Shuffle::new(self.rows, key.part(0));
        let tau = Shuffle::new(self.columns, key.part(1));
        let (mut i, mut j) = (range.start % self.columns, range.start / self.columns);
        key.pairs(range, vectors, |_, pairs| {
            out.extend(pairs.iter().map(|&[x, y]| {
                let column = i * self.rows + sigma.get(j);
                let row = j * self.columns + tau.get(i);
                i += 1;
                if i == self.columns {
                    (i, j) = (0, j + 1);
                }
                DVec2::new(self.strata.choose(column, x), self.strata.choose(row, y))
            }));
        });
    }
}
