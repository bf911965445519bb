//! Mistakes of one object: missing, of a wrong colour, size or place.

mod colors;
mod search;

use glam::DVec3;

use self::colors::{Near, color, share};
pub use self::{colors::colors, search::search};
use super::{Idea, Make};
use crate::{
    film::Film,
    math::Angle,
    scene::{Scene, Shape},
    tracer::vertices,
};

/// Of a scene with more objects only so many are looked at.
const OBJECTS: usize = 24;

/// An object may be wrong if the pixels of its colour have this share of the squared difference; noise may have the rest.
const PART: f64 = 0.1;

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

/// Those that can be named at once, of objects whose colour has a part in the difference.
pub fn ideas(a: &Film, exact: &Film, scene: &Scene) -> Vec<Idea> {
    let mut ideas = Vec::new();
    for (index, object) in scene.objects.iter().enumerate().take(OBJECTS) {
        if !has_part(a, exact, object.shape) {
            continue;
        }
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

/// Whether the pixels that have a shape's colour in either picture have a part in the difference: where the shape is and should not be, or
/// is not and should be, one of them has it.
fn has_part(a: &Film, exact: &Film, mut shape: Shape) -> bool {
    let mut colors = color(&mut shape).into_iter();
    colors.any(|color| share(a, exact, &Near::to(&color.to_linear())) > PART)
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
