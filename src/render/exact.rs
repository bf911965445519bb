//! Computes a part of the picture exactly, i.e. without samples, with error bounds.
//!
//! In: the prepared scene and the part of its picture. Out: the colours of the pixels, which
//! [`Integrator`] computes, and their error bounds, rounded upwards.

use std::{fmt, sync::Mutex};

use super::{Control, RenderError, check_part, finished, tiles};
use crate::{
    area::Area,
    exact::{ExactPixel, Integrator},
    film::{self, Encoder, Film},
    lock::lock,
    threads,
    tracer::{GRID, World},
};

/// Side of the squares of pixels (tiles) that a thread computes at a time, in pixels. Pixels of a
/// checkerboard are computed in batches of eight similar pixels, and a tile must be large enough to
/// fill most batches: with half this side, the scene of `benches/render.rs` took 5 % longer. Tiles
/// must also be small enough that all threads end at about the same time.
const TILE: u32 = 2 * GRID;

/// An exactly computed picture, with its error bounds.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct Exact<P = [f64; 3]> {
    /// Colours of the pixels, in linear light or converted to another type of pixel.
    pub film: Film<P>,
    /// Error bound of each pixel's colour, in linear light, row by row. A bound is valid for every
    /// channel.
    pub bounds: Vec<f32>,
    /// Number of pixels whose stored value is certain, i.e. would be the same for every colour
    /// within the error bound.
    pub certain: u64,
}

/// Writes the film's size, the greatest error bound and the number of certain pixels.
impl<P> fmt::Debug for Exact<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("Exact");
        fields.field("film", &self.film);
        fields.field("bound", &self.bound());
        fields
            .field("certain", &self.certain)
            .finish_non_exhaustive()
    }
}

impl<P> Exact<P> {
    /// Returns the greatest of the pixels' error bounds.
    pub fn bound(&self) -> f64 {
        f64::from(self.bounds.iter().copied().fold(0.0, f32::max))
    }

    /// Returns the root mean square of the error bounds, an upper bound of the root mean square
    /// error over all pixels and channels.
    pub fn root_mean_square_bound(&self) -> f64 {
        let squares = self
            .bounds
            .iter()
            .map(|&bound| f64::from(bound) * f64::from(bound));
        (squares.sum::<f64>() / self.bounds.len().max(1) as f64).sqrt()
    }
}

/// Computes a part of the picture without samples, and reports its progress in pixels.
///
/// # Errors
///
/// Fails if the part does not lie in the picture, there is not enough memory, no thread can be
/// started, or the render was cancelled.
pub fn render_exact(world: &World, part: Area, control: &Control) -> Result<Exact, RenderError> {
    render_exact_as(world, part, control)
}

pub(super) fn render_exact_as<P: film::Pixel>(
    world: &World,
    part: Area,
    control: &Control,
) -> Result<Exact<P>, RenderError> {
    render_numbers(&Integrator::new(world), part, control, &|_, _| ())
}

/// Computes a part of the picture with an integrator that assigns `N` numbers to each colour and
/// computes their means in every pixel. The first three numbers are the colour's channels. Calls
/// `also` with each finished tile (a square of pixels), and with all numbers of its pixels.
///
/// # Errors
///
/// Fails if the part does not lie in the picture, there is not enough memory, no thread can be
/// started, or the render was cancelled.
pub fn render_numbers<P: film::Pixel, const N: usize>(
    integrator: &Integrator<N>,
    part: Area,
    control: &Control,
    also: &(dyn Fn(Area, &[ExactPixel<N>]) + Sync),
) -> Result<Exact<P>, RenderError> {
    check_part(part, integrator.world.picture())?;
    let exact = Mutex::new(Exact {
        film: Film::new(part.width, part.height)?,
        bounds: vec![0f32; part.pixels() as usize],
        certain: 0,
    });
    let encoder = Encoder::shared();
    let compute = |tile: Area| {
        let Some(pixels) = integrator.pixels(tile, control.cancel) else {
            return;
        };
        also(tile, &pixels);
        let mut means = Vec::with_capacity(pixels.len());
        let mut bounds = Vec::with_capacity(pixels.len());
        let mut certain = 0;
        // Most pixels are equal to the pixel before, so the result of the last conversion is stored
        // and used again.
        let (mut before, mut last) = (None, (P::default(), 0.0, true));
        for pixel in &pixels {
            if before != Some(pixel) {
                (before, last) = (Some(pixel), convert(pixel, encoder));
            }
            let (mean, bound, is_certain) = last;
            means.push(mean);
            bounds.push(bound);
            certain += u64::from(is_certain);
        }
        let mut exact = lock(&exact);
        exact.film.put(tile.within(part), &means);
        let rows = bounds.chunks_exact(tile.width as usize);
        for (y, row) in (tile.y..).zip(rows) {
            let start = part.index(tile.x, y);
            exact.bounds[start..start + row.len()].copy_from_slice(row);
        }
        exact.certain += certain;
        drop(exact);
        (control.progress)(tile.pixels());
    };
    threads::for_each(
        control.threads,
        tiles(part, TILE, control),
        || (),
        |(), tile| compute(tile),
    )?;
    finished(exact, control)
}

/// Returns the pixel's mean colour as it is stored in a film, its error bound, and whether all
/// colours within the bound are stored as the same value.
fn convert<P: film::Pixel, const N: usize>(
    pixel: &ExactPixel<N>,
    encoder: &Encoder,
) -> (P, f32, bool) {
    let mean = [0, 1, 2].map(|i| pixel.mean[i]);
    let bound = match pixel.bound {
        0.0 => 0.0,
        // The bound is rounded up to an `f32`. It need not exceed 1, because light is between 0
        // and 1.
        bound => (bound as f32).next_up().min(1.0),
    };
    let is_certain = P::is_certain(mean, f64::from(bound), encoder);
    (P::of(mean, encoder), bound, is_certain)
}
