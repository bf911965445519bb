//! Many samples of one pixel at once.
//!
//! In: a pixel, its candidates, and the positions of its samples. Out: how often each colour is
//! seen.
//!
//! In a pixel, every boundary is a linear or a quadratic form of the offset from the pixel's
//! centre, with one error bound for all its values in the pixel. The objects that may be seen in
//! the pixel are therefore described by a few forms. Forms with one sign in the whole pixel are
//! left out. The others are evaluated for all samples in plain arrays, which the compiler
//! vectorizes. A form is divided by its error bound, so that its sign is certain where its value is
//! above 1 or below −1. An uncertain sample is traced again on its own, exactly. This module
//! therefore saves time without changing what is seen.

mod pixel;
mod prepare;
mod simd;

use glam::DVec2;

use self::pixel::{BACKGROUND, CHUNK_SAMPLES, ColorCount, ColorPattern, DOUBT};
use super::{candidates::VisibilityCandidate, checker_corners::CheckerPixel, world::World};
use crate::math::SimdWidth;

pub use self::pixel::PreparedPixel;

/// Prepares `pixel` for the pixel in column `x` and row `y`. `candidates` are the objects that may
/// be seen in it, in file order. `checks` are the squares that the pixel shows, if it shows only
/// one checkerboard and the squares could be determined. Sets `is_hard` if the samples must be
/// traced one by one.
pub fn prepare(
    world: &World,
    [x, y]: [u32; 2],
    candidates: &[VisibilityCandidate],
    checks: Option<&CheckerPixel>,
    pixel: &mut PreparedPixel,
) {
    (pixel.x, pixel.y) = (x, y);
    pixel.candidates.clear();
    match candidates {
        // A pixel with a single candidate is the most frequent case. `push` is used for it, because
        // it is faster than the function that copies a slice.
        [only] => pixel.candidates.push(*only),
        _ => pixel.candidates.extend_from_slice(candidates),
    }
    let prepared = match checks {
        Some(checks) => pixel.prepare_checks(checks),
        None => pixel.prepare(world),
    };
    pixel.is_hard = prepared.is_err();
}

/// Calls `count` with the palette index of every colour that the samples of a pixel see, and with
/// the number of samples that see it. For one colour, there can be several calls. `x` and `y` are
/// the samples' offsets from the pixel's centre. Only their first `samples` entries are samples.
/// The entries after these pad the length to a multiple of eight.
pub fn count(
    world: &World,
    pixel: &mut PreparedPixel,
    [x, y]: [&[f64]; 2],
    samples: usize,
    vectors: SimdWidth,
    mut count: impl FnMut(usize, u64),
) {
    let alone = |pixel: &PreparedPixel, index: usize| {
        let offset = DVec2::new(x[index], y[index]);
        let objects = pixel.candidates.iter().map(|candidate| candidate.object);
        world.color_index_among(pixel.x, pixel.y, offset, objects)
    };
    if pixel.is_hard {
        (0..samples).for_each(|index| count(alone(pixel, index), 1));
        return;
    }
    may_see(world, pixel);
    let chunks = x.chunks(CHUNK_SAMPLES).zip(y.chunks(CHUNK_SAMPLES));
    for (first, (x, y)) in (0..samples).step_by(CHUNK_SAMPLES).zip(chunks) {
        let length = CHUNK_SAMPLES.min(samples - first);
        pixel.chunk([x, y], length, vectors);
        if pixel.doubts > 0 {
            for index in 0..length {
                if pixel.lanes.seen[index] == DOUBT {
                    count(alone(pixel, first + index), 1);
                }
            }
        }
    }
    for color in &pixel.colors {
        if color.count > 0 {
            count(color.color_index, color.count);
        }
    }
}

/// Replaces the pixel's list of colours by those that may be seen in the pixel, each with the count
/// 0.
fn may_see(world: &World, pixel: &mut PreparedPixel) {
    let color = |code: f64, color_index: usize| ColorCount {
        code,
        color_index,
        count: 0,
    };
    pixel.colors.clear();
    for surface in &pixel.surfaces {
        let [first, second] = world.color_indices(pixel.candidates[surface.index].object);
        let codes = [false, true].map(|odd| surface.code(odd));
        match surface.pattern {
            ColorPattern::Plain(code) if code == codes[1] => pixel.colors.push(color(code, second)),
            ColorPattern::Plain(code) => pixel.colors.push(color(code, first)),
            _ => pixel
                .colors
                .extend([color(codes[0], first), color(codes[1], second)]),
        }
    }
    pixel.colors.push(color(BACKGROUND, world.background()));
}
