//! Objects in a wrong place or of a wrong size.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use super::{
    ENOUGH, SEARCHED, called,
    colors::{Near, color, share},
    likeliest, moved,
};
use crate::{
    film::Film,
    grade::{Case, Idea, Make, bias::SIGMAS, fit::fit, level::axes},
    numbers::{short, short_vector},
    render::RenderError,
    scene::{Scene, Shape},
};

/// A search for an object's place is worth its time if the pixels of its colour have this share of the squared difference.
const OWN: f64 = 0.4;

/// And if the part of the picture in which it should be has this share: if it is elsewhere, that has as much, unless what is there is of
/// about its colour.
const OWN_PART: f64 = 0.1;

/// What moves an object by less than this, in pixels, is seen best by what a smaller step changes.
const LITTLE: f64 = 3.0;

/// Objects in a wrong place or of a wrong size, found by what a small step of them changes, or by their colours.
pub fn search(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let mut all = steps(case)?;
    for step in blobs(case) {
        let is_known = all.iter().any(|known| known.index == step.index);
        if !is_known || step.by.length() > LITTLE {
            all.push(step);
        }
    }
    if case.full.is_heavy {
        // Each is fitted many times.
        all.truncate(case.most(SEARCHED));
    }
    let mut ideas = Vec::new();
    for Step { index, by, factor } in all {
        ideas.extend(placed(case, index, by, factor)?);
    }
    Ok(ideas)
}

/// How far an object seems to be moved, in pixels to the right and down, and how much larger it seems to be.
struct Step {
    index: usize,
    by: DVec2,
    factor: f64,
}

/// By what factors an object's size may be off: slopes tell little of more.
const GROWTH: RangeInclusive<f64> = 0.125..=8.0;

/// Of the objects along whose slopes the errors add up, those for which they do so most.
fn steps(case: &Case) -> Result<Vec<Step>, RenderError> {
    let mut steps: Vec<(f64, Step)> = Vec::new();
    for slope in case.slopes()? {
        let sum = case.errors.along(&slope.trend, None);
        let (by, factor) = (slope.by * sum.times, libm::pow(slope.factor, sum.times));
        match steps.last_mut() {
            Some((most, step)) if step.index == slope.index => {
                *most = most.max(sum.sigmas.abs());
                step.by += by;
                step.factor *= factor;
            }
            _ => {
                let index = slope.index;
                steps.push((sum.sigmas.abs(), Step { index, by, factor }));
            }
        }
    }
    let is_small = |step: &Step| step.by.length() < LITTLE && GROWTH.contains(&step.factor);
    steps.retain(|(sigmas, step)| *sigmas > SIGMAS && is_small(step));
    steps.sort_by(|p, q| q.0.total_cmp(&p.0));
    let steps = steps.into_iter().take(SEARCHED);
    Ok(steps.map(|(_, step)| step).collect())
}

/// Objects whose colour is elsewhere, or in more or fewer pixels.
fn blobs(case: &Case) -> Vec<Step> {
    let (a, exact, scene) = (&case.full.a, &case.full.exact, &case.full.scene);
    let mut steps = Vec::new();
    let likely = likeliest(case, 1.0).into_iter();
    for (_, index) in likely
        .take_while(|(share, _)| *share > OWN_PART)
        .take(SEARCHED)
    {
        let object = &scene.objects[index];
        let mut shape = object.shape;
        let colors = color(&mut shape);
        let [color] = colors.as_slice() else { continue };
        let near = Near::to(&color.to_linear());
        let (is, should) = (Blob::of(a, &near), Blob::of(exact, &near));
        if is.pixels < ENOUGH || should.pixels < ENOUGH {
            continue;
        }
        if share(a, exact, &near) < OWN {
            continue;
        }
        let by = is.middle - should.middle;
        let factor = (is.pixels as f64 / should.pixels as f64).sqrt();
        if by.length() < 0.05 && (factor - 1.0).abs() < 0.002 {
            continue;
        }
        steps.push(Step { index, by, factor });
    }
    steps
}

/// Where and how large a colour is in a picture, in pixels.
struct Blob {
    middle: DVec2,
    pixels: u64,
}

impl Blob {
    fn of(film: &Film, near: &Near) -> Self {
        let (mut sum, mut pixels) = (DVec2::ZERO, 0);
        for y in 0..film.height() {
            for (x, pixel) in film.row(y).iter().enumerate() {
                if near.holds(pixel) {
                    sum += DVec2::new(x as f64, f64::from(y));
                    pixels += 1;
                }
            }
        }
        Self {
            middle: sum / pixels as f64,
            pixels,
        }
    }
}

/// An object that is displaced by about so many pixels, and about so many times as large as it should be.
fn placed(case: &Case, index: usize, by: DVec2, factor: f64) -> Result<Vec<Idea>, RenderError> {
    let scene = &case.full.scene;
    let shape = scene.objects[index].shape;
    let middle = match shape {
        Shape::Sphere(sphere) => sphere.center,
        Shape::Triangle(triangle) => triangle.centroid,
        Shape::Box(cuboid) => (cuboid.min + cuboid.max) / 2.0,
        Shape::Checkerboard(_) => return Ok(Vec::new()),
    };
    let ([u, v, w], pitch) = axes(scene);
    let depth = (scene.camera.eye - middle).dot(w);
    if depth <= 0.0 {
        return Ok(Vec::new());
    }
    // What a pixel is at the object's depth, in metres.
    let pixel = depth * pitch;
    let name = called(scene, index);
    let mut ideas = Vec::new();
    let with = |by: DVec3, factor: f64| {
        let mut scene = Scene::clone(scene);
        scene.objects[index].shape = moved(&shape, by, factor);
        let changed = scene.objects[index].shape;
        (factor > 0.0)
            .then(|| Make::Object(Box::new(scene), Box::new([Some(shape), Some(changed)])))
    };
    let little = by.length() < LITTLE && (factor - 1.0).abs() < 0.1;
    let fit = |start: &[f64], widths: &[f64], make: &dyn Fn(&[f64]) -> Option<Make>| {
        fitted(case, little, start, widths, make)
    };
    // Half a pixel.
    let width = 0.5 * pixel;

    // One coordinate wrong is the simplest.
    for (axis, letter) in [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")] {
        let depth_change = axis.dot(w);
        let at = middle - scene.camera.eye;
        // How many pixels the middle moves for a metre: the derivative of (at · u, −at · v)/depth.
        let slope = DVec2::new(
            (axis.dot(u) * depth + at.dot(u) * depth_change) / (depth * depth),
            -(axis.dot(v) * depth + at.dot(v) * depth_change) / (depth * depth),
        ) / pitch;
        let start = match slope.length_squared() {
            0.0 => 0.0,
            square => slope.dot(by) / square,
        };
        let make = |p: &[f64]| with(axis * p[0], 1.0);
        let Some(found) = fit(&[start], &[width], &make)? else {
            continue;
        };
        let Some(other) = make(&found) else { continue };
        let there = middle + axis * found[0];
        ideas.push(Idea {
            mistake: "object_place",
            message: format!(
                "{name} is in a wrong place: as if the {letter} of its middle were {} instead of {}{}",
                few(there.dot(axis)),
                short(middle.dot(axis)),
                displaced(by)
            ),
            help: format!("its middle is {}", short_vector(middle)),
            make: other,
        });
    }

    let make = |p: &[f64]| with(u * p[0] + v * p[1], libm::exp2(p[2]));
    let start = [by.x * pixel, -by.y * pixel, libm::log2(factor)];
    let Some(found) = fit(&start, &[width, width, 0.01], &make)? else {
        return Ok(ideas);
    };
    let Some(other) = make(&found) else {
        return Ok(ideas);
    };
    let (right, down, factor) = (found[0] / pixel, -found[1] / pixel, libm::exp2(found[2]));
    let place = displaced(DVec2::new(right, down));
    let size = match (factor - 1.0).abs() < 0.01 {
        true => String::new(),
        false => format!(" is {} times as large as it should be", few(factor)),
    };
    let (mistake, message) = match (place.is_empty(), size.is_empty()) {
        (true, _) => ("object_size", format!("{name}{size}, or nearer or farther")),
        (false, true) => ("object_place", format!("{name} is in a wrong place{place}")),
        (false, false) => (
            "object_place",
            format!("{name}{size} (or nearer or farther), and in a wrong place{place}"),
        ),
    };
    ideas.push(Idea {
        mistake,
        message,
        help: format!(
            "its middle is {}; look at its place, its size and the field of view",
            short_vector(middle)
        ),
        make: other,
    });
    Ok(ideas)
}

/// Fits in the small picture what is not little, and then in the whole one. Widths are of the latter.
fn fitted(
    case: &Case,
    little: bool,
    start: &[f64],
    widths: &[f64],
    make: &dyn Fn(&[f64]) -> Option<Make>,
) -> Result<Option<Vec<f64>>, RenderError> {
    let (small, full, control) = (&case.small, &case.full, &case.control);
    let mut at = start.to_vec();
    if !little && !full.is_heavy {
        let wide = widths.iter().map(|width| width * f64::from(small.factor));
        match fit(small, control, start, &wide.collect::<Vec<_>>(), make)? {
            Some(found) => at = found,
            None => return Ok(None),
        }
    }
    fit(full, control, &at, widths, make)
}

/// A displacement in words; none, if it is none.
fn displaced(by: DVec2) -> String {
    let mut way = Vec::new();
    for (by, positive, negative) in [(by.x, "to the right", "to the left"), (by.y, "down", "up")] {
        if by.abs() >= 0.05 {
            let side = if by > 0.0 { positive } else { negative };
            way.push(format!("{} pixels {side}", few(by.abs())));
        }
    }
    match way.is_empty() {
        true => String::new(),
        false => format!(", {}", way.join(" and ")),
    }
}

/// What was found by a search has few right digits.
fn few(x: f64) -> String {
    match x.abs() < 5e-3 {
        true => "0".to_owned(),
        false => short(format!("{x:.2e}").parse().unwrap_or(x)),
    }
}
