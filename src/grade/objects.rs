//! Mistakes of one object: missing, of a wrong colour, size or place.

use glam::{DVec2, DVec3};

use super::{Case, Idea, Make, fit::fit, level::axes};
use crate::{
    color::{Color, linear_to_srgb, srgb_to_linear},
    film::Film,
    math::Angle,
    numbers::{short, short_vector},
    render::RenderError,
    scene::{Scene, Shape},
    tracer::vertices,
};

/// Of a scene with more objects only so many are looked at.
const OBJECTS: usize = 24;

/// A colour is another one if it is off by more than this, in steps of 8-bit sRGB; nearer is the same.
const NEAR: f64 = 2.5;

/// A search for an object's place is worth its time if the pixels of its colour have this share of the squared difference.
const OWN: f64 = 0.4;

/// So many pixels of an object show where it is.
const ENOUGH: u64 = 6;

/// What an object is called.
fn called(scene: &Scene, index: usize) -> String {
    let object = &scene.objects[index];
    let kind = object.shape.kind();
    if let Some(name) = &object.name {
        return format!("the {kind} `{name}`");
    }
    let alike = || {
        scene
            .objects
            .iter()
            .filter(|other| other.shape.kind() == kind)
    };
    match alike().count() {
        1 => format!("the {kind}"),
        _ => format!("the {kind} with the index {index}"),
    }
}

fn with_shape(scene: &Scene, index: usize, shape: Shape) -> Make {
    let mut scene = scene.clone();
    scene.objects[index].shape = shape;
    Make::Scene(Box::new(scene))
}

/// Those that can be named at once.
pub fn ideas(scene: &Scene) -> Vec<Idea> {
    let mut ideas = Vec::new();
    for (index, object) in scene.objects.iter().enumerate().take(OBJECTS) {
        let name = called(scene, index);
        let mut without = scene.clone();
        without.objects.remove(index);
        ideas.push(Idea {
            mistake: "object_missing",
            message: format!("{name} is missing"),
            help: "either it is not drawn, or no ray is found to hit it: look at the equation of its hits, and at their sign (t > 0)".to_owned(),
            make: Make::Scene(Box::new(without)),
        });
        for (mistake, message, help, shape) in wrong_shapes(&object.shape) {
            ideas.push(Idea {
                mistake,
                message: format!("{name} {message}"),
                help: help.to_owned(),
                make: with_shape(scene, index, shape),
            });
        }
    }
    ideas
}

type Wrong = (&'static str, &'static str, &'static str, Shape);

fn wrong_shapes(shape: &Shape) -> Vec<Wrong> {
    let mut wrong = Vec::new();
    let sizes = match shape {
        Shape::Sphere(_) => "radius is half the diameter",
        Shape::Box(_) => "size is the whole length of the edges, and a corner is center ± size/2",
        Shape::Triangle(_) => "sides are the lengths of the three sides in metres",
        Shape::Checkerboard(_) => return wrong,
    };
    for (factor, message) in [
        (2.0, "is twice as large as it should be"),
        (0.5, "is half as large as it should be"),
    ] {
        wrong.push((
            "object_size",
            message,
            sizes,
            moved(shape, DVec3::ZERO, factor),
        ));
    }
    match *shape {
        Shape::Box(cuboid) => {
            let half = (cuboid.max - cuboid.min) / 2.0;
            let help =
                "center is the middle of the box: it goes from center − size/2 to center + size/2";
            let message = "stands with a corner where its center should be";
            for by in [half, -half] {
                wrong.push(("object_place", message, help, moved(shape, by, 1.0)));
            }
        }
        Shape::Triangle(triangle) => {
            let [left, right, apex] = vertices(&triangle);
            let help = "the centroid is the mean of the three vertices: a third of the height above the base";
            let middle = (left + right) / 2.0;
            let message =
                "has the middle of its base, or of its height, where its centroid should be";
            for by in [
                triangle.centroid - middle,
                (triangle.centroid - middle) - (apex - middle) / 2.0,
            ] {
                wrong.push(("object_place", message, help, moved(shape, by, 1.0)));
            }
            let mut changed = |message, help, change: &dyn Fn(&mut crate::scene::Triangle)| {
                let mut other = triangle;
                change(&mut other);
                wrong.push(("object_orientation", message, help, Shape::Triangle(other)));
            };
            let apex = "the apex is on the side of top = n × right, right = (Y × n)/|Y × n|";
            changed("has its apex at the bottom", apex, &|other| {
                other.spin = other.spin + Angle::from_degrees(180.0);
            });
            changed(
                "faces the wrong way: the two sides beside its base are exchanged",
                "a is the side from the base's left end to the apex, b the one from its right end, right = (Y × n)/|Y × n|",
                &|other| std::mem::swap(&mut other.sides.x, &mut other.sides.y),
            );
            let spins = "spin turns counter-clockwise, seen from the tip of the normal";
            changed("is spun the wrong way", spins, &|other| {
                other.spin = -other.spin
            });
            changed("is not spun", spins, &|other| other.spin = Angle::default());
        }
        _ => {}
    }
    wrong
}

/// A shape somewhere else, larger or smaller about its middle.
fn moved(shape: &Shape, by: DVec3, factor: f64) -> Shape {
    let mut shape = *shape;
    match &mut shape {
        Shape::Sphere(sphere) => {
            sphere.center += by;
            sphere.radius *= factor;
        }
        Shape::Triangle(triangle) => {
            triangle.centroid += by;
            triangle.sides *= factor;
        }
        Shape::Box(cuboid) => {
            let (middle, half) = (
                (cuboid.min + cuboid.max) / 2.0,
                (cuboid.max - cuboid.min) / 2.0,
            );
            (cuboid.min, cuboid.max) = (middle + by - half * factor, middle + by + half * factor);
        }
        Shape::Checkerboard(board) => board.y += by.y,
    }
    shape
}

/// What a shape has one of, in its place in the shape; none of a checkerboard, which has two.
fn color(shape: &mut Shape) -> Vec<&mut Color> {
    match shape {
        Shape::Sphere(sphere) => vec![&mut sphere.color],
        Shape::Triangle(triangle) => vec![&mut triangle.color],
        Shape::Box(cuboid) => vec![&mut cuboid.color],
        Shape::Checkerboard(board) => board.colors.iter_mut().collect(),
    }
}

/// Other colours: those that the picture shows where the exact one shows an object alone.
pub fn colors(a: &Film, exact: &Film, scene: &Scene) -> Vec<Idea> {
    let mut ideas = Vec::new();
    let mut all = scene.clone();
    let mut messages = Vec::new();
    let mut change = |wanted: Color, what: String, set: &dyn Fn(&mut Scene, Color)| {
        let Some(shown) = shown(a, exact, wanted) else {
            return;
        };
        let mut other = scene.clone();
        set(&mut other, shown);
        set(&mut all, shown);
        let message = format!("{what} has the colour {shown} instead of {wanted}");
        messages.push(message.clone());
        ideas.push(Idea {
            mistake: "color",
            message,
            help: "colours are sRGB: the number of a channel, 0 to 255, comes out as it is where nothing else is seen".to_owned(),
            make: Make::Scene(Box::new(other)),
        });
    };
    change(
        scene.image.background,
        "the background".to_owned(),
        &|scene, color| scene.image.background = color,
    );
    for (index, object) in scene.objects.iter().enumerate().take(OBJECTS) {
        let mut shape = object.shape;
        for (slot, wanted) in color(&mut shape).into_iter().enumerate() {
            let what = match (slot, object.shape) {
                (0, Shape::Checkerboard(_)) => {
                    format!("the first kind of squares of {}", called(scene, index))
                }
                (_, Shape::Checkerboard(_)) => {
                    format!("the second kind of squares of {}", called(scene, index))
                }
                _ => called(scene, index),
            };
            change(*wanted, what, &|scene, shown| {
                *color(&mut scene.objects[index].shape)[slot] = shown;
            });
        }
    }
    if messages.len() > 1 {
        ideas.push(Idea {
            mistake: "color",
            message: messages.join("; "),
            help: "are the colours decoded once and encoded once, and are their channels in the order red, green, blue?".to_owned(),
            make: Make::Scene(Box::new(all)),
        });
    }
    ideas
}

/// The colour that a picture shows where the exact one shows this one alone, if it is one colour and another.
fn shown(a: &Film, exact: &Film, wanted: Color) -> Option<Color> {
    let light = wanted.to_linear();
    let seen = a.pixels().iter().zip(exact.pixels());
    let mut found: Vec<_> = seen
        .filter(|(_, q)| **q == light)
        .map(|(p, _)| *p)
        .collect();
    if (found.len() as u64) < ENOUGH {
        return None;
    }
    let middle = found.len() / 2;
    let median = [0, 1, 2].map(|i| {
        found.select_nth_unstable_by(middle, |p, q| p[i].total_cmp(&q[i]));
        found[middle][i]
    });
    let near = Near::to(&median);
    let near = found.iter().filter(|p| near.holds(p)).count();
    let is_one = near * 10 >= found.len() * 8;
    let srgb = median.map(|light| (255.0 * linear_to_srgb(light)).clamp(0.0, 255.0));
    (is_one && !Near::to(&light).holds(&median)).then_some(Color { srgb })
}

/// The light of each channel that is near some colour.
struct Near([[f64; 2]; 3]);

impl Near {
    fn to(light: &[f64; 3]) -> Self {
        let steps = NEAR / 255.0;
        Self(light.map(|light| {
            let encoded = linear_to_srgb(light);
            [encoded - steps, encoded + steps].map(srgb_to_linear)
        }))
    }

    fn holds(&self, pixel: &[f64; 3]) -> bool {
        let pairs = self.0.iter().zip(pixel);
        pairs
            .into_iter()
            .all(|([low, high], light)| low < light && light < high)
    }
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

/// Objects in a wrong place or of a wrong size, found by their colours.
pub fn search(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let (a, exact, scene) = (&case.full.a, &case.full.exact, &case.full.scene);
    let mut ideas = Vec::new();
    for (index, object) in scene.objects.iter().enumerate().take(OBJECTS) {
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
        ideas.extend(placed(case, index, by, factor)?);
    }
    Ok(ideas)
}

/// The share of the squared difference in pixels that have a colour in either picture.
fn share(a: &Film, exact: &Film, near: &Near) -> f64 {
    let (mut own, mut all) = (0.0, 0.0);
    for (p, q) in a.pixels().iter().zip(exact.pixels()) {
        if p != q {
            let square = (DVec3::from(*p) - DVec3::from(*q)).length_squared();
            all += square;
            if near.holds(p) || near.holds(q) {
                own += square;
            }
        }
    }
    own / all
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
    let width = 0.5 * f64::from(case.small.factor) * pixel;
    let name = called(scene, index);
    let mut ideas = Vec::new();
    let with = |by: DVec3, factor: f64| {
        let mut scene = Scene::clone(scene);
        scene.objects[index].shape = moved(&shape, by, factor);
        (factor > 0.0).then_some(scene)
    };
    let (small, control) = (&case.small, &case.control);

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
        let Some(found) = fit(small, control, &[start], &[width], &make)? else {
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
            make: Make::Scene(Box::new(other)),
        });
    }

    let make = |p: &[f64]| with(u * p[0] + v * p[1], libm::exp2(p[2]));
    let start = [by.x * pixel, -by.y * pixel, libm::log2(factor)];
    let Some(found) = fit(small, control, &start, &[width, width, 0.01], &make)? else {
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
        make: Make::Scene(Box::new(other)),
    });
    Ok(ideas)
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
