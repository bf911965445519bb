//! `regular`: the centres of equal cells.

use std::ops::Range;

use super::bricks::Bricks;

/// Writes the offsets of the points whose indices are in `range` to `x` and `y`: the centres of the
/// cells of [`Bricks`], row by row, the same in every pixel.
///
/// Point i of a row of n points lies at (2i + 1 − n)/(2n), rounded once, and its mirror image at
/// exactly the negative of that.
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

/// Of `n` equal parts of a pixel's side, returns the middle of the `parts` parts from index `first`
/// on, as an offset from the pixel's centre.
fn middle(first: u64, parts: u64, n: u64) -> f64 {
    // The magnitude of the numerator is at most 2^53, so only the division rounds.
    (2 * first as i64 + parts as i64 - n as i64) as f64 / (2 * n) as f64
}
