//! `random`: independent, uniform points. `scatter` also places its points within a pixel so.

use std::ops::Range;

use super::{lattice, rng::Key};

/// Places the points with these indices.
#[inline(always)]
pub fn place(key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
    for (i, (x, y)) in (range.start..).zip(x.iter_mut().zip(y)) {
        *x = lattice::offset_of_bits(key.bits(2 * i));
        *y = lattice::offset_of_bits(key.bits(2 * i + 1));
    }
}
