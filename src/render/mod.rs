//! Renders a world to a film, with samples or exactly.
//!
//! In: the prepared scene, the positions of the samples, and the wanted part of the picture. Out:
//! the means of the part's pixels. The part is divided into tiles, which the threads take in turn.
//! Neither the number of threads nor the tiles nor the part changes a bit of a pixel.
//!
//! `sampled` renders with samples, with a `renderer` of tiles; `exact` renders without samples;
//! `slices` renders either kind step by step. This file selects the kind by the scene's sampler,
//! and contains the code that both kinds share.

mod exact;
mod renderer;
mod sampled;
mod slices;
mod tally;
mod tile;

use std::{
    fmt,
    num::NonZero,
    sync::{
        Mutex,
        atomic::{AtomicBool, Ordering},
    },
};

use thiserror::Error;

use crate::{
    area::Area,
    cancel::{self, Cancelled},
    film::{Film, Pixel, TooLarge},
    lock::unpoisoned,
    sampling::Sampling,
    threads,
    tracer::World,
};

pub use self::exact::{Exact, render_exact};
#[doc(hidden)]
pub use self::{
    exact::render_numbers,
    slices::{SLICE, Slices, pixel_work},
};

/// Control of a render: its threads, its progress, and its cancellation.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Number of threads; `None` for the default number, which is one per processor or the
    /// process's limit.
    pub threads: Option<NonZero<usize>>,
    /// Function that is called, from any thread, with the number of samples, or of exact pixels,
    /// finished since its last call.
    pub progress: &'a (dyn Fn(u64) + Sync),
    /// Flag that ends the render soon after it is set.
    pub cancel: &'a AtomicBool,
}

impl fmt::Debug for Control<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("Control");
        fields.field("threads", &self.threads);
        fields.field("cancel", self.cancel).finish_non_exhaustive()
    }
}

/// Default control: the default number of threads, no progress, no cancellation.
impl Default for Control<'_> {
    fn default() -> Self {
        Self {
            threads: None,
            progress: &|_| {},
            cancel: &cancel::NEVER,
        }
    }
}

/// Reason why a render gives no picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RenderError {
    /// There is not enough memory for the picture.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// The system cannot start threads.
    #[error("cannot start threads: {0}")]
    Threads(#[from] threads::NoThreads),
    /// The part is not one of the picture.
    #[error(
        "the part {part} has no pixels, or does not lie in the picture of {} × {}",
        whole.width,
        whole.height
    )]
    Outside {
        /// The part that was asked for.
        part: Area,
        /// The whole picture.
        whole: Area,
    },
    /// The render was cancelled.
    #[error("interrupted")]
    Cancelled,
}

impl From<Cancelled> for RenderError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A rendered part of the picture.
#[derive(Clone, Debug, PartialEq)]
pub enum Rendered<P = [f64; 3]> {
    /// A picture with samples.
    Sampled(Film<P>),
    /// A picture without samples.
    Exact(Exact<P>),
}

impl<P> Rendered<P> {
    /// Returns the film.
    pub fn film(&self) -> &Film<P> {
        match self {
            Self::Sampled(film) | Self::Exact(Exact { film, .. }) => film,
        }
    }

    /// Returns the film without its error bounds.
    pub fn into_film(self) -> Film<P> {
        match self {
            Self::Sampled(film) | Self::Exact(Exact { film, .. }) => film,
        }
    }
}

/// Renders a part of the picture as its sampler specifies, and returns the means in linear light.
///
/// # Errors
///
/// The part does not lie in the picture, there is not enough memory, no thread can be started, or
/// the render was cancelled.
///
/// # Panics
///
/// The sampling is that of a picture of another size.
pub fn render(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film, RenderError> {
    render_as_asked(world, sampling, part, control).map(Rendered::into_film)
}

/// Renders a part of the picture as its sampler specifies: with samples or exactly. The film stores
/// light, or the bytes of sRGB that a PNG file needs. With bytes, the file is the same, and less
/// memory is used.
///
/// # Errors
///
/// As of [`render`].
///
/// # Panics
///
/// As of [`render`].
pub fn render_as_asked<P: Pixel>(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Rendered<P>, RenderError> {
    assert_eq!(
        sampling.picture(),
        world.picture(),
        "the sampling is of a picture of another size"
    );
    if sampling.is_exact() {
        return exact::render_exact_as(world, part, control).map(Rendered::Exact);
    }
    sampled::render_as(world, sampling, part, control).map(Rendered::Sampled)
}

/// Rejects a part that has no pixels or does not lie in the picture.
pub(crate) fn check_part(part: Area, whole: Area) -> Result<(), RenderError> {
    if part.pixels() > 0 && part.lies_in(whole) {
        return Ok(());
    }
    Err(RenderError::Outside { part, whole })
}

/// Returns the tiles of a part of the picture: squares of side `side`, in pixels, in a grid from
/// the picture's top left corner, clipped to the part. The iterator ends early if the render is
/// cancelled, because iterating over millions of tiles without rendering them would take a second.
fn tiles(part: Area, side: u32, control: &Control) -> impl Iterator<Item = Area> + Send {
    let tiles = part.grid(side).map(move |tile| tile.common(part));
    tiles.take_while(|_| !control.cancel.load(Ordering::Relaxed))
}

/// Returns the result of a render, or [`RenderError::Cancelled`] if the render was cancelled.
fn finished<T>(result: Mutex<T>, control: &Control) -> Result<T, RenderError> {
    if control.cancel.load(Ordering::Relaxed) {
        return Err(RenderError::Cancelled);
    }
    Ok(unpoisoned(result.into_inner()))
}
