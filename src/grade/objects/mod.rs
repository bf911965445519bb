//! Mistakes of one object: missing, of a wrong colour, size or place.

mod colors;
mod confined;
mod palette;
mod search;
mod slopes;

use glam::DVec3;

pub use self::{
    colors::{Near, color, colors},
    confined::{confined, is_in_one_part, reaching_out},
    search::search,
    slopes::{Slope, slopes},
};
use super::{Case, Idea, Make};
use crate::{
    math::Angle,
    scene::{CenteredTriangle, Cuboid, Outline, Scene, Shape, Triangle},
    tracer::vertices,
};

/// So many objects are tried as they may be wrong, and so many are searched for, those in whose part of the picture most of the difference is.
/// Both are choices, for time: of one wrong object the part has all of it, so that only those seen around it come before it. Each that is
/// tried takes a part of the picture, each that is searched for some dozen fits.
const TRIED: usize = 24;
const SEARCHED: usize = 6;

/// So many objects are moved a little, to see what that changes: those that are tried.
const SLOPES: usize = TRIED;

/// So many pixels of an object show where it is: their mean place is known to a fifth of what one of them tells.
const ENOUGH: u64 = 6;

/// What an object is called.
pub fn called(scene: &Scene, index: usize) -> String {
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
    let before = std::mem::replace(&mut scene.objects[index].shape, shape);
    Make::Object(Box::new(scene), Box::new([Some(before), Some(shape)]))
}

/// Those that can be named at once, of objects in whose part of the picture much of the difference is.
pub fn ideas(case: &Case) -> Vec<Idea> {
    let scene = &case.full.scene;
    let mut ideas = Vec::new();
    // Where an object would be twice as large, it is wherever one of these is; nearly, if it is spun.
    for (_, index) in likeliest(case, 2.0).into_iter().take(case.most(TRIED)) {
        ideas.push(missing(scene, index));
        ideas.extend(wrong(scene, index));
    }
    ideas
}

/// The objects in whose part of the picture, if they were so much larger, the difference is, and its share there; first those where there is
/// more of it than noise has there.
fn likeliest(case: &Case, factor: f64) -> Vec<(f64, usize)> {
    let objects = case.full.scene.objects.iter().enumerate();
    let mut found: Vec<_> = objects
        .filter_map(|(index, object)| {
            let part = case
                .view
                .extent(&moved(&object.shape, DVec3::ZERO, factor))?;
            let share = case.differences.share(part);
            (share > 0.0).then(|| (case.excess(part), share, index))
        })
        .collect();
    found.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.2.cmp(&q.2)));
    found
        .into_iter()
        .map(|(_, share, index)| (share, index))
        .collect()
}

fn missing(scene: &Scene, index: usize) -> Idea {
    let mut without = Scene::clone(scene);
    let object = without.objects.remove(index);
    Idea {
        mistake: "object_missing",
        message: format!("{} is missing", called(scene, index)),
        help: "either it is not drawn, or no ray is found to hit it: look at the equation of its hits, and at their sign (t > 0)".to_owned(),
        make: Make::Object(Box::new(without), Box::new([Some(object.shape), None])),
    }
}

fn wrong(scene: &Scene, index: usize) -> impl Iterator<Item = Idea> {
    let name = called(scene, index);
    let wrong = wrong_shapes(&scene.objects[index].shape).into_iter();
    wrong.map(move |(mistake, message, help, shape)| Idea {
        mistake,
        message: format!("{name} {message}"),
        help: help.to_owned(),
        make: with_shape(scene, index, shape),
    })
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
            wrong.extend(resized(cuboid));
        }
        Shape::Triangle(Triangle {
            outline: Outline::Vertices(_),
            ..
        }) => {}
        Shape::Triangle(
            whole @ Triangle {
                outline: Outline::Centered(triangle),
                ..
            },
        ) => {
            let [left, right, apex] = vertices(&whole);
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
            let mut changed = |message, help, change: &dyn Fn(&mut CenteredTriangle)| {
                let mut other = triangle;
                change(&mut other);
                let other = Shape::Triangle(Triangle {
                    outline: Outline::Centered(other),
                    ..whole
                });
                wrong.push(("object_orientation", message, help, other));
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
            let normal = "normal is (x, y, z), and points to the side from which the triangle is seen as it is described";
            for (message, sign) in [
                (
                    "has a normal whose x has the wrong sign",
                    DVec3::new(-1.0, 1.0, 1.0),
                ),
                (
                    "has a normal whose y has the wrong sign",
                    DVec3::new(1.0, -1.0, 1.0),
                ),
                (
                    "has a normal whose z has the wrong sign",
                    DVec3::new(1.0, 1.0, -1.0),
                ),
            ] {
                changed(message, normal, &|other| other.normal *= sign);
            }
            for (message, exchange) in [
                (
                    "has a normal whose x and y are exchanged",
                    exchanged([1, 0, 2]),
                ),
                (
                    "has a normal whose x and z are exchanged",
                    exchanged([2, 1, 0]),
                ),
                (
                    "has a normal whose y and z are exchanged",
                    exchanged([0, 2, 1]),
                ),
            ] {
                changed(message, normal, &|other| {
                    other.normal = exchange(other.normal)
                });
            }
            let sides = "sides are (a, b, c): a from the base's left end to the apex, b from its right end, c the base";
            for (message, exchange) in [
                ("has its sides a and c exchanged", exchanged([2, 1, 0])),
                ("has its sides b and c exchanged", exchanged([0, 2, 1])),
                ("has its sides in the order b, c, a", exchanged([1, 2, 0])),
                ("has its sides in the order c, a, b", exchanged([2, 0, 1])),
            ] {
                changed(message, sides, &|other| other.sides = exchange(other.sides));
            }
        }
        _ => {}
    }
    wrong
}

/// A vector whose components are those at these places of another one.
fn exchanged(places: [usize; 3]) -> impl Fn(DVec3) -> DVec3 {
    move |v| DVec3::from(places.map(|place| v[place]))
}

/// A box of wrong sizes around its centre.
fn resized(cuboid: Cuboid) -> impl Iterator<Item = Wrong> {
    let (middle, size) = ((cuboid.min + cuboid.max) / 2.0, cuboid.max - cuboid.min);
    let help = "size is (x, y, z): the lengths of the edges along the three axes, half of each on either side of the center";
    let sizes = [
        (
            "has its sizes along x and y exchanged",
            exchanged([1, 0, 2])(size),
        ),
        (
            "has its sizes along x and z exchanged",
            exchanged([2, 1, 0])(size),
        ),
        (
            "has its sizes along y and z exchanged",
            exchanged([0, 2, 1])(size),
        ),
        (
            "is twice as long along x as it should be",
            size * DVec3::new(2.0, 1.0, 1.0),
        ),
        (
            "is twice as long along y as it should be",
            size * DVec3::new(1.0, 2.0, 1.0),
        ),
        (
            "is twice as long along z as it should be",
            size * DVec3::new(1.0, 1.0, 2.0),
        ),
        (
            "is half as long along x as it should be",
            size * DVec3::new(0.5, 1.0, 1.0),
        ),
        (
            "is half as long along y as it should be",
            size * DVec3::new(1.0, 0.5, 1.0),
        ),
        (
            "is half as long along z as it should be",
            size * DVec3::new(1.0, 1.0, 0.5),
        ),
    ];
    sizes.into_iter().map(move |(message, size)| {
        let (min, max) = (middle - size / 2.0, middle + size / 2.0);
        let shape = Shape::Box(Cuboid { min, max, ..cuboid });
        ("object_size", message, help, shape)
    })
}

/// A shape somewhere else, larger or smaller about its middle.
pub fn moved(shape: &Shape, by: DVec3, factor: f64) -> Shape {
    let mut shape = *shape;
    match &mut shape {
        Shape::Sphere(sphere) => {
            sphere.center += by;
            sphere.radius *= factor;
        }
        Shape::Triangle(triangle) => match &mut triangle.outline {
            Outline::Centered(triangle) => {
                triangle.centroid += by;
                triangle.sides *= factor;
            }
            Outline::Vertices(vertices) => {
                let middle = Outline::Vertices(*vertices).centroid();
                *vertices = vertices.map(|vertex| middle + by + (vertex - middle) * factor);
            }
        },
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
