//! A part of the picture with samples.
//!
//! In: the world, the sampling and the part. Out: its means, as light or as bytes. The part is cut
//! into tiles for the threads; `renderer` makes each.

use std::sync::{Mutex, PoisonError};

use super::{Control, RenderError, finished, renderer::Renderer, tally::Tally, wanted};
use crate::{
    area::Area,
    film::{self, Encoder, Film},
    sampling::Sampling,
    threads::{self, prelude::*},
    tracer::{GRID, Quartering, Scratch, World},
};

/// A tile has about so many samples, a few milliseconds' work: no thread waits longer for the
/// others at the end.
const TILE_SAMPLES: u64 = 1 << 18;

/// Renders a part of the picture, which lies in it, with samples.
pub fn render(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film, RenderError> {
    render_as(world, sampling, part, control)
}

pub(super) fn render_as<P: film::Pixel>(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film<P>, RenderError> {
    let film = Mutex::new(Film::new(part.width, part.height)?);
    let colors: Vec<_> = world
        .palette()
        .iter()
        .map(|color| color.to_linear())
        .collect();
    let encoder = Encoder::default();
    let shown: Vec<_> = colors.iter().map(|&light| P::of(light, &encoder)).collect();
    let renderer = Renderer {
        world,
        sampling,
        colors: &colors,
        shown: &shown,
        encoder: &encoder,
        control,
        quartering: Quartering::for_samples(world, sampling.mean_count()),
    };
    let side = tile_side(sampling);
    threads::install(control.threads, || {
        wanted(part, side, control).par_bridge().for_each_init(
            || (Tally::new(colors.len()), Scratch::default()),
            |(tally, scratch), tile| {
                let Some(pixels) = renderer.tile(tile, tally, scratch) else {
                    return;
                };
                let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
                film.put(tile.within(part), &pixels);
            },
        );
    })?;
    finished(film, control)
}

/// The side of the tiles: smaller where pixels have many samples.
fn tile_side(sampling: &Sampling) -> u32 {
    let pixels = TILE_SAMPLES / sampling.samples_per_pixel().max(1);
    // A square root of a number that fits; and a power of two, so that no tile crosses a line of
    // the grid.
    let side = (pixels.isqrt() as u32).clamp(1, GRID);
    1 << side.ilog2()
}
