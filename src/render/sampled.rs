//! A part of the picture with samples.

use std::sync::{Mutex, PoisonError, atomic::AtomicU64};

use rayon::prelude::*;

use super::{
    Control, RenderError, TILE, finished,
    frame::{Frame, Way},
    tally::Tally,
    wanted,
};
use crate::{
    area::Area,
    film::{self, Encoder, Film},
    sampling::Sampling,
    threads,
    tracer::{Quartering, Room, World},
};

/// A tile has about so many samples, where that takes fewer pixels.
const TILE_SAMPLES: u64 = 1 << 18;

/// And no tile is made so small that it has much fewer.
const LEAST_TILE_SAMPLES: u64 = 1 << 10;

/// Renders a part of the picture, which lies in it, with samples.
pub fn render(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film, RenderError> {
    render_in_a_way(world, sampling, part, control, Way::Culled)
}

/// The same as bytes of sRGB, of which a PNG file is made: the same file, and less memory to touch.
pub fn render_bytes(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film<[u8; 3]>, RenderError> {
    render_in_a_way(world, sampling, part, control, Way::Culled)
}

/// Renders, and says how many of the samples were traced: the others lie in pixels that are certain to show one colour.
pub fn render_and_count(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<(Film, u64), RenderError> {
    film_and_rays(world, sampling, part, control, Way::Culled)
}

/// Renders in a way of its own, for tests and measurements of how it is done, and films of either kind: bytes are made tile by tile, before the light
/// that they stand for has left the processor's cache.
pub fn render_in_a_way<P: film::Pixel>(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
    way: Way,
) -> Result<Film<P>, RenderError> {
    Ok(film_and_rays(world, sampling, part, control, way)?.0)
}

fn film_and_rays<P: film::Pixel>(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
    way: Way,
) -> Result<(Film<P>, u64), RenderError> {
    let film = Mutex::new(Film::new(part.width, part.height)?);
    let colors: Vec<_> = world
        .palette()
        .iter()
        .map(|color| color.to_linear())
        .collect();
    let encoder = Encoder::new();
    let shown: Vec<_> = colors.iter().map(|&light| P::of(light, &encoder)).collect();
    let frame = Frame {
        world,
        sampling,
        colors: &colors,
        shown: &shown,
        encoder: &encoder,
        control,
        way,
        rays: AtomicU64::new(0),
        quartering: Quartering::for_samples(world, sampling.mean_count()),
        everything: match way {
            Way::Culled | Way::OneByOne => Vec::new(),
            Way::Together | Way::Narrow => world.everything(),
        },
    };
    let side = tile_side(sampling, part);
    threads::install(control.threads, || {
        wanted(part.tiles(side), control)
            .par_bridge()
            .for_each_init(
                || (Tally::new(colors.len()), Room::default()),
                |(tally, room), tile| {
                    let Some(pixels) = frame.tile(tile, tally, room) else {
                        return;
                    };
                    let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
                    film.put(tile.within(part), &pixels);
                },
            );
    })?;
    Ok((finished(film, control)?, frame.rays.into_inner()))
}

/// The side of the tiles: smaller where pixels have many samples, or are few.
fn tile_side(sampling: &Sampling, part: Area) -> u32 {
    let samples = sampling.samples_per_pixel().max(1);
    let pixels = (TILE_SAMPLES / samples)
        .min(part.pixels() / 64)
        .max(LEAST_TILE_SAMPLES / samples)
        .max(1);
    // A square root of a number that fits; and a power of two, whose quarters are squares.
    let side = (pixels.isqrt() as u32).min(TILE);
    1 << side.ilog2()
}
