//! A picture that is rendered in slices, so that its caller can do something else in between.
//!
//! A slice is a square of the picture, clipped at the picture's edges. All slices have about the
//! same number of samples. A pixel's mean does not depend on its slice. Rendering in slices needs
//! no clock, which Rust does not have in a web worker.

use super::{Control, RenderError, render_as_asked};
use crate::{
    area::Area,
    film::{Film, Pixel, TooLarge},
    sampling::Sampling,
    tracer::World,
};

/// Maximum number of samples in a slice of a picture: about 10 ms of work for two processors and a
/// few objects. A pixel with more samples is a slice of its own, because pixels are not divided.
pub const SLICE: u64 = 1 << 20;

/// Work of an exactly computed pixel, as the number of samples that take as long. Measured on
/// figure 9.9.
const EXACT_PIXEL_WORK: u64 = 64;

/// A picture of which some slices are rendered.
#[derive(Debug)]
pub struct Slices<P> {
    sampling: Sampling,
    /// The film, which occupies no memory until pixels are written to it.
    film: Film<P>,
    /// Side of a slice, in pixels.
    side: u32,
    /// Number of slices that are already rendered. They are rendered row by row.
    done: u32,
}

impl<P: Pixel> Slices<P> {
    /// Prepares a picture of the given width and height, without rendering anything.
    ///
    /// # Errors
    ///
    /// There is not enough memory for the picture.
    pub fn new(sampling: Sampling, [width, height]: [u32; 2]) -> Result<Self, TooLarge> {
        // The side of a slice is a power of two. A slice therefore consists of whole squares with
        // which the tracer's quartering begins, or lies within one of them.
        let pixels = (SLICE / pixel_work(&sampling)).max(1);
        Ok(Self {
            film: Film::new(width, height)?,
            sampling,
            side: 1 << (pixels.ilog2() / 2),
            done: 0,
        })
    }

    /// Returns the film, which is black where nothing is rendered yet.
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
    /// There is not enough memory, or no thread can be started.
    pub fn advance(&mut self, world: &World) -> Result<bool, RenderError> {
        if let Some(part) = self.next() {
            let slice = render_as_asked(world, &self.sampling, part, &Control::default())?;
            self.film.put(part, slice.film().pixels());
            self.done += 1;
        }
        Ok(self.next().is_none())
    }
}

/// Returns the work of one pixel, as the number of samples that take as long. It is at least 1.
pub fn pixel_work(sampling: &Sampling) -> u64 {
    if sampling.is_exact() {
        return EXACT_PIXEL_WORK;
    }
    sampling.samples_per_pixel().max(1)
}
