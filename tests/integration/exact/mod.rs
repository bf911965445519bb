//! The computed picture against closed forms, against itself in other ways, against samples and against rational arithmetic.

mod board;
mod bounds;
mod diagonal;
mod rational;
mod shapes;
mod twice;

use std::{f64::consts::PI, fmt::Write, num::NonZero};

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    color::Color,
    film,
    render::{Control, Exact, Rendered, render_as_asked, render_exact},
    sampling::Sampling,
    scene::{self, Count, Lens, Method, Sampler, Scene, Shape, View},
    tracer::World,
};

pub use crate::scenes::read;
use crate::{
    scenes::{sampled, scenes},
    tracer::Random,
};

pub fn example(name: &str, width: u32, height: u32) -> Scene {
    let path = format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut scene = read(&std::fs::read_to_string(path).unwrap());
    (scene.image.width, scene.image.height) = (width, height);
    scene
}

/// The names of the examples.
pub fn examples() -> Vec<String> {
    let paths = scenes("examples").into_iter();
    paths
        .map(|path| path.file_name().unwrap().to_str().unwrap().to_owned())
        .collect()
}

fn exact(scene: &Scene) -> Exact {
    part(scene, Area::whole(scene.image.width, scene.image.height))
}

fn part(scene: &Scene, area: Area) -> Exact {
    part_by(scene, area, None)
}

fn part_by(scene: &Scene, area: Area, threads: Option<usize>) -> Exact {
    let control = Control {
        threads: threads.and_then(NonZero::new),
        ..Control::default()
    };
    render_exact(&World::new(scene), area, &control).unwrap()
}

/// Up to a dozen spheres, triangles and boxes in each other's way, seen from among them, cut by near and far planes at times.
pub fn random_scene(random: &mut Random, floor: bool) -> Scene {
    fn number(random: &mut Random, low: f64, high: f64) -> f64 {
        (random.within(low, high) * 1000.0).round() / 1000.0
    }
    fn vector(random: &mut Random, low: [f64; 3], high: [f64; 3]) -> String {
        let [x, y, z] = [0, 1, 2].map(|axis| number(random, low[axis], high[axis]));
        format!("({x}, {y}, {z})")
    }
    let mut shapes = String::new();
    let eye = vector(random, [-4.0, -2.0, 2.0], [4.0, 5.0, 8.0]);
    let lookat = vector(random, [-1.0, 0.0, -1.0], [1.0; 3]);
    for index in 0..2 + random.bits() % 11 {
        let color = ["red", "lime", "blue", "gold", "cyan", "white"][index as usize % 6];
        let center = vector(random, [-2.0, -1.0, -2.0], [2.0; 3]);
        let shape = match index % 4 {
            0 | 1 => format!(
                "sphere {{ center {center} radius {}",
                number(random, 0.1, 1.8)
            ),
            2 => {
                let normal = vector(random, [-1.0; 3], [1.0; 3]);
                let sides = vector(random, [1.5; 3], [2.5; 3]);
                let spin = number(random, 0.0, 360.0);
                format!(
                    "triangle {{ centroid {center} normal {normal} sides {sides} spin {spin}deg"
                )
            }
            _ => format!(
                "box {{ center {center} size {}",
                vector(random, [0.2; 3], [2.0; 3])
            ),
        };
        shapes += &format!("{shape} color {color} }}\n");
    }
    let (roll, fov) = (number(random, -180.0, 180.0), number(random, 20.0, 140.0));
    let mut clip = String::new();
    if number(random, 0.0, 1.0) < 0.4 {
        clip += &format!(" near {}", number(random, 0.5, 4.0));
    }
    if number(random, 0.0, 1.0) < 0.3 {
        clip += &format!(" far {}", number(random, 4.5, 12.0));
    }
    if floor {
        let (y, square) = (number(random, -1.0, 0.5), number(random, 0.2, 1.5));
        shapes = format!("checkerboard {{ y {y} square {square} }}\n{shapes}");
    }
    read(&format!(
        "image {{ width 24 height 18 background #123 }}
         camera {{ eye {eye} lookat {lookat} roll {roll}deg fov {fov}deg{clip} }}
         {shapes}"
    ))
}

/// What two pixels may differ by: their bounds, and the roundings of sums of colours.
fn allowed(bounds: &[f32]) -> f64 {
    bounds.iter().map(|&bound| f64::from(bound)).sum::<f64>() + 4.0 * f64::EPSILON
}

/// Of a scene with twice the resolution four pixels are one of the original.
fn adds_up(scene: &Scene, name: &str) {
    let whole = Area::whole(scene.image.width, scene.image.height);
    part_adds_up(scene, whole, name);
}

/// The same for a part of the picture, which is returned.
fn part_adds_up(scene: &Scene, area: Area, name: &str) -> Exact {
    let mut fine = scene.clone();
    (fine.image.width, fine.image.height) = (2 * fine.image.width, 2 * fine.image.height);
    let [x, y, width, height] = [area.x, area.y, area.width, area.height].map(|size| 2 * size);
    let twice = Area {
        x,
        y,
        width,
        height,
    };
    let (coarse, fine) = (part(scene, area), part(&fine, twice));
    let pixel = |picture: &Exact, x, y| {
        let bound = picture.bounds[(y * picture.film.width() + x) as usize];
        (picture.film.pixel(x, y), bound)
    };
    for (x, y) in Area::whole(area.width, area.height).iter() {
        let (whole, bound) = pixel(&coarse, x, y);
        let quarters =
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| pixel(&fine, 2 * x + i, 2 * y + j));
        let limit = allowed(&[bound]) + allowed(&quarters.map(|(_, bound)| 0.25 * bound));
        for channel in 0..3 {
            let mean = quarters
                .map(|(light, _)| light[channel])
                .iter()
                .sum::<f64>()
                / 4.0;
            let difference = (mean - whole[channel]).abs();
            assert!(
                difference <= limit,
                "{name} at {x}, {y}: {difference:e} of {limit:e}"
            );
        }
    }
    coarse
}

/// Every pixel of a picture is known to a thousand-millionth.
#[track_caller]
fn is_known(text: &str) {
    let scene = read(text);
    let bound = exact(&scene).bound();
    assert!(bound <= 1e-9, "{bound:e}\n{text}");
}

/// Compares a picture with one of so many random samples a pixel.
fn agrees_with_samples(scene: &Scene, computed: &Exact, samples: u64, name: &str) {
    let mut scene = scene.clone();
    scene.sampler = Sampler {
        method: Method::Random,
        count: Count::PerPixel(samples),
        seed: 5,
    };
    let whole = Area::whole(scene.image.width, scene.image.height);
    let sampled = sampled(&scene, whole);
    // For channels from 0 to 1 of mean m the variance of a mean is at most m(1 − m)/n. By Bernstein's inequality no more than one of 10¹⁰ sums of
    // independent ones is farther off than this.
    let log = libm::log(2e10);
    let most = |variance: f64| (2.0 * variance * log).sqrt() + log / (1.5 * samples as f64);
    let (mut sum, mut variances) = ([0.0; 3], [0.0; 3]);
    for (x, y) in whole.iter() {
        let (a, b) = (computed.film.pixel(x, y), sampled.pixel(x, y));
        for channel in 0..3 {
            let mean = a[channel];
            let variance = mean * (1.0 - mean) / samples as f64;
            let difference = mean - b[channel];
            assert!(
                difference.abs() <= most(variance),
                "{name} at {x}, {y}: {mean} and {}",
                b[channel]
            );
            sum[channel] += difference;
            variances[channel] += variance;
        }
    }
    for (sum, variance) in sum.into_iter().zip(variances) {
        let most = most(variance);
        assert!(sum.abs() <= most, "{name}: {sum:e} of {most:e}");
    }
}
