//! Renders a part of the picture with samples.
//!
//! In: the prepared scene, the positions of the samples, and the part. Out: the colours of the
//! part's pixels, in linear light or as bytes of sRGB. The part is divided into tiles (squares),
//! which several threads render. `renderer` renders each tile.

use std::sync::Mutex;

use super::{
    Control, RenderError, check_part, finished, renderer::Renderer, tally::PixelTally, tiles,
};
use crate::{
    area::Area,
    film::{self, Encoder, Film},
    lock::lock,
    sampling::Sampling,
    threads,
    tracer::{GRID, Quartering, Scratch, World},
};

/// Approximate number of samples in a tile, i.e. in a square that one thread renders at a time.
/// Tracing a tile takes a few milliseconds, so all threads end at about the same time. Much smaller
/// tiles would cause more overhead.
const TILE_SAMPLES: u64 = 1 << 18;

/// Renders a part of the picture with samples. `sampling` must not specify the exact sampler.
pub(super) fn render_as<P: film::Pixel>(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film<P>, RenderError> {
    check_part(part, world.picture())?;
    let film = Mutex::new(Film::new(part.width, part.height)?);
    let colors = world.palette().iter();
    let colors: Vec<_> = colors.map(|color| color.to_linear()).collect();
    let encoder = Encoder::shared();
    let shown: Vec<_> = colors.iter().map(|&light| P::of(light, encoder)).collect();
    let renderer = Renderer {
        world,
        sampling,
        colors: &colors,
        shown: &shown,
        encoder,
        control,
        quartering: Quartering::for_samples(world, sampling.mean_count()),
    };
    let side = tile_side(sampling);
    threads::for_each(
        control.threads,
        tiles(part, side, control),
        || (PixelTally::new(colors.len()), Scratch::default()),
        |(tally, scratch), tile| {
            if let Some(pixels) = renderer.tile(tile, tally, scratch) {
                lock(&film).put(tile.within(part), &pixels);
            }
        },
    )?;
    finished(film, control)
}

/// Returns the side of the tiles (squares that a thread renders at a time), in pixels. It is a
/// power of two, and smaller if pixels have more samples.
fn tile_side(sampling: &Sampling) -> u32 {
    let pixels = TILE_SAMPLES / sampling.samples_per_pixel().max(1);
    // The quotient is at most 2^18, so its root fits into 32 bits. The tracer first divides the
    // picture into squares of the side `GRID`, a power of two. The side of a tile is a power of two
    // up to `GRID`, so no tile crosses a border of these squares.
    let side = (pixels.isqrt() as u32).clamp(1, GRID);
    1 << side.ilog2()
}
