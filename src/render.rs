//! A world and its samples become a film.
//!
//! In: the prepared scene, where the samples lie, and which part of the picture is wanted. Out: the means of its pixels. The part is
//! cut into tiles, which the threads take as they come. A pixel's samples are counted by colour, and counts know no order: neither the
//! number of threads nor the tiles nor the part asked for can change a bit of a pixel.

use std::{
    num::NonZero,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use glam::DVec2;
use rayon::{ThreadPool, ThreadPoolBuilder, prelude::*};
use thiserror::Error;

use crate::{
    area::Area,
    exact::Integrator,
    film::{Film, TooLarge, mean},
    sampling::Sampling,
    tracer::World,
};

/// The side of the largest tiles: enough pixels that handing out a tile costs nothing, and few enough that the threads end together.
const TILE: u32 = 64;

/// A tile has about so many samples, where that takes fewer pixels.
const TILE_SAMPLES: u64 = 1 << 17;

/// A pixel's samples are taken so many at a time; a pixel with more is shared by the threads.
const CHUNK: u64 = 1 << 12;

/// More threads than this are not started, whatever is asked for: no machine has as many processors for one picture.
const THREADS: usize = 1024;

/// How a render is watched, and by how many it is done.
pub struct Control<'a> {
    /// How many threads; as many as there are processors if this is `None`.
    pub threads: Option<NonZero<usize>>,
    /// Is told, from any thread, how many more samples are done, or how many more exact pixels.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// Ends the render soon after it is set.
    pub cancel: &'a AtomicBool,
}

/// Why there is no picture.
#[derive(Debug, Error)]
pub enum RenderError {
    /// There is no memory for it.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// The system starts no threads.
    #[error("cannot start threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// It was not wanted any more.
    #[error("interrupted")]
    Cancelled,
}

/// A computed picture, and how far it may be from the true one.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact {
    /// Its means.
    pub film: Film,
    /// For each pixel, row by row, how far each channel may be from the true mean.
    pub bounds: Vec<f32>,
}

impl Exact {
    /// The greatest of the bounds.
    pub fn bound(&self) -> f64 {
        f64::from(self.bounds.iter().copied().fold(0.0, f32::max))
    }
}

/// Renders a part of the picture, which lies in it, with samples.
pub fn render(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film, RenderError> {
    let film = Mutex::new(Film::new(part.width, part.height)?);
    let colors: Vec<_> = world
        .palette()
        .iter()
        .map(|color| color.to_linear())
        .collect();
    let frame = Frame {
        world,
        sampling,
        colors: &colors,
        control,
    };
    let side = tile_side(sampling, part);
    pool(control.threads)?.install(|| {
        part.tiles(side).par_bridge().for_each_init(
            || Tally::new(colors.len()),
            |tally, tile| {
                let Some(pixels) = frame.tile(tile, tally) else {
                    return;
                };
                let mut film = film.lock().unwrap_or_else(PoisonError::into_inner);
                film.put(tile.within(part), &pixels);
            },
        );
    });
    finished(film, control)
}

/// Computes a part of the picture, which lies in it, without samples; progress counts pixels.
pub fn render_exact(world: &World, part: Area, control: &Control) -> Result<Exact, RenderError> {
    let film = Film::new(part.width, part.height)?;
    let bounds = vec![0f32; part.pixels() as usize];
    let exact = Mutex::new(Exact { film, bounds });
    let integrator = Integrator::new(world);
    pool(control.threads)?.install(|| {
        part.tiles(TILE).par_bridge().for_each(|tile| {
            let Some(pixels) = integrator.pixels(tile, control.cancel) else {
                return;
            };
            let means: Vec<_> = pixels.iter().map(|pixel| pixel.mean).collect();
            let mut exact = exact.lock().unwrap_or_else(PoisonError::into_inner);
            exact.film.put(tile.within(part), &means);
            for ((x, y), pixel) in tile.iter().zip(&pixels) {
                exact.bounds[part.index(x, y)] = match pixel.bound {
                    0.0 => 0.0,
                    // Rounded up; light is from 0 to 1.
                    bound => (bound as f32).next_up().min(1.0),
                };
            }
            (control.progress)(tile.pixels());
        });
    });
    finished(exact, control)
}

/// What was made, if it was wanted to the end.
fn finished<T>(made: Mutex<T>, control: &Control) -> Result<T, RenderError> {
    if control.cancel.load(Ordering::Relaxed) {
        return Err(RenderError::Cancelled);
    }
    Ok(made.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// So many threads, or as many as there are processors.
pub(crate) fn pool(
    threads: Option<NonZero<usize>>,
) -> Result<ThreadPool, rayon::ThreadPoolBuildError> {
    // Rayon takes 0 for as many as there are processors.
    let threads = threads.map_or(0, |threads| threads.get().min(THREADS));
    ThreadPoolBuilder::new().num_threads(threads).build()
}

/// The side of the tiles: smaller where pixels have many samples, or are few.
fn tile_side(sampling: &Sampling, part: Area) -> u32 {
    let samples = sampling.samples_per_pixel().max(1);
    let pixels = (TILE_SAMPLES / samples).min(part.pixels() / 64).max(1);
    // A square root of a number that fits.
    (pixels.isqrt() as u32).min(TILE)
}

/// What all tiles have in common.
struct Frame<'a> {
    world: &'a World,
    sampling: &'a Sampling,
    /// Of the palette, in linear light.
    colors: &'a [[f64; 3]],
    control: &'a Control<'a>,
}

impl Frame<'_> {
    /// The pixels of a tile, row by row; none once the render is cancelled.
    fn tile(&self, tile: Area, tally: &mut Tally) -> Option<Vec<[f64; 3]>> {
        let counts = self.sampling.counts(tile);
        let mut unreported = 0;
        let mut pixels = Vec::with_capacity(counts.len());
        for ((x, y), samples) in tile.iter().zip(counts) {
            if self.control.cancel.load(Ordering::Relaxed) {
                return None;
            }
            if samples <= CHUNK {
                self.chunk(x, y, samples, 0, tally);
                unreported += samples;
            } else {
                self.many(x, y, samples, tally);
            }
            pixels.push(self.finish(tally));
        }
        (self.control.progress)(unreported);
        Some(pixels)
    }

    /// All samples of a pixel that has many, on all threads.
    fn many(&self, x: u32, y: u32, samples: u64, tally: &mut Tally) {
        // A few thousand chunks at a time, so that what is gathered from the threads stays small.
        const BATCH: u64 = CHUNK << 10;
        let mut first = 0;
        while first < samples && !self.control.cancel.load(Ordering::Relaxed) {
            let end = samples.min(first.saturating_add(BATCH));
            let chunks = (end - first).div_ceil(CHUNK);
            let slots = self.colors.len();
            let sums = (0..chunks)
                .into_par_iter()
                .fold(
                    || Tally::new(slots),
                    |mut tally, chunk| {
                        if !self.control.cancel.load(Ordering::Relaxed) {
                            self.chunk(x, y, samples, first + chunk * CHUNK, &mut tally);
                        }
                        tally
                    },
                )
                .reduce(
                    || Tally::new(0),
                    |a, b| if a.seen.is_empty() { b } else { a.plus(&b) },
                );
            for &slot in &sums.seen {
                tally.add(slot, sums.counts[slot]);
            }
            (self.control.progress)(end - first);
            first = end;
        }
    }

    /// Counts up to [`CHUNK`] samples of a pixel that has `samples`, from the one with index `first` on.
    fn chunk(&self, x: u32, y: u32, samples: u64, first: u64, tally: &mut Tally) {
        let end = samples.min(first + CHUNK);
        let mut points = std::mem::take(&mut tally.points);
        points.clear();
        self.sampling.points(x, y, samples, first..end, &mut points);
        for &offset in &points {
            tally.add(self.world.slot_at(x, y, offset), 1);
        }
        tally.points = points;
    }

    /// The mean of what was counted, which is forgotten. A pixel without a sample shows the background.
    fn finish(&self, tally: &mut Tally) -> [f64; 3] {
        let color = match tally.seen.as_mut_slice() {
            [] => *self.colors.last().unwrap_or(&[0.0; 3]),
            [slot] => self.colors[*slot],
            slots => {
                slots.sort_unstable();
                mean(
                    slots
                        .iter()
                        .map(|&slot| (tally.counts[slot], self.colors[slot])),
                )
            }
        };
        tally.clear();
        color
    }
}

/// How often each colour was seen in a pixel.
struct Tally {
    /// By slot of the palette.
    counts: Vec<u64>,
    /// The slots whose count is not 0, in any order. A palette may be long, and a pixel sees little of it.
    seen: Vec<usize>,
    /// Room for the points.
    points: Vec<DVec2>,
}

impl Tally {
    fn new(slots: usize) -> Self {
        Self {
            counts: vec![0; slots],
            seen: Vec::new(),
            points: Vec::new(),
        }
    }

    fn add(&mut self, slot: usize, count: u64) {
        if self.counts[slot] == 0 {
            self.seen.push(slot);
        }
        self.counts[slot] += count;
    }

    fn plus(mut self, other: &Self) -> Self {
        for &slot in &other.seen {
            self.add(slot, other.counts[slot]);
        }
        self
    }

    fn clear(&mut self) {
        for slot in self.seen.drain(..) {
            self.counts[slot] = 0;
        }
    }
}
