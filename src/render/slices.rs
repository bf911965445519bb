//! Renders a picture in slices, so that the caller can react to events between two slices.
//!
//! A slice is a square of the picture, clipped at the picture's edges. All slices have about the
//! same number of samples. The colour of a pixel does not depend on its slice. The limit of a slice
//! is a number of samples instead of a time, because Rust has no clock in a web worker.

use super::{Control, RenderError, render_as_asked};
use crate::{
    area::Area,
    film::{Film, Pixel, TooLarge},
    sampling::Sampling,
    tracer::World,
};

/// Maximum number of samples in a slice, i.e. a square of the picture that is rendered at a time. A
/// slice takes about 10 ms on two processors if there are few objects. A pixel with more samples is
/// a slice by itself, because pixels are not divided.
pub const SLICE: u64 = 1 << 20;

/// Number of samples that take as long as one exactly computed pixel, measured with the scene of
/// `benches/render.rs`.
const EXACT_PIXEL_WORK: u64 = 64;

/// A partly rendered picture. It is rendered slice by slice, i.e. square by square.
#[derive(Debug)]
pub struct Slices<P> {
    sampling: Sampling,
    /// The film. The system provides memory for a part of it only when the part is rendered.
    film: Film<P>,
    /// Side of a slice, i.e. of the square that is rendered at a time, in pixels.
    side: u32,
    /// Number of slices that are finished. Slices are rendered row by row.
    done: u32,
}

impl<P: Pixel> Slices<P> {
    /// Prepares a picture of the given width and height. Nothing is rendered yet.
    ///
    /// # Errors
    ///
    /// Fails if there is not enough memory for the picture.
    pub fn new(sampling: Sampling, [width, height]: [u32; 2]) -> Result<Self, TooLarge> {
        // The tracer first divides the picture into squares whose side is a power of two. The side
        // of a slice is also a power of two, so a slice consists of whole squares, or lies within
        // one of them.
        let pixels = (SLICE / pixel_work(&sampling)).max(1);
        Ok(Self {
            film: Film::new(width, height)?,
            sampling,
            side: 1 << (pixels.ilog2() / 2),
            done: 0,
        })
    }

    /// Returns the film. It is black where nothing is rendered yet.
    pub fn film(&self) -> &Film<P> {
        &self.film
    }

    /// Returns the fraction of slices that are rendered, from 0 to 1.
    pub fn share(&self) -> f64 {
        let [columns, rows] =
            [self.film.width(), self.film.height()].map(|it| it.div_ceil(self.side));
        f64::from(self.done) / (f64::from(columns) * f64::from(rows))
    }

    /// Returns the area of the next slice. Returns `None` after the last one.
    fn next(&self) -> Option<Area> {
        let (width, height, side) = (self.film.width(), self.film.height(), self.side);
        let columns = width.div_ceil(side);
        let (x, y) = (self.done % columns * side, self.done / columns * side);
        (y < height).then(|| Area {
            x,
            y,
            width: side.min(width - x),
            height: side.min(height - y),
        })
    }

    /// Renders the next slice, if there is one. Returns whether the picture is complete.
    ///
    /// # Errors
    ///
    /// Fails if there is not enough memory, or no thread can be started.
    pub fn advance(&mut self, world: &World) -> Result<bool, RenderError> {
        if let Some(part) = self.next() {
            let slice = render_as_asked(world, &self.sampling, part, &Control::default())?;
            self.film.put(part, slice.film().pixels());
            self.done += 1;
        }
        Ok(self.next().is_none())
    }
}

/// Returns the work of rendering one pixel, in samples: the number of samples in the pixel or, if
/// the pixel is computed exactly, a number that takes equally long. The result is at least 1.
pub fn pixel_work(sampling: &Sampling) -> u64 {
    if sampling.is_exact() {
        return EXACT_PIXEL_WORK;
    }
    sampling.samples_per_pixel().max(1)
}
