//! `random`: independent, uniform points. `scatter` places its points within a pixel in the same way.

use std::ops::Range;

use glam::DVec2;

use super::{hash::Key, lattice};
use crate::math::Vectors;

/// Appends the points with these indices.
pub fn points(key: Key, range: Range<u64>, vectors: Vectors, out: &mut Vec<DVec2>) {
    key.pairs(range, vectors, |_, pairs| {
        out.extend(
            pairs
                .iter()
                .map(|bits| DVec2::from(bits.map(lattice::offset_of_bits))),
        );
    });
}
