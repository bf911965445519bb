//! Renders a prepared scene (a `World`) to a film, with samples or exactly.
//!
//! In: the prepared scene, the positions of the samples, and the wanted part of the picture. Out:
//! the colours of the part's pixels. The part is divided into tiles (squares), and each thread
//! renders one tile after another. The bits of a pixel do not depend on the number of threads, on
//! the tiles, or on the part.
//!
//! `sampled` renders with samples, and calls `renderer` for each tile. `exact` renders without
//! samples. `slices` renders one square of the picture at a time, with samples or exactly, and
//! `bands` several rows at a time. This file calls `sampled` or `exact`, according to the scene's
//! sampler, and contains the code that they share.

mod bands;
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
    bands::render_bands,
    exact::render_numbers,
    slices::{SLICE, Slices, pixel_work},
};

/// Control of a render: its threads, its progress, and its cancellation.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Number of threads. If it is `None`, the process's limit is used or, if there is no limit,
    /// one thread per processor.
    pub threads: Option<NonZero<usize>>,
    /// Function that is called with the number of samples that were finished since its last call.
    /// In an exact render, it is called with the number of finished pixels. Any thread may call it.
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

/// Default settings: the default number of threads, no progress, and no cancellation.
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
    /// The part has no pixels, or does not lie in the picture.
    #[error(
        "the part {part} has no pixels, or does not lie in the picture of {} × {}",
        whole.width,
        whole.height
    )]
    Outside {
        /// Part that was to be rendered.
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
    /// A picture that was rendered with samples.
    Sampled(Film<P>),
    /// A picture that was rendered without samples.
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

/// Renders a part of the picture, with samples or exactly, as `sampling` specifies. Returns the
/// colours in linear light.
///
/// # Errors
///
/// Fails if the part does not lie in the picture, there is not enough memory, no thread can be
/// started, or the render was cancelled.
///
/// # Panics
///
/// Panics if the sampling was made for a picture of another size.
pub fn render(
    world: &World,
    sampling: &Sampling,
    part: Area,
    control: &Control,
) -> Result<Film, RenderError> {
    render_as_asked(world, sampling, part, control).map(Rendered::into_film)
}

/// Renders a part of the picture, with samples or exactly, as `sampling` specifies. The film stores
/// linear light, or bytes of sRGB. Bytes need less memory, and suffice for a PNG file.
///
/// # Errors
///
/// Fails if the part does not lie in the picture, there is not enough memory, no thread can be
/// started, or the render was cancelled.
///
/// # Panics
///
/// Panics if the sampling was made for a picture of another size.
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

/// Iterates over the squares (tiles) into which a part of the picture is divided, clipped to the
/// part. The squares have sides of `side` pixels, and form a grid from the picture's top left
/// corner. The iterator ends early if the render is cancelled, because merely iterating over
/// millions of tiles would take a second.
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
