//! Divides a pixel into n cells of equal area, for every n: rows of cells, like bricks.
//!
//! Row k has n_k cells. Each has the width 1/n_k and the height n_k/n, so that its area is 1/n. The
//! number m of rows is the whole number nearest to √n, or the nearest odd one if n is odd, because
//! an odd n cannot be divided symmetrically into an even number of rows. n_k is ⌊n/m⌋ or ⌈n/m⌉. The
//! longer rows are spread evenly, and the row lengths are symmetric about the middle. For example,
//! 16 cells are divided into rows of 4, 4, 4 and 4 cells, 7 cells into 2, 3 and 2, and 14 cells
//! into 3, 4, 4 and 3.

use std::ops::Range;

/// A division of a pixel into n cells of equal area, which are arranged in rows like bricks.
#[derive(Clone, Copy, Debug)]
pub struct Bricks {
    n: u64,
    /// Number of rows of cells.
    rows: u64,
    /// Number of cells in a short row: n divided by the number of rows, rounded down.
    short: u64,
    /// Number of long rows in the upper half of the pixel. A long row has one cell more than a
    /// short row.
    longer: u64,
}

/// A row of the cells into which a pixel is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BrickRow {
    /// Number of cells in all rows above. In a pixel of n cells, the row begins at the height
    /// `first`/n.
    pub first: u64,
    /// Number of cells in the row.
    pub cells: u64,
}

impl Bricks {
    /// Divides a pixel into `n` cells, 1 ≤ n ≤ 2^53.
    pub fn new(n: u64) -> Self {
        let root = n.isqrt();
        let rows = if n % 2 == 1 {
            // The odd one of ⌊√n⌋ and ⌊√n⌋ + 1 is the odd number nearest to √n.
            root | 1
        } else if n - root * root > root {
            // `n` is more than (root + 1/2)², so √n is nearer to root + 1 than to root.
            root + 1
        } else {
            root
        };
        Self {
            n,
            rows,
            short: n / rows,
            longer: n % rows / 2,
        }
    }

    /// Returns the number of cells.
    pub fn cells(&self) -> u64 {
        self.n
    }

    /// Returns the number of cells in a short row and in a longer row.
    pub fn lengths(&self) -> [u64; 2] {
        [self.short, self.short + 1]
    }

    /// Iterates over the rows that contain the cells with the indices `cells`. Each row comes with
    /// the range of columns in which these cells lie. Cells are counted row by row.
    pub fn parts(&self, cells: Range<u64>) -> impl Iterator<Item = (BrickRow, Range<u64>)> {
        let mut next = cells.start;
        let mut k = self.row_of_cell(next.min(self.n - 1));
        std::iter::from_fn(move || {
            if next >= cells.end {
                return None;
            }
            let row = self.row(k);
            let columns = next - row.first..row.cells.min(cells.end - row.first);
            k += 1;
            next = row.first + row.cells;
            Some((row, columns))
        })
    }

    /// Returns the row with index `k`, from the top.
    fn row(&self, k: u64) -> BrickRow {
        let first = self.cells_above(k);
        BrickRow {
            first,
            cells: self.cells_above(k + 1) - first,
        }
    }

    /// Returns the index of the row that contains the cell with the index `i`. Cells are counted
    /// row by row.
    fn row_of_cell(&self, i: u64) -> u64 {
        // The first value of `k` is an estimate that may be wrong by about one row. The loops
        // correct it.
        let mut k = (u128::from(i) * u128::from(self.rows) / u128::from(self.n)) as u64;
        while self.cells_above(k) > i {
            k -= 1;
        }
        while self.cells_above(k + 1) <= i {
            k += 1;
        }
        k
    }

    /// Returns the number of cells in the first `k` rows.
    fn cells_above(&self, k: u64) -> u64 {
        if 2 * k > self.rows {
            return self.n - self.cells_above(self.rows - k);
        }
        let half = self.rows / 2;
        // There are fewer than 2^27 rows, so nothing overflows. If there is only one row, `half`
        // and `k` are 0, and the divisor 1 avoids a division by 0.
        k * self.short + k * self.longer / half.max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_in_their_rows() {
        for n in (1..300).chain([(1 << 53) - 111, 1 << 53]) {
            let bricks = Bricks::new(n);
            for i in (0..n.min(300)).chain([n / 3, n / 2, n - 1]) {
                let (row, columns) = bricks.parts(i..i + 1).next().unwrap();
                assert_eq!(columns.start, i - row.first);
                assert_eq!(columns.end, columns.start + 1);
                assert!(columns.end <= row.cells);
            }
        }
        let bricks = Bricks::new(14);
        let parts: Vec<_> = bricks.parts(2..9).map(|(_, columns)| columns).collect();
        assert_eq!(parts, [2..3, 0..4, 0..2]);
        assert_eq!(bricks.parts(14..14).count(), 0);
    }
}
