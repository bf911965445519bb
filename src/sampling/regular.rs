//! `regular`: the centres of cells of equal area.

use std::ops::Range;

use super::bricks::Bricks;

/// Places the points whose indices are in `range`. Writes their offsets from the pixel's centre to
/// the lists `x` and `y`. The points are the centres of the cells of [`Bricks`], row by row, and
/// are the same in all pixels.
///
/// Point i in a row of n points has x = (2i + 1 − n)/(2n), rounded once. Its mirror image in the
/// row has exactly −x.
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

/// Returns the middle of an interval of a pixel's side, as an offset from the pixel's centre. The
/// side is divided into `n` equal parts. The interval consists of `parts` of them and begins with
/// the part with the index `first`.
fn middle(first: u64, parts: u64, n: u64) -> f64 {
    // The numerator is at most 2^53, so it is exact, and only the division rounds.
    (2 * first as i64 + parts as i64 - n as i64) as f64 / (2 * n) as f64
}
