//! A picture that is made in slices, so that whoever makes it can do something else in between.
//!
//! A slice is a rectangle of the picture with a fixed number of samples: what a pixel shows does
//! not depend on the rectangle that is asked for, and no clock is needed, which a web worker's Rust
//! does not have.

use super::{Control, RenderError, render_as_asked};
use crate::{
    area::Area,
    film::{Film, Pixel, TooLarge},
    sampling::Sampling,
    tracer::World,
};

/// Number of samples of a slice: some 10 ms of two processors for a few objects. A pixel with more
/// of them is a slice by itself, since a pixel is not divided.
pub const SLICE: u64 = 1 << 20;

/// A pixel without samples takes as long as so many samples, for figure 9.9.
const EXACT: u64 = 64;

/// A picture, and how far it is made.
#[derive(Debug)]
pub struct Slices<P> {
    sampling: Sampling,
    /// Takes no memory until there are pixels in it.
    film: Film<P>,
    /// The side of a slice.
    side: u32,
    /// How many slices are made, row by row.
    made: u32,
}

impl<P: Pixel> Slices<P> {
    /// A picture of this size of which nothing is made.
    ///
    /// # Errors
    ///
    /// There is no memory for it.
    pub fn new(sampling: Sampling, [width, height]: [u32; 2]) -> Result<Self, TooLarge> {
        // A square with a power of two as its side: whole tiles of the tracer's grid, or a part of
        // one.
        let pixels = (SLICE / pixel_work(&sampling)).max(1);
        Ok(Self {
            film: Film::new(width, height)?,
            sampling,
            side: 1 << (pixels.ilog2() / 2),
            made: 0,
        })
    }

    /// What is made of it.
    pub fn film(&self) -> &Film<P> {
        &self.film
    }

    /// Which part of it is made, from 0 to 1.
    pub fn share(&self) -> f64 {
        let [columns, rows] =
            [self.film.width(), self.film.height()].map(|it| it.div_ceil(self.side));
        f64::from(self.made) / (f64::from(columns) * f64::from(rows))
    }

    /// What is to be made next; nothing if nothing is left.
    fn next(&self) -> Option<Area> {
        let (width, height, side) = (self.film.width(), self.film.height(), self.side);
        let columns = width.div_ceil(side);
        let (x, y) = (self.made % columns * side, self.made / columns * side);
        (y < height).then(|| Area {
            x,
            y,
            width: side.min(width - x),
            height: side.min(height - y),
        })
    }

    /// Makes the next slice. Says whether none is left.
    ///
    /// # Errors
    ///
    /// The system has no memory or no threads for it.
    pub fn advance(&mut self, world: &World) -> Result<bool, RenderError> {
        if let Some(part) = self.next() {
            let made = render_as_asked(world, &self.sampling, part, &Control::default())?;
            self.film.put(part, made.film().pixels());
            self.made += 1;
        }
        Ok(self.next().is_none())
    }
}

/// How many samples a pixel takes, or as long as how many.
pub fn pixel_work(sampling: &Sampling) -> u64 {
    match sampling.is_exact() {
        true => EXACT,
        false => sampling.samples_per_pixel().max(1),
    }
}
