//! The computed picture against closed forms, against itself in other ways, against samples and against rational arithmetic.

mod board;
mod bounds;
mod diagonal;
mod many;
mod rational;
mod shapes;
mod twice;

use std::{f64::consts::PI, fmt::Write, num::NonZero};

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    color::Color,
    film,
    render::{Control, Exact, Rendered, render, render_as_asked, render_exact},
    sampling::Sampling,
    scene::{self, Count, Lens, Method, Sampler, Scene, Shape, View},
    source::{Source, Sources},
    tracer::World,
};

use crate::{scenes::scenes, tracer::Random};

pub fn read(text: &str) -> Scene {
    let sources = Sources::new(Source::from_text("a.scn", text));
    let reading = scene::read(&sources);
    reading
        .scene
        .unwrap_or_else(|| panic!("not a scene: {text}"))
}

pub fn example(name: &str, width: u32, height: u32) -> Scene {
    let path = format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut scene = read(&std::fs::read_to_string(path).unwrap());
    (scene.image.width, scene.image.height) = (width, height);
    scene
}

/// The names of the examples.
pub fn examples() -> Vec<String> {
    let paths = scenes("examples").into_iter();
    let names = paths.map(|path| path.file_name().unwrap().to_str().unwrap().to_owned());
    names.collect()
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
    let mut text = String::from("image { width 24 height 18 background #123 }\n");
    let mut number = |low: f64, high: f64| (random.within(low, high) * 1000.0).round() / 1000.0;
    let mut vector = |x: (f64, f64), y: (f64, f64), z: (f64, f64)| {
        format!(
            "({}, {}, {})",
            number(x.0, x.1),
            number(y.0, y.1),
            number(z.0, z.1)
        )
    };
    let eye = vector((-4.0, 4.0), (-2.0, 5.0), (2.0, 8.0));
    let lookat = vector((-1.0, 1.0), (0.0, 1.0), (-1.0, 1.0));
    let mut shapes = String::new();
    let colors = ["red", "lime", "blue", "gold", "cyan", "white"];
    let objects = 2 + random.bits() % 11;
    for index in 0..objects {
        let mut number = |low: f64, high: f64| (random.within(low, high) * 1000.0).round() / 1000.0;
        let center = format!(
            "({}, {}, {})",
            number(-2.0, 2.0),
            number(-1.0, 2.0),
            number(-2.0, 2.0)
        );
        let color = colors[index as usize % colors.len()];
        shapes += &match index % 4 {
            0 | 1 => format!(
                "sphere {{ center {center} radius {} color {color} }}\n",
                number(0.1, 1.8)
            ),
            2 => format!(
                "triangle {{ centroid {center} normal ({}, {}, {}) sides ({}, {}, {}) spin {}deg color {color} }}\n",
                number(-1.0, 1.0),
                number(-1.0, 1.0),
                number(-1.0, 1.0),
                number(1.5, 2.5),
                number(1.5, 2.5),
                number(1.5, 2.5),
                number(0.0, 360.0)
            ),
            _ => format!(
                "box {{ center {center} size ({}, {}, {}) color {color} }}\n",
                number(0.2, 2.0),
                number(0.2, 2.0),
                number(0.2, 2.0)
            ),
        };
    }
    let mut number = |low: f64, high: f64| (random.within(low, high) * 1000.0).round() / 1000.0;
    let (roll, fov) = (number(-180.0, 180.0), number(20.0, 140.0));
    text += &format!("camera {{ eye {eye} lookat {lookat} roll {roll}deg fov {fov}deg");
    if number(0.0, 1.0) < 0.4 {
        text += &format!(" near {}", number(0.5, 4.0));
    }
    if number(0.0, 1.0) < 0.3 {
        text += &format!(" far {}", number(4.5, 12.0));
    }
    text += " }\n";
    if floor {
        text += &format!(
            "checkerboard {{ y {} square {} }}\n",
            number(-1.0, 0.5),
            number(0.2, 1.5)
        );
    }
    read(&(text + &shapes))
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
    fine.image.width *= 2;
    fine.image.height *= 2;
    let twice = Area {
        x: 2 * area.x,
        y: 2 * area.y,
        width: 2 * area.width,
        height: 2 * area.height,
    };
    let (coarse, fine) = (part(scene, area), part(&fine, twice));
    for (x, y) in Area::whole(area.width, area.height).iter() {
        let quarters = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| (2 * x + i, 2 * y + j));
        let bound = |picture: &Exact, (x, y): (u32, u32)| {
            picture.bounds[(y * picture.film.width() + x) as usize]
        };
        let whole = bound(&coarse, (x, y));
        let bounds = quarters.map(|at| 0.25 * bound(&fine, at));
        let limit = allowed(&[whole]) + allowed(&bounds);
        for channel in 0..3 {
            let mean = quarters
                .map(|(x, y)| fine.film.pixel(x, y)[channel])
                .iter()
                .sum::<f64>()
                / 4.0;
            let difference = (mean - coarse.film.pixel(x, y)[channel]).abs();
            assert!(
                difference <= limit,
                "{name} at {x}, {y}: {difference:e} of {limit:e}"
            );
        }
    }
    coarse
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
    let control = Control::default();
    let sampling = Sampling::new(&scene.sampler, whole.width, whole.height);
    let sampled = render(&World::new(&scene), &sampling, whole, &control).unwrap();
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
