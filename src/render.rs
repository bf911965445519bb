//! A world and its samples become a film.
//!
//! In: the prepared scene, where the samples lie, and which part of the picture is wanted. Out: the means of its pixels. The part is
//! cut into tiles, which the threads take as they come. A pixel's samples are counted by colour, and counts know no order: neither the
//! number of threads nor the tiles nor the part asked for can change a bit of a pixel.
//!
//! Where it is certain that one colour is seen, samples are neither placed nor traced: the mean of equal colours is that colour. In the
//! other pixels they are traced many at a time, and against those objects alone that may be seen there; or one by one, where to know more
//! would cost more.

mod tally;
mod tile;

use std::{
    num::NonZero,
    ops::ControlFlow,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use rayon::prelude::*;
use thiserror::Error;

use self::{
    tally::{Counts, Tally},
    tile::{Samples, Tile},
};
use crate::{
    area::Area,
    cancel::Cancelled,
    exact::{self, Integrator},
    film::{self, Encoder, Film, TooLarge},
    math::Vectors,
    sampling::Sampling,
    threads,
    tracer::{Among, Checks, Item, Live, Part, Pixel, Quartering, Room, World},
};

/// The side of the largest tiles: enough pixels that handing out a tile costs nothing, and few enough that the threads end together.
const TILE: u32 = 64;

/// A tile has about so many samples, where that takes fewer pixels.
const TILE_SAMPLES: u64 = 1 << 18;

/// And no tile is made so small that it has much fewer.
const FEW_SAMPLES: u64 = 1 << 10;

/// Fewer samples than these are placed and looked at by the vectors that every processor has.
const FEW: u64 = 8;

/// A pixel's samples are taken so many at a time; a pixel with more is shared by the threads.
const CHUNK: u64 = 1 << 12;

/// How a render is watched, and by how many it is done.
pub struct Control<'a> {
    /// How many threads; as many as there are processors if this is `None`.
    pub threads: Option<NonZero<usize>>,
    /// Is told, from any thread, how many more samples are done, or how many more exact pixels.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// Ends the render soon after it is set.
    pub cancel: &'a AtomicBool,
}

/// How samples are traced. All ways make the same picture, to the bit: the slower ones are there to be compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// None where one colour is certain, else many at a time, against what may be seen in their pixel, or one by one where to know that would
    /// cost more.
    Culled,
    /// All of them, many at a time, against all objects.
    Together,
    /// The same by vectors that every processor of the kind has.
    Narrow,
    /// All of them, one by one, against the objects that the hierarchy knows on their way.
    OneByOne,
}

impl Way {
    /// What its loops are made of.
    fn vectors(self) -> Vectors {
        match self {
            Self::Culled | Self::Together => Vectors::Widest,
            Self::Narrow | Self::OneByOne => Vectors::Baseline,
        }
    }
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

impl From<Cancelled> for RenderError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A computed picture, and how far it may be from the true one.
#[derive(Clone, Debug, PartialEq)]
pub struct Exact<P = [f64; 3]> {
    /// Its means, or their bytes.
    pub film: Film<P>,
    /// For each pixel, row by row, how far each channel of its mean may be from the true one.
    pub bounds: Vec<f32>,
    /// How many pixels of the film are certain to be those of the true means: of light, those without any error.
    pub certain: u64,
}

impl<P> Exact<P> {
    /// The greatest of the bounds.
    pub fn bound(&self) -> f64 {
        f64::from(self.bounds.iter().copied().fold(0.0, f32::max))
    }

    /// The root of the mean of their squares, which is no less than the root of the mean squared error of all pixels and channels.
    pub fn root_mean_square_bound(&self) -> f64 {
        let squares = self
            .bounds
            .iter()
            .map(|&bound| f64::from(bound) * f64::from(bound));
        (squares.sum::<f64>() / self.bounds.len().max(1) as f64).sqrt()
    }
}

/// Renders a part of the picture, which lies in it, with samples.
pub fn render(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film, RenderError> {
    render_in_a_way(world, sampling, part, control, Way::Culled)
}

/// The same, for tests and measurements of how it is done, and for films of either kind: bytes are made tile by tile, before the light
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

/// Renders, and says how many of the samples were traced: the others lie in pixels that are certain to show one colour.
pub fn render_and_count(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<(Film, u64), RenderError> {
    film_and_rays(world, sampling, part, control, Way::Culled)
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

/// The same as bytes of sRGB, of which a PNG file is made: the same file, and less memory to touch.
pub fn render_bytes(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film<[u8; 3]>, RenderError> {
    render_in_a_way(world, sampling, part, control, Way::Culled)
}

/// Computes a part of the picture, which lies in it, without samples; progress counts pixels.
pub fn render_exact(world: &World, part: Area, control: &Control) -> Result<Exact, RenderError> {
    render_exact_as(world, part, control)
}

/// The same as bytes of sRGB, of which a PNG file is made: the same file, and less memory to touch.
pub fn render_exact_bytes(
    world: &World,
    part: Area,
    control: &Control,
) -> Result<Exact<[u8; 3]>, RenderError> {
    render_exact_as(world, part, control)
}

fn render_exact_as<P: film::Pixel>(
    world: &World,
    part: Area,
    control: &Control,
) -> Result<Exact<P>, RenderError> {
    let exact = Mutex::new(Exact {
        film: Film::new(part.width, part.height)?,
        bounds: vec![0f32; part.pixels() as usize],
        certain: 0,
    });
    let integrator = Integrator::new(world);
    let encoder = Encoder::new();
    threads::install(control.threads, || {
        wanted(part.tiles(TILE), control)
            .par_bridge()
            .for_each(|tile| {
                let Some(pixels) = integrator.pixels(tile, control.cancel) else {
                    return;
                };
                let bounds: Vec<f32> = pixels
                    .iter()
                    .map(|pixel| match pixel.bound {
                        0.0 => 0.0,
                        // Rounded up; light is from 0 to 1.
                        bound => (bound as f32).next_up().min(1.0),
                    })
                    .collect();
                // Most pixels are as the one before.
                let (mut before, mut last) = ([0.0; 3], P::of([0.0; 3], &encoder));
                let means: Vec<P> = pixels
                    .iter()
                    .map(|pixel| {
                        if pixel.mean != before {
                            (before, last) = (pixel.mean, P::of(pixel.mean, &encoder));
                        }
                        last
                    })
                    .collect();
                let is_certain = |(pixel, bound): &(&exact::Pixel, &f32)| {
                    P::is_certain(pixel.mean, f64::from(**bound), &encoder)
                };
                let certain = pixels.iter().zip(&bounds).filter(is_certain).count();
                let mut exact = exact.lock().unwrap_or_else(PoisonError::into_inner);
                exact.film.put(tile.within(part), &means);
                let rows = bounds.chunks_exact(tile.width as usize);
                for (y, row) in (tile.y..).zip(rows) {
                    let start = part.index(tile.x, y);
                    exact.bounds[start..start + row.len()].copy_from_slice(row);
                }
                exact.certain += certain as u64;
                drop(exact);
                (control.progress)(tile.pixels());
            });
    })?;
    finished(exact, control)
}

/// Tiles as long as they are wanted: to hand out millions that nobody renders would take a second.
fn wanted(
    tiles: impl Iterator<Item = Area> + Send,
    control: &Control,
) -> impl Iterator<Item = Area> + Send {
    tiles.take_while(|_| !control.cancel.load(Ordering::Relaxed))
}

/// What was made, if it was wanted to the end.
fn finished<T>(made: Mutex<T>, control: &Control) -> Result<T, RenderError> {
    if control.cancel.load(Ordering::Relaxed) {
        return Err(RenderError::Cancelled);
    }
    Ok(made.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// The side of the tiles: smaller where pixels have many samples, or are few.
fn tile_side(sampling: &Sampling, part: Area) -> u32 {
    let samples = sampling.samples_per_pixel().max(1);
    let pixels = (TILE_SAMPLES / samples)
        .min(part.pixels() / 64)
        .max(FEW_SAMPLES / samples)
        .max(1);
    // A square root of a number that fits; and a power of two, whose quarters are squares.
    let side = (pixels.isqrt() as u32).min(TILE);
    1 << side.ilog2()
}

/// What all tiles have in common.
struct Frame<'a, P> {
    world: &'a World,
    sampling: &'a Sampling,
    /// Of the palette, in linear light.
    colors: &'a [[f64; 3]],
    /// The same as the film has them.
    shown: &'a [P],
    encoder: &'a Encoder,
    control: &'a Control<'a>,
    way: Way,
    /// How many samples were traced.
    rays: AtomicU64,
    quartering: Quartering<'a>,
    /// All objects, for the ways that ask all of them.
    everything: Vec<Live>,
}

impl<P: film::Pixel> Frame<'_, P> {
    /// The pixels of a tile, row by row; none once the render is cancelled.
    fn tile(&self, tile: Area, tally: &mut Tally<P>, room: &mut Room) -> Option<Vec<P>> {
        let background = self.shown[self.world.background()];
        let mut film = Tile {
            area: tile,
            samples: match self.sampling.same_count() {
                Some(count) => Samples::Same(count),
                None => Samples::Each(self.sampling.counts(tile)),
            },
            // A pixel without a sample shows the background.
            pixels: vec![background; tile.pixels() as usize],
            unreported: 0,
            rays: 0,
        };
        let mut visit = |part: Part, checks: Option<&Checks>| match part {
            Part::Flat { area, slot } => {
                film.fill(area, self.shown[slot]);
                self.go_on()
            }
            Part::Open { x, y, live } => {
                self.pixel([x, y], Trace::Together(live, checks), &mut film, tally)
            }
            Part::Plain { area, among } => {
                let trace = match among {
                    Among::All => Trace::OneByOne,
                    Among::Crowd(crowd) => Trace::InCrowd(crowd),
                    Among::Live(live) => Trace::Among(live),
                };
                let mut pixels = area.iter();
                pixels.try_for_each(|(x, y)| self.pixel([x, y], trace, &mut film, tally))
            }
        };
        let flow = match self.way {
            Way::Culled => self.quartering.parts_and_checks(tile, room, &mut visit),
            Way::Together | Way::Narrow => tile.iter().try_for_each(|(x, y)| {
                let live = &self.everything;
                visit(Part::Open { x, y, live }, None)
            }),
            Way::OneByOne => visit(
                Part::Plain {
                    area: tile,
                    among: Among::All,
                },
                None,
            ),
        };
        (self.control.progress)(film.unreported);
        self.rays.fetch_add(film.rays, Ordering::Relaxed);
        flow.is_continue().then_some(film.pixels)
    }

    /// Whether anybody wants to see more.
    fn go_on(&self) -> ControlFlow<()> {
        match self.control.cancel.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }

    /// Takes the samples of a pixel.
    fn pixel(
        &self,
        [x, y]: [u32; 2],
        trace: Trace,
        film: &mut Tile<P>,
        tally: &mut Tally<P>,
    ) -> ControlFlow<()> {
        let index = film.area.index(x, y);
        let samples = film.samples.of(index);
        if samples == 0 {
            return self.go_on();
        }
        let trace = match trace {
            // To prepare the pixel would take longer.
            Trace::Together(live, _) if samples == 1 => Trace::Among(live),
            _ => trace,
        };
        film.rays += samples;
        if samples <= CHUNK {
            self.look([x, y], trace, &mut tally.pixel);
            self.chunk(x, y, samples, 0, trace, tally);
            film.unreported += samples;
        } else {
            self.many(x, y, samples, trace, tally);
        }
        let Tally { counts, means, .. } = tally;
        film.pixels[index] = means.take(counts, self.colors, self.encoder);
        self.go_on()
    }

    /// Prepares a pixel, where samples are traced together.
    fn look(&self, at: [u32; 2], trace: Trace, pixel: &mut Pixel) {
        if let Trace::Together(live, checks) = trace {
            self.world.look(at, live, checks, pixel);
        }
    }

    /// All samples of a pixel that has many, on all threads.
    fn many(&self, x: u32, y: u32, samples: u64, trace: Trace, tally: &mut Tally<P>) {
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
                    || {
                        let mut tally = Tally::<P>::new(slots);
                        self.look([x, y], trace, &mut tally.pixel);
                        tally
                    },
                    |mut tally, chunk| {
                        if !self.control.cancel.load(Ordering::Relaxed) {
                            let first = first + chunk * CHUNK;
                            self.chunk(x, y, samples, first, trace, &mut tally);
                        }
                        tally
                    },
                )
                .map(|tally| tally.counts)
                .reduce(
                    || Counts::new(0),
                    |mut a, b| {
                        if a.is_empty() {
                            return b;
                        }
                        a.merge(&b);
                        a
                    },
                );
            tally.counts.merge(&sums);
            (self.control.progress)(end - first);
            first = end;
        }
    }

    /// Counts up to [`CHUNK`] samples of a pixel that has `samples`, from the one with index `first` on.
    fn chunk(&self, x: u32, y: u32, samples: u64, first: u64, trace: Trace, tally: &mut Tally<P>) {
        let end = samples.min(first + CHUNK);
        let Tally {
            counts,
            pixel,
            points,
            ..
        } = tally;
        let vectors = match trace {
            Trace::Together(..) if end - first >= FEW => self.way.vectors(),
            // To choose others takes longer, and rays that are traced one by one afterwards are slower for it.
            _ => Vectors::Baseline,
        };
        self.sampling
            .place(vectors, [x, y], samples, first..end, points);
        // One by one, each may take its time.
        let wanted = points.iter().take_while(|_| self.go_on().is_continue());
        match trace {
            Trace::Together(..) => self.world.count(
                pixel,
                points.lanes(),
                points.len(),
                vectors,
                |slot, samples| counts.add(slot, samples),
            ),
            Trace::Among(live) => {
                for offset in wanted {
                    counts.add(self.world.slot_among(x, y, offset, live.iter()), 1);
                }
            }
            Trace::InCrowd(crowd) => {
                for offset in wanted {
                    counts.add(self.world.slot_in_crowd(x, y, offset, crowd), 1);
                }
            }
            Trace::OneByOne => {
                for offset in wanted {
                    counts.add(self.world.slot_at(x, y, offset), 1);
                }
            }
        }
    }
}

/// How the samples of a pixel are traced.
#[derive(Clone, Copy)]
enum Trace<'a> {
    /// Many at a time, against what may be seen in the pixel; and what it shows of a board, where that is known.
    Together(&'a [Live], Option<&'a Checks>),
    /// One by one, against these.
    Among(&'a [Live]),
    /// One by one, against those of these whose bounds hold the ray.
    InCrowd(&'a [Item]),
    /// One by one, against the objects that the hierarchy knows on their way.
    OneByOne,
}
