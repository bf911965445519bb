//! `regular`: the centres of equal cells.

use std::ops::Range;

use super::bricks::Bricks;

/// Places the points with these indices: the centres of the cells of [`Bricks`], row by row, in
/// every pixel the same.
///
/// Point i of a row of n lies at (2i + 1 − n)/(2n), rounded once, and its mirror image at exactly
/// the negative of that.
#[inline(always)]
pub fn place(bricks: &Bricks, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
    let mut points = x.iter_mut().zip(y);
    for (row, columns) in bricks.parts(range) {
        let height = middle(row.first, row.cells, bricks.cells());
        for (i, (x, y)) in columns.zip(&mut points) {
            (*x, *y) = (middle(i, 1, row.cells), height);
        }
    }
}

/// Returns the middle of the parts from `first` up to `first` + `parts` (exclusive) of `n` parts,
/// relative to the middle of all.
fn middle(first: u64, parts: u64, n: u64) -> f64 {
    // The magnitude of the numerator is at most 2^53, so only the division rounds.
    (2 * first as i64 + parts as i64 - n as i64) as f64 / (2 * n) as f64
}
