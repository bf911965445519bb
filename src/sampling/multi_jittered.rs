//! `multi_jittered`: one point in each cell of a grid and, at the same time, one in each of n
//! columns and n rows (Kensler 2013, "Correlated multi-jittered sampling"). `n_rooks` is the
//! special case of a grid with one row. Its points only have the property that one lies in each of
//! n columns and n rows (McKay, Beckman and Conover 1979, Latin hypercube; Shirley 1991 calls it
//! n-rooks).
//!
//! For n = a·b points, the grid has a columns and b rows, where b is the greatest divisor of n up
//! to √n. The point of the cell in column i and row j lies in column i·b + σ(j) of the n columns,
//! and in row j·a + τ(i) of the n rows. Here σ is a random permutation of the b rows, and τ is a
//! random permutation of the a columns. Kensler's method uses the same σ and τ in the whole pixel.
//! The older method of Chiu, Shirley and Wang (1994) draws new permutations for each row and column
//! of the grid. If n is prime, b is 1.

use std::ops::Range;

use super::{
    lattice::{Strata, Stratum},
    rng::Key,
    shuffle::{EMPTY_BUFFER, Shuffle},
};

/// A grid of cells in a pixel, and the division of the pixel's sides into n intervals.
#[derive(Debug)]
pub struct MultiJittered {
    columns: u64,
    rows: u64,
    /// Division of the pixel's width into n equal intervals. The height is divided in the same way.
    strata: Strata,
    /// The pixel's n columns in another order. Each column of the grid consists of several of them.
    /// The list contains the first of each grid column, then the second of each, and so on. Empty
    /// if there are too many columns to be stored.
    cell_columns: Vec<Stratum>,
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
        let (columns, strata) = (n / rows, Strata::new(n));
        let stored = strata.stored().unwrap_or_default();
        let stored = (0..rows as usize).flat_map(|j| stored.iter().skip(j).step_by(rows as usize));
        Self {
            columns,
            rows,
            cell_columns: stored.copied().collect(),
            strata,
        }
    }

    /// Returns the number of columns and the number of rows of the grid.
    pub fn grid(&self) -> [u64; 2] {
        [self.columns, self.rows]
    }

    /// Places the points whose indices are in `range`; points are counted row by row. Writes their
    /// offsets from the pixel's centre to the two lists of coordinates in `out`.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
        let mut buffers = [EMPTY_BUFFER; 2];
        let [sigma, tau] = &mut buffers;
        let sigma = Shuffle::new(self.rows, key.part(0), sigma);
        let tau = Shuffle::new(self.columns, key.part(1), tau);
        // First, a column and a row are assigned to each point, one row of the grid after the
        // other. They are stored in the lists of coordinates until the positions within them are
        // chosen. A separate buffer would have to be cleared first, which takes time.
        let (mut i, mut j) = (range.start % self.columns, range.start / self.columns);
        let (mut columns, mut rows) = (&mut *x, &mut *y);
        while !columns.is_empty() {
            let part = columns.len().min((self.columns - i) as usize);
            let (column_part, column_rest) = columns.split_at_mut(part);
            let (row_part, row_rest) = rows.split_at_mut(part);
            self.assign([i, j], &sigma, &tau, [column_part, row_part]);
            (columns, rows) = (column_rest, row_rest);
            (i, j) = (0, j + 1);
        }
        // Then a random position within each point's column and row is chosen, in a loop of its own
        // that the compiler can vectorize.
        for (axis, out) in [(0, x), (1, y)] {
            self.strata
                .choose_all(out, key.series(2 * range.start + axis, 2));
        }
    }

    /// Assigns a column and a row to each of some points in one row of the grid. `i` and `j` are
    /// the first point's column and row in the grid.
    #[inline(always)]
    fn assign(&self, [i, j]: [u64; 2], sigma: &Shuffle, tau: &Shuffle, [x, y]: [&mut [f64]; 2]) {
        let first_column = sigma.get(j) * self.columns + i;
        let first_row = j * self.columns;
        match (tau.stored(), self.strata.stored()) {
            (Some(tau), Some(strata)) => {
                let columns = &self.cell_columns[first_column as usize..];
                for (x, column) in x.iter_mut().zip(columns) {
                    *x = column.to_f64();
                }
                let rows = &strata[first_row as usize..];
                for (y, &row) in y.iter_mut().zip(&tau[i as usize..]) {
                    *y = rows[usize::from(row)].to_f64();
                }
            }
            _ => {
                for (i, (x, y)) in (i..).zip(x.iter_mut().zip(y)) {
                    *x = self.strata.get(i * self.rows + sigma.get(j)).to_f64();
                    *y = self.strata.get(first_row + tau.get(i)).to_f64();
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_placed_together_are_those_of_the_definition() {
        for n in [
            1, 2, 3, 4, 7, 16, 46, 64, 65, 97, 100, 256, 1000, 4096, 5000,
        ] {
            let grids = [MultiJittered::new(n), MultiJittered::n_rooks(n)];
            for (seed, grid) in (0..10).flat_map(|seed| grids.iter().map(move |grid| (seed, grid)))
            {
                let key = Key::new(seed, 5).part(seed);
                let (mut x, mut y) = (vec![0.0; n as usize], vec![0.0; n as usize]);
                // The points are placed by two calls. The first call may end within a row of the
                // grid.
                let split = n * 2 / 5;
                let (first, second) = (split as usize, n as usize);
                grid.place(key, 0..split, [&mut x[..first], &mut y[..first]]);
                grid.place(
                    key,
                    split..n,
                    [&mut x[first..second], &mut y[first..second]],
                );
                let mut buffers = [EMPTY_BUFFER; 2];
                let [sigma, tau] = &mut buffers;
                let sigma = Shuffle::new(grid.rows, key.part(0), sigma);
                let tau = Shuffle::new(grid.columns, key.part(1), tau);
                let strata = Strata::new(n);
                for point in 0..n {
                    let (i, j) = (point % grid.columns, point / grid.columns);
                    let column = i * grid.rows + sigma.get(j);
                    let row = j * grid.columns + tau.get(i);
                    let place = [
                        strata.choose(column, key.bits(2 * point)),
                        strata.choose(row, key.bits(2 * point + 1)),
                    ];
                    assert_eq!(
                        [x[point as usize], y[point as usize]],
                        place,
                        "{point} of {n}"
                    );
                }
            }
        }
    }
}
