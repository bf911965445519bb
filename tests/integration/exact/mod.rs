//! Compares exact pictures with closed formulas, with pictures of twice the resolution, with
//! samples, and with rational arithmetic.

mod board;
mod bounds;
mod diagonal;
mod quarters;
mod rational;
mod shapes;

use std::fmt::Write;

use pinhole::{
    area::Area,
    render::{Control, Exact, render_exact},
    scene::{Count, Method, Scene},
    tracer::World,
};

pub use crate::scenes::read;
use crate::{
    effort::{Effort, sampled_and_exhaustive},
    generated::{Numbers, generated},
    random::Random,
    scenes::{
        exact, example, example_names, example_text, read_with, resized, sampled, scenes, whole,
        with_samples,
    },
    table::{lines, list, rows},
};

fn part(scene: &Scene, area: Area) -> Exact {
    render_exact(&World::new(scene), area, &Control::default()).unwrap()
}

/// Generates scenes in which all numbers have ordinary magnitudes. Their pictures have the size
/// `size`, in pixels.
fn ordinary(size: [u32; 2], seed: u64) -> impl Iterator<Item = Scene> {
    generated(Numbers::Wild(0), size, seed).map(|(_, scene)| scene)
}

/// Returns the linear light of the pixel (x, y), and its error bound.
pub fn pixel(picture: &Exact, x: u32, y: u32) -> ([f64; 3], f64) {
    let bound = picture.bounds[(y * picture.film.width() + x) as usize];
    (picture.film.pixel(x, y), bound.into())
}

/// Returns the largest absolute difference between two pixels in one of the three channels.
pub fn difference(one: [f64; 3], other: [f64; 3]) -> f64 {
    let differences = [0, 1, 2].map(|channel| (one[channel] - other[channel]).abs());
    differences.into_iter().fold(0.0, f64::max)
}

/// Asserts that each pixel of a scene is the mean of its four quarters, within the error bounds.
/// The quarters are the pixels of the picture at twice the resolution.
#[track_caller]
fn assert_adds_up(scene: &Scene) {
    assert_part_adds_up(scene, whole(scene));
}

/// Asserts that each pixel of `area` is the mean of its four quarters, within the error bounds. The
/// quarters are the pixels of the picture at twice the resolution. Returns the exact picture of
/// `area`.
#[track_caller]
fn assert_part_adds_up(scene: &Scene, area: Area) -> Exact {
    let fine = resized(scene.clone(), 2 * scene.image.width, 2 * scene.image.height);
    let [x, y, width, height] = [area.x, area.y, area.width, area.height].map(|size| 2 * size);
    let twice = Area {
        x,
        y,
        width,
        height,
    };
    let (coarse, fine) = (part(scene, area), part(&fine, twice));
    for (x, y) in Area::whole(area.width, area.height).iter() {
        let (light, bound) = pixel(&coarse, x, y);
        let (mut mean, mut limit) = ([0.0; 3], bound + 8.0 * f64::EPSILON);
        for (i, j) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let (quarter, bound) = pixel(&fine, 2 * x + i, 2 * y + j);
            mean = [0, 1, 2].map(|channel| mean[channel] + quarter[channel] / 4.0);
            limit += bound / 4.0;
        }
        let difference = difference(light, mean);
        assert!(
            difference <= limit,
            "{x}, {y}: {difference:e} of {limit:e} of {scene:?}"
        );
    }
    coarse
}

/// Asserts that the error bound of every pixel of the scene is at most 1e-9.
#[track_caller]
fn assert_known(text: &str) {
    let bound = exact(&read(text)).bound();
    assert!(bound <= 1e-9, "{bound:e}\n{text}");
}

/// Asserts that an exact picture agrees with a render of the scene with `samples` random samples
/// per pixel.
fn assert_agrees_with_samples(scene: &Scene, computed: &Exact, samples: u64) {
    let scene = with_samples(scene, Method::Random, Count::PerPixel(samples));
    let sampled = sampled(&scene);
    // Let m be the mean of a channel, whose values are from 0 to 1. The variance of the mean of n
    // samples is then at most
    //     v = m·(1 − m)/n.
    // By Bernstein's inequality, the mean of n independent samples differs from m by more than
    // `most(v)` with a probability of at most 10⁻¹⁰.
    let log = libm::log(2e10);
    let most = |variance: f64| (2.0 * variance * log).sqrt() + log / (1.5 * samples as f64);
    let pixels = computed.film.pixels().iter().zip(sampled.pixels());
    for ((computed, sampled), bound) in pixels.clone().zip(&computed.bounds) {
        let is_uniform = *bound == 0.0;
        assert!(
            !is_uniform || computed == sampled,
            "{computed:?} and {sampled:?} of {scene:?}"
        );
    }
    for channel in 0..3 {
        let (mut sum, mut variances) = (0.0_f64, 0.0);
        for (index, (computed, sampled)) in pixels.clone().enumerate() {
            let (mean, found) = (computed[channel], sampled[channel]);
            let variance = mean * (1.0 - mean) / samples as f64;
            let is_near = (mean - found).abs() <= most(variance);
            assert!(is_near, "{index}: {mean} and {found} of {scene:?}");
            (sum, variances) = (sum + mean - found, variances + variance);
        }
        let most = most(variances);
        assert!(sum.abs() <= most, "{sum:e} of {most:e} of {scene:?}");
    }
}
