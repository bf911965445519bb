//! `hammersley`: the points (i/n, φ₂(i)), shifted per pixel (Hammersley 1960; Cranley and Patterson 1976 for the shift).
//!
//! φ₂ is the radical inverse in base 2. The shift wraps around at the pixel's edge. In x it is a whole number of strata and a place
//! within a stratum, so that each of the n columns holds exactly one point, as before the shift; in y it is any.

use std::ops::Range;

use glam::DVec2;

use super::{
    hash::{self, Key},
    lattice::{self, Strata},
};

/// The columns.
#[derive(Debug)]
pub struct Hammersley {
    n: u64,
    columns: Strata,
}

impl Hammersley {
    /// The points of a set of `n`.
    pub fn new(n: u64) -> Self {
        Self {
            n,
            columns: Strata::new(n),
        }
    }

    /// Appends the points with these indices.
    pub fn points(&self, key: Key, range: Range<u64>, out: &mut Vec<DVec2>) {
        let [columns, within, shift] = [0, 1, 2].map(|index| key.bits(index));
        let columns = hash::scale(columns, self.n);
        out.extend(range.map(|i| {
            let to_the_edge = self.n - columns;
            let column = if i < to_the_edge {
                i + columns
            } else {
                i - to_the_edge
            };
            DVec2::new(
                self.columns.choose(column, within),
                lattice::offset_of_bits(i.reverse_bits().wrapping_add(shift)),
            )
        }));
    }
}
