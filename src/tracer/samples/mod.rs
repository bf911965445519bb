//! Many samples of one pixel at once.
//!
//! In: a pixel, its candidates, and where its samples lie. Out: how often each colour is seen.
//!
//! In a pixel every boundary is a linear or a quadratic form of the offset from the pixel's centre,
//! and each has one bound on the error of all its values there. So the objects that may be seen in
//! the pixel are written down as a few forms, those that have one sign all over it are left out,
//! and what is left is evaluated for all samples in plain arrays, which the compiler makes vectors
//! of. A form is divided by its error bound: beyond ±1 its sign is certain. A sample that is not
//! certain is asked for again on its own, exactly, so that nothing here can change what is seen: it
//! only says it sooner.

mod pixel;
mod prepare;
mod simd;

use glam::DVec2;

use self::pixel::{BACKGROUND, CHUNK_SAMPLES, ColorCount, DOUBT, Pattern};
use super::{candidates::Candidate, checker_corners::Checks, world::World};
use crate::math::SimdWidth;

pub use self::pixel::PreparedPixel;

/// Prepares a pixel, given the objects that may be seen there, in file order, and, if they are but
/// a board and that is known, what is seen of it.
pub fn prepare(
    world: &World,
    [x, y]: [u32; 2],
    candidates: &[Candidate],
    checks: Option<&Checks>,
    pixel: &mut PreparedPixel,
) {
    (pixel.x, pixel.y) = (x, y);
    pixel.candidates.clear();
    match candidates {
        // Most often, and then without a call to copy it.
        [only] => pixel.candidates.push(*only),
        _ => pixel.candidates.extend_from_slice(candidates),
    }
    let prepared = match checks {
        Some(checks) => pixel.prepare_checks(checks),
        None => pixel.prepare(world),
    };
    pixel.is_hard = prepared.is_err();
}

/// Counts what the samples at some offsets from the centre of a pixel see: `count` is told slots of
/// the palette, each any number of times. The coordinates of the offsets are two lists, filled up
/// with any others to a multiple of eight.
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
        world.slot_among(pixel.x, pixel.y, offset, objects)
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
            count(color.slot, color.count);
        }
    }
}

/// Lists the colours that may be seen in a pixel.
fn may_see(world: &World, pixel: &mut PreparedPixel) {
    let color = |code: f64, slot: usize| ColorCount {
        code,
        slot,
        count: 0,
    };
    pixel.colors.clear();
    for surface in &pixel.surfaces {
        let [first, second] = world.slots(pixel.candidates[surface.index].object);
        let codes = [false, true].map(|odd| surface.code(odd));
        match surface.pattern {
            Pattern::Plain(code) if code == codes[1] => pixel.colors.push(color(code, second)),
            Pattern::Plain(code) => pixel.colors.push(color(code, first)),
            _ => pixel
                .colors
                .extend([color(codes[0], first), color(codes[1], second)]),
        }
    }
    pixel.colors.push(color(BACKGROUND, world.background()));
}
