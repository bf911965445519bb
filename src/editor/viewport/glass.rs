//! Examines one pixel: the colours that it shows, its exact mean colour, and the error of each
//! sampling method.

use std::cmp::Reverse;

use glam::DVec2;

use super::pick::pick;
use crate::{
    area::Area,
    cancel,
    color::Color,
    exact::{ExactPixel, Integrator},
    film::Film,
    math::SimdWidth,
    sampling::{Points, Sampling},
    scene::{Count, Method, Sampler, Scene},
    tracer::World,
};

/// Numbers of samples for which the errors of all methods are computed. Each is 4 times the one
/// before. An error that shrinks with the square root of the number of samples halves at each step.
pub const SAMPLE_COUNTS: [u64; 5] = [1, 4, 16, 64, 256];

/// Number of seeds over which the errors of a method are averaged. With 32, the root mean square of
/// independent errors is known to within about an eighth. Halving this uncertainty would need four
/// times as many seeds, and four times the time.
const SEEDS: u64 = 32;

/// Number of rows, and of columns, of the points at which the pixel is examined. The points form an
/// even grid, like the samples of the method `regular`. Each becomes a pixel of the enlarged
/// picture. With a larger number, smaller areas of a colour would be found, but the answer to the
/// editor would take longer.
const ROWS: u32 = 128;

/// Result of examining a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Glass {
    /// Colours that the pixel shows, the one with the largest area first.
    pub seen: Vec<SeenColor>,
    /// The pixel, enlarged to a picture of 128 × 128 pixels. Each of these has the colour that is
    /// seen in its middle.
    pub enlarged: Film<[u8; 3]>,
    /// Exact mean colour, in linear light, with its error bound.
    pub exact: ExactPixel,
    /// Errors of every method that takes samples.
    pub errors: Vec<MethodErrors>,
}

/// A colour that a pixel shows.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenColor {
    /// The colour.
    pub color: Color,
    /// Fraction of the pixel's area that has the colour, from 0 to 1.
    pub share: f64,
    /// Where in the picture the colour was found, in pixels from the top left corner. `None` if the
    /// area with the colour is so small that it lies between the points that are examined.
    pub at: Option<DVec2>,
    /// Index of the object that is seen at `at`; `None` if it is the background.
    pub object: Option<usize>,
}

/// Errors of a pixel's colour by one method, for each number of samples in [`SAMPLE_COUNTS`]. An
/// error is the root mean square over the three channels, in linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct MethodErrors {
    /// The method.
    pub method: Method,
    /// Root mean square of the errors with 32 seeds: the scene's own, and those that follow it.
    pub typical: [f64; SAMPLE_COUNTS.len()],
    /// Errors with the scene's own seed.
    pub own: [f64; SAMPLE_COUNTS.len()],
}

/// Examines the pixel in column `x` and row `y`. `world` must be built from `scene`.
pub fn glass(scene: &Scene, world: &World, pixel: [u32; 2]) -> Glass {
    let [x, y] = pixel;
    let exact = Integrator::new(world).pixels(Area::pixel(x, y), &cancel::NEVER);
    let exact = exact.and_then(|pixels| pixels.first().copied());
    let exact = exact.expect("the integrator was not cancelled");
    let errors = Method::SAMPLED.map(|method| errors(&scene.sampler, method, world, pixel, &exact));
    let color_indices = color_indices(world, pixel);
    let colors = color_indices
        .iter()
        .map(|&color_index| world.palette()[color_index].to_bytes());
    let enlarged = Film::from_pixels(ROWS, ROWS, colors.collect());
    Glass {
        seen: seen_in(scene, world, pixel, &color_indices),
        enlarged: enlarged.expect("each point is a pixel"),
        exact,
        errors: errors.into(),
    }
}

/// Returns the offset from the pixel's middle of the point in column `i` and row `j`.
fn offset(i: u32, j: u32) -> DVec2 {
    (DVec2::new(f64::from(i), f64::from(j)) + 0.5) / f64::from(ROWS) - 0.5
}

/// Returns, for each point at which a pixel is examined, the index of its colour in the world's
/// palette. The points are in the order of the rows.
fn color_indices(world: &World, [x, y]: [u32; 2]) -> Vec<usize> {
    let at = |point: u32| world.color_index_at(x, y, offset(point % ROWS, point / ROWS));
    (0..ROWS * ROWS).map(at).collect()
}

/// Returns the colours that a pixel shows, the one with the largest area first. `world` must be
/// built from `scene`.
pub fn seen_colors(scene: &Scene, world: &World, pixel: [u32; 2]) -> Vec<SeenColor> {
    seen_in(scene, world, pixel, &color_indices(world, pixel))
}

fn seen_in(
    scene: &Scene,
    world: &World,
    [x, y]: [u32; 2],
    color_indices: &[usize],
) -> Vec<SeenColor> {
    let mut points = vec![None; world.palette().len()];
    for (at, &color_index) in (0..).zip(color_indices) {
        points[color_index].get_or_insert(offset(at % ROWS, at / ROWS));
    }
    let middle = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
    let mut seen = Vec::new();
    Integrator::new(world).shares(Area::pixel(x, y), |_, shares| {
        let shares = shares.iter().filter(|(_, share)| *share > 0.0);
        seen.extend(shares.map(|&(color_index, share)| {
            let at = points[color_index].map(|offset| middle + offset);
            let hit = at.and_then(|at| pick(scene, world, at)?.0);
            SeenColor {
                color: world.palette()[color_index],
                share,
                at,
                object: hit.map(|hit| hit.object),
            }
        }));
    });
    seen.sort_by_key(|seen| Reverse(seen.share.to_bits()));
    seen
}

/// Computes the errors of a pixel by one method. Only the seed of `sampler` is used.
fn errors(
    sampler: &Sampler,
    method: Method,
    world: &World,
    pixel: [u32; 2],
    exact: &ExactPixel,
) -> MethodErrors {
    let mut points = Points::default();
    let mut error = |count: u64, seed: u64| {
        let sampler = Sampler {
            method,
            count: Count::PerPixel(count),
            seed: sampler.seed + seed,
        };
        let mean = mean(&sampler, world, pixel, &mut points);
        let squares = [0, 1, 2].map(|i| (mean[i] - exact.mean[i]) * (mean[i] - exact.mean[i]));
        (squares.iter().sum::<f64>() / 3.0).sqrt()
    };
    let all = SAMPLE_COUNTS.map(|count| {
        let errors: Vec<f64> = (0..SEEDS).map(|seed| error(count, seed)).collect();
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        ((squares / SEEDS as f64).sqrt(), errors[0])
    });
    MethodErrors {
        method,
        typical: all.map(|(typical, _)| typical),
        own: all.map(|(_, own)| own),
    }
}

/// Returns the mean colour of a pixel's samples, in linear light; black if there are no samples.
fn mean(sampler: &Sampler, world: &World, [x, y]: [u32; 2], points: &mut Points) -> [f64; 3] {
    let picture = world.picture();
    let sampling = Sampling::new(sampler, picture.width, picture.height);
    let count = sampling.count(x, y);
    sampling.place(SimdWidth::Widest, [x, y], count, 0..count, points);
    let mut sum = [0.0; 3];
    for offset in points.iter() {
        let light = world.palette()[world.color_index_at(x, y, offset)].to_linear();
        sum = [0, 1, 2].map(|i| sum[i] + light[i]);
    }
    sum.map(|sum| sum / count.max(1) as f64)
}
