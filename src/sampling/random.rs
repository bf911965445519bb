//! `random`: independent points, uniform in the pixel. The method `scatter` also places points
//! within a pixel in this way.

use std::ops::Range;

use super::{lattice, rng::Key};

/// Places the points whose indices are in `range`. Writes their offsets from the pixel's centre to
/// the lists `x` and `y`.
#[inline(always)]
pub fn place(key: Key, range: Range<u64>, [x, y]: [&mut [f64]; 2]) {
    for (i, (x, y)) in (range.start..).zip(x.iter_mut().zip(y)) {
        *x = lattice::offset_of_bits(key.bits(2 * i));
        *y = lattice::offset_of_bits(key.bits(2 * i + 1));
    }
}
