//! `hammersley`: the points (i/n, φ₂(i)) of Hammersley (1960), randomly shifted in each pixel
//! (Cranley and Patterson 1976).
//!
//! φ₂(i) mirrors the binary digits of i at the binary point. A shifted point that leaves the pixel
//! enters it again on the other side. The shift along y is arbitrary. The shift along x moves
//! points by whole columns of width 1/n and then places them within their columns, so that each of
//! the n columns still contains exactly one point.

use std::ops::Range;

use super::{
    lattice::{self, Strata, Stratum},
    rng::{Key, scale},
};

/// A Hammersley set of n points, one in each of n columns. Small sets are stored.
#[derive(Debug)]
pub struct Hammersley {
    n: u64,
    columns: Strata,
    /// The pixel's n columns of width 1/n, from left to right, and then the same columns again. A
    /// slice of n columns can therefore start at any column. Empty if there are too many columns to
    /// be stored.
    turned: Vec<Stratum>,
    /// The coordinate y of each point before the shift, in units of 2^−64; empty if there are too
    /// many to be stored.
    heights: Vec<u64>,
}

impl Hammersley {
    /// Prepares a Hammersley set of `n` points.
    pub fn new(n: u64) -> Self {
        let columns = Strata::new(n);
        let stored = (0..n).take_while(|_| columns.stored().is_some());
        Self {
            heights: stored.map(|i| i.reverse_bits()).collect(),
            turned: columns.stored().unwrap_or_default().repeat(2),
            n,
            columns,
        }
    }

    /// Places the points whose indices are in `range`, after a random shift that `key` determines.
    /// Writes their offsets from the pixel's centre to the lists `x` and `y`.
    #[inline(always)]
    pub fn place(&self, key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
        let [columns, within, shift] = [0, 1, 2].map(|index| key.bits(index));
        let columns = scale(columns, self.n);
        if self.turned.is_empty() {
            for (i, (x, y)) in range.zip(x.iter_mut().zip(y)) {
                let column = i + columns;
                let column = column.checked_sub(self.n).unwrap_or(column);
                *x = self.columns.choose(column, within);
                *y = lattice::offset_of_bits(i.reverse_bits().wrapping_add(shift));
            }
            return;
        }
        let least = self.columns.least();
        let place = scale(within, least);
        // All points get the same position within their columns. A column has `least` or `least` +
        // 1 possible positions. In a column with `least` positions, the chosen one has the index
        // `place`. In a column with `least` + 1 positions, it has the index `place` + `more`, where
        // `more` is 0 or 1.
        let more = scale(within, least + 1) - place;
        let turned = &self.turned[(columns + range.start) as usize..];
        for (x, column) in x.iter_mut().zip(turned) {
            *x = lattice::offset(column.start() + place + (column.more() & more));
        }
        let heights = &self.heights[range.start as usize..];
        for (y, height) in y.iter_mut().zip(heights) {
            *y = lattice::offset_of_bits(height.wrapping_add(shift));
        }
    }
}
