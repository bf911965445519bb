//! `random`: independent, uniform points. `scatter` places its points within a pixel in the same way.

use std::ops::Range;

use glam::DVec2;

use super::{hash::Key, lattice};

/// Appends the points with these indices.
pub fn points(key: Key, range: Range<u64>, out: &mut Vec<DVec2>) {
    out.extend(range.map(|i| {
        DVec2::new(
            lattice::offset_of_bits(key.bits(2 * i)),
            lattice::offset_of_bits(key.bits(2 * i + 1)),
        )
    }));
}
