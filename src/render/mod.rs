//! A world becomes a film: with samples, or exactly.
//!
//! In: the prepared scene, where the samples lie, and which part of the picture is wanted. Out: the
//! means of its pixels. The part is cut into tiles, which the threads take as they come; neither
//! the number of threads nor the tiles nor the part asked for can change a bit of a pixel.
//!
//! `sampled` renders with samples, whose tiles `renderer` makes; `exact` renders without; `slices`
//! makes a picture of either kind step by step. Which of them a scene asks for is decided here, and
//! what both have in common is here.

mod exact;
mod renderer;
mod sampled;
mod slices;
mod tally;
mod tile;

use std::{
    num::NonZero,
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use thiserror::Error;

use crate::{
    area::Area,
    cancel::{self, Cancelled},
    film::{Film, Pixel, TooLarge},
    sampling::Sampling,
    threads,
    tracer::World,
};

pub use self::{
    exact::{Exact, render_exact, render_numbers},
    sampled::render,
    slices::{SLICE, Slices, pixel_work},
};

/// How a render is watched, and by how many it is done.
pub struct Control<'a> {
    /// How many threads; as many as there are processors if this is `None`.
    pub threads: Option<NonZero<usize>>,
    /// Is told, from any thread, how many more samples are done, or how many more exact pixels.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// Ends the render soon after it is set.
    pub cancel: &'a AtomicBool,
}

/// As many threads as there are processors, nobody who is told, to the end.
impl Default for Control<'_> {
    fn default() -> Self {
        Self {
            threads: None,
            progress: &|_| {},
            cancel: &cancel::NEVER,
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
    Threads(#[from] threads::NoThreads),
    /// It was not wanted any more.
    #[error("interrupted")]
    Cancelled,
}

impl From<Cancelled> for RenderError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A rendered part of the picture.
pub enum Rendered<P = [f64; 3]> {
    /// With samples.
    Sampled(Film<P>),
    /// Without.
    Exact(Exact<P>),
}

impl<P> Rendered<P> {
    /// Its pixels.
    pub fn film(&self) -> &Film<P> {
        match self {
            Self::Sampled(film) | Self::Exact(Exact { film, .. }) => film,
        }
    }

    /// Its pixels alone.
    pub fn into_film(self) -> Film<P> {
        match self {
            Self::Sampled(film) | Self::Exact(Exact { film, .. }) => film,
        }
    }
}

/// Renders a part of the picture, which lies in it, as its sampler asks for: with samples or
/// exactly. The film keeps light, or the bytes of sRGB of which a PNG file is made: the same file,
/// and less memory to touch.
pub fn render_as_asked<P: Pixel>(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Rendered<P>, RenderError> {
    match sampling.is_exact() {
        true => exact::render_exact_as(world, part, control).map(Rendered::Exact),
        false => sampled::render_as(world, sampling, part, control).map(Rendered::Sampled),
    }
}

/// The tiles of a part of the picture, squares of this side from the picture's corner on, as long
/// as they are wanted: to hand out millions that nobody renders would take a second.
fn wanted(part: Area, side: u32, control: &Control) -> impl Iterator<Item = Area> + Send {
    let tiles = part.grid(side).map(move |tile| tile.common(part));
    tiles.take_while(|_| !control.cancel.load(Ordering::Relaxed))
}

/// What was made, if it was wanted to the end.
fn finished<T>(made: Mutex<T>, control: &Control) -> Result<T, RenderError> {
    if control.cancel.load(Ordering::Relaxed) {
        return Err(RenderError::Cancelled);
    }
    Ok(made.into_inner().unwrap_or_else(PoisonError::into_inner))
}
