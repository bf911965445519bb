//! What is said of numbers that are others, and whether anybody could see it.

use glam::{DVec2, DVec3};

use super::{
    candidate::{Candidate, Cause, Named},
    parameters::Parameter,
    textbook::{Axes, vertices},
};
use crate::{
    numbers::{found_near, short},
    scene::{Scene, Shape},
};

/// A move of less than this, in pixels, is not named.
pub const HALF_PIXEL: f64 = 0.5;

/// A parameter with other numbers, as a mistake.
pub fn numbers(scene: &Scene, parameter: &Parameter, numbers: Vec<f64>) -> Named {
    Named {
        id: match parameter.fields.as_slice() {
            [one] => one,
            _ => "eye_and_lookat",
        },
        message: String::new(),
        help: help(scene, parameter),
        cause: Cause::Numbers(parameter.clone(), numbers),
    }
}

fn help(scene: &Scene, parameter: &Parameter) -> String {
    let set = parameter.arguments(scene).join(" and ");
    match set.is_empty() {
        true => "compare it with the scene".to_owned(),
        false => format!("the scene says {set}"),
    }
}

/// What a mistake is, in words, with its numbers.
pub fn message(scene: &Scene, named: &Named) -> String {
    let Cause::Numbers(parameter, numbers) = &named.cause else {
        return named.message.clone();
    };
    let name = parameter.owner.name(scene);
    let should = parameter.numbers(scene);
    if parameter.fields.len() > 1 {
        return format!(
            "{name} stands and looks elsewhere: at {} towards {}",
            vector(&numbers[..3]),
            vector(&numbers[3..])
        );
    }
    let is = parameter
        .put(scene, numbers)
        .map(|scene| parameter.values(&scene));
    let written = |values: &[crate::schema::Value]| {
        values.first().map(ToString::to_string).unwrap_or_default()
    };
    let field = parameter.fields[0];
    let other: Vec<usize> = (0..numbers.len())
        .filter(|&i| numbers[i] != should[i])
        .collect();
    if let ("center" | "centroid", [1]) = (field, other.as_slice()) {
        let by = numbers[1] - should[1];
        let way = if by > 0.0 { "high" } else { "low" };
        return format!("{name} is {} too {way}", found_near(by.abs(), 0.0));
    }
    let is = is.map_or_else(|| vector(numbers), |values| written(&values));
    let should = written(&parameter.values(scene));
    let kind = match field {
        "color" | "colors" | "background" => "wrong colour",
        "center" | "centroid" => "wrong place",
        "radius" | "size" | "sides" | "square" => "wrong size",
        _ => "wrong value",
    };
    format!("{name} has a {kind}: its {field} is {is} instead of {should}")
}

fn vector(numbers: &[f64]) -> String {
    let numbers: Vec<_> = numbers.iter().map(|x| short(*x)).collect();
    format!("({})", numbers.join(", "))
}

/// A number rounded to a power of ten that is no more than what it may be off.
pub fn rounded(x: f64, error: f64) -> f64 {
    if !(error > 0.0 && error.is_finite()) {
        return x;
    }
    let digits = (-libm::log10(error).floor()).clamp(-12.0, 12.0);
    let unit = libm::pow(10.0, digits);
    let rounded = (x * unit).round() / unit;
    // Without the tail that a multiple of a power of ten has in binary, and without −0.
    format!("{rounded:.12e}").parse().unwrap_or(x) + 0.0
}

/// Whether what one candidate has beside another can be seen: a colour, a row of the table, or a move of half a pixel.
pub fn is_seen(scene: &Scene, from: &Candidate, to: &Candidate) -> bool {
    match to.named.last().map(|named| &named.cause) {
        Some(Cause::Numbers(parameter, _)) if !parameter.is_color() => {
            let others = (0..scene.objects.len()).map(|object| off(&from.scene, &to.scene, object));
            // A plane that clips moves nothing.
            others.fold(0.0, f64::max) >= HALF_PIXEL
                || matches!(parameter.fields[0], "near" | "far")
        }
        _ => true,
    }
}

/// How far an object is moved in the picture from one scene to another, in pixels: the farthest of some points of it.
pub fn off(from: &Scene, to: &Scene, object: usize) -> f64 {
    let axes = [from, to].map(|scene| Axes::new(&scene.camera, &scene.image));
    let points = [from, to].map(|scene| points(&scene.objects[object].shape, &axes[0], from));
    let [before, after] = points;
    let moved = before.into_iter().zip(after).filter_map(|(before, after)| {
        let (before, after) = (axes[0].place(before)?, axes[1].place(after));
        // What is not before the eye any more is far off.
        let size = DVec2::new(f64::from(from.image.width), f64::from(from.image.height));
        let is_near = before.cmpge(-size).all() && before.cmple(2.0 * size).all();
        is_near.then(|| {
            after.map_or(size.length(), |after| {
                before.distance(after).min(size.length())
            })
        })
    });
    moved.fold(0.0, f64::max)
}

/// Points that are fixed to a shape, those of a board in its squares.
fn points(shape: &Shape, axes: &Axes, scene: &Scene) -> Vec<DVec3> {
    match shape {
        Shape::Sphere(sphere) => {
            let ways = [DVec3::X, DVec3::Y, DVec3::Z];
            ways.into_iter()
                .flat_map(|way| [way, -way])
                .map(|way| sphere.center + sphere.radius * way)
                .collect()
        }
        Shape::Triangle(triangle) => vertices(&triangle.outline).to_vec(),
        Shape::Box(cuboid) => (0..8)
            .map(|corner| {
                let is_max = |bit: u32| corner >> bit & 1 == 1;
                DVec3::select(
                    glam::BVec3::new(is_max(0), is_max(1), is_max(2)),
                    cuboid.max,
                    cuboid.min,
                )
            })
            .collect(),
        Shape::Checkerboard(board) => {
            // What the scene's own board shows in a few places of the picture, in squares.
            let own = scene.objects.iter().find_map(|object| match object.shape {
                Shape::Checkerboard(board) => Some(board),
                _ => None,
            });
            let own = own.unwrap_or(*board);
            let size = DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height));
            let places =
                (0..25).map(|at| size * DVec2::new(f64::from(at % 5), f64::from(at / 5)) / 4.0);
            let crossing = |place| {
                let ray = axes.ray(place);
                let t = (own.y - scene.camera.eye.y) / ray.y;
                // Beyond some hundred squares nothing of them is seen.
                let is_seen = t > 0.0 && t < 100.0 * own.square;
                is_seen.then(|| (scene.camera.eye + t * ray) / own.square)
            };
            let squares = places.filter_map(crossing);
            squares
                .map(|at| DVec3::new(at.x * board.square, board.y, at.z * board.square))
                .collect()
        }
    }
}
