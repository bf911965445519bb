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
    hash::Key,
    lattice::{Strata, Stratum},
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
    pub fn place(&self, key: Key, range: Range<u64>, out: [&mut [f64]; 2]) {
        if range.is_empty() {
            return;
        }
        let sigma = Shuffle::new(self.rows, key.part(0));
        let tau = Shuffle::new(self.columns, key.part(1));
        let strata = self.strata.stored();
        match (sigma.stored(), tau.stored()) {
            (Some(sigma), Some(tau)) if !strata.is_empty() => {
                self.place_in_rows(key, range.start, sigma, tau, strata, out);
            }
            _ => self.place_singly(key, range.start, &sigma, &tau, out),
        }
    }

    /// The same where everything is stored.
    #[inline(always)]
    fn place_in_rows(
        &self,
        key: Key,
        start: u64,
        sigma: &[u16],
        tau: &[u16],
        strata: &[Stratum],
        [x, y]: [&mut [f64]; 2],
    ) {
        let [columns, rows] = [self.columns, self.rows].map(|number| number as usize);
        let (mut i, mut j) = (start as usize % columns, start as usize / columns);
        let least = self.strata.least();
        let mut index = 2 * start;
        let mut chosen = [[Stratum::default(); BATCH]; 2];
        for (x, y) in x.chunks_mut(BATCH).zip(y.chunks_mut(BATCH)) {
            // First the strata, which are looked up one by one.
            let mut point = 0;
            while point < x.len() {
                let end = x.len().min(point + columns - i);
                let fine_columns = strata[i * rows + usize::from(sigma[j])..]
                    .iter()
                    .step_by(rows);
                let fine_rows = &strata[j * columns..][..columns];
                let [a, b] = chosen.each_mut().map(|chosen| &mut chosen[point..end]);
                for ((a, &column), (b, &row)) in a
                    .iter_mut()
                    .zip(fine_columns)
                    .zip(b.iter_mut().zip(&tau[i..]))
                {
                    (*a, *b) = (column, fine_rows[usize::from(row)]);
                }
                i += end - point;
                if i == columns {
                    (i, j) = (0, j + 1);
                }
                point = end;
            }
            // Then a place in each.
            for (axis, (out, chosen)) in [(0, (x, &chosen[0])), (1, (y, &chosen[1]))] {
                for (point, (out, stratum)) in (0..).zip(out.iter_mut().zip(chosen)) {
                    *out = stratum.choose(least, key.bits(index + axis + 2 * point));
                }
            }
            index += 2 * BATCH as u64;
        }
    }

    /// The same where they are too many.
    #[inline(always)]
    fn place_singly(
        &self,
        key: Key,
        start: u64,
        sigma: &Shuffle,
        tau: &Shuffle,
        [x, y]: [&mut [f64]; 2],
    ) {
        let (mut i, mut j) = (start % self.columns, start / self.columns);
        for (index, (x, y)) in (start..).zip(x.iter_mut().zip(y)) {
            let column = i * self.rows + sigma.get(j);
            let row = j * self.columns + tau.get(i);
            *x = self.strata.choose(column, key.bits(2 * index));
            *y = self.strata.choose(row, key.bits(2 * index + 1));
            i += 1;
            if i == self.columns {
                (i, j) = (0, j + 1);
            }
        }
    }
}
