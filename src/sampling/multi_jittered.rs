//! `multi_jittered`: one point in each cell of a grid and, at the same time, one in each of n
//! columns and n rows (Kensler 2013, "Correlated multi-jittered sampling"). `n_rooks` is the
//! special case of a grid with one row. Its points only have the property that one lies in each of
//! n columns and n rows (McKay, Beckman and Conover 1979, Latin hypercube; Shirley 1991 calls it
//! n-rooks).
//!
//! For n = a·b points, the grid has a columns and b rows, where b is the greatest divisor of n up
//! to √n. The point of the cell in column i and row j lies in column i·b + σ(j) of the n columns,
//! and in row j·a + τ(i) of the n rows. Here σ is a random permutation of the b rows, and τ is a
//! random permutation of the a columns. Kensler's method uses the same σ and τ in the whole pixel,
//! unlike the method of Chiu, Shirley and Wang (1994), on which it is based. If n is prime, b is 1.

use std::ops::Range;

use super::{
    lattice::{Strata, Stratum},
    rng::Key,
    shuffle::{EMPTY_BUFFER, Shuffle},
};

/// Number of points that are placed at a time. Most pixels have at most this many points. With a
/// larger number, small pixels would take longer, because a buffer of this length is cleared for
/// every pixel.
const BATCH: usize = 16;

/// A grid of cells in a pixel, and the division of the pixel's sides into n intervals.
#[derive(Debug)]
pub struct MultiJittered {
    columns: u64,
    rows: u64,
    /// Division of the pixel's width into n equal intervals. The height is divided in the same way.
    strata: Strata,
}

impl MultiJittered {
    /// Prepares a grid for `n` points. Its numbers of columns and rows are as nearly equal as
    /// possible.
    pub fn new(n: u64) -> Self {
        let rows = (1..=n.isqrt()).rev().find(|&b| n.is_multiple_of(b));
        Self::with_rows(n, rows.unwrap_or(1))
    }

    /// Prepares a grid of one row for `n` points.
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

    /// Returns the number of columns and the number of rows of the grid.
    pub fn grid(&self) -> [u64; 2] {
        [self.columns, self.rows]
    }

    /// Places the points whose indices are in `range`; points are counted row by row. Writes their
    /// offsets from the pixel's centre to the two lists of coordinates in `out`.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, out: [&mut [f64]; 2]) {
        let mut buffers = [EMPTY_BUFFER; 2];
        let [sigma, tau] = &mut buffers;
        let sigma = Shuffle::new(self.rows, key.part(0), sigma);
        let tau = Shuffle::new(self.columns, key.part(1), tau);
        match (sigma.stored(), tau.stored(), self.strata.stored()) {
            (Some(sigma), Some(tau), Some(strata)) => {
                let in_row = |j: u64| u64::from(sigma[j as usize]);
                let in_column = |i: u64| u64::from(tau[i as usize]);
                let stratum = |i: u64| strata[i as usize];
                self.place_with(key, range.start, in_row, in_column, stratum, out);
            }
            _ => {
                let (in_row, in_column) = (|j| sigma.get(j), |i| tau.get(i));
                let stratum = |i| self.strata.get(i);
                self.place_with(key, range.start, in_row, in_column, stratum, out);
            }
        }
    }

    #[inline(always)]
    fn place_with(
        &self,
        key: Key,
        start: u64,
        sigma: impl Fn(u64) -> u64,
        tau: impl Fn(u64) -> u64,
        stratum: impl Fn(u64) -> Stratum,
        [x, y]: [&mut [f64]; 2],
    ) {
        let least = self.strata.least();
        let (mut i, mut j) = (start % self.columns, start / self.columns);
        let mut index = 2 * start;
        let mut chosen = [[Stratum::default(); BATCH]; 2];
        for (x, y) in x.chunks_mut(BATCH).zip(y.chunks_mut(BATCH)) {
            // First, a column and a row are assigned to each point, one point after the other.
            let [columns, rows] = &mut chosen;
            let mut points = columns.iter_mut().zip(rows).take(x.len());
            while points.len() > 0 {
                let first_column = sigma(j);
                let first_row = j * self.columns;
                let part = points.len().min((self.columns - i) as usize);
                for (column, row) in points.by_ref().take(part) {
                    *column = stratum(i * self.rows + first_column);
                    *row = stratum(first_row + tau(i));
                    i += 1;
                }
                if i == self.columns {
                    (i, j) = (0, j + 1);
                }
            }
            // After the columns and rows of the points are known, a random place is chosen in each
            // column and row, in loops that the compiler can vectorize.
            for (axis, (out, chosen)) in [(0, (x, &chosen[0])), (1, (y, &chosen[1]))] {
                for (point, (out, stratum)) in (0..).zip(out.iter_mut().zip(chosen)) {
                    *out = stratum.choose(least, key.bits(index + axis + 2 * point));
                }
            }
            index += 2 * BATCH as u64;
        }
    }
}
