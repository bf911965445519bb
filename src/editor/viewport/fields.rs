//! An object or the camera as values of fields, and by how much these have to change.

use std::cmp::Ordering;

use crate::{
    math::{Angle, compare_half_turns},
    scene::{Camera, CenteredTriangle, Cuboid, Lens, Outline, Shape, View},
    schema::Value,
};

/// What can be dragged.
#[derive(Clone, Copy, Debug)]
pub enum Movable {
    Object {
        shape: Shape,
        /// Whether a box is given by its corners.
        by_corners: bool,
    },
    Camera(Camera),
}

impl Movable {
    /// The fields that a drag may change.
    pub fn fields(&self) -> Vec<(&'static str, Value)> {
        use Value::{Number, Vector};
        let (shape, by_corners) = match self {
            Self::Camera(camera) => {
                let view = match camera.view {
                    View::Lookat(point) => ("lookat", Vector(point)),
                    View::Direction(direction) => ("direction", Vector(direction)),
                };
                let lens = match camera.lens {
                    Lens::Distance(d) => ("d", Number(d)),
                    Lens::Fov(angle) => ("fov", Value::Angle(angle)),
                    Lens::HorizontalFov(angle) => ("hfov", Value::Angle(angle)),
                };
                let roll = ("roll", Value::Angle(camera.roll));
                return vec![("eye", Vector(camera.eye)), view, roll, lens];
            }
            Self::Object { shape, by_corners } => (shape, *by_corners),
        };
        match *shape {
            Shape::Sphere(sphere) => vec![
                ("center", Vector(sphere.center)),
                ("radius", Number(sphere.radius)),
            ],
            Shape::Box(Cuboid { min, max, .. }) if by_corners => {
                vec![("min", Vector(min)), ("max", Vector(max))]
            }
            Shape::Box(Cuboid { min, max, .. }) => vec![
                ("center", Vector(min.midpoint(max))),
                ("size", Vector(max - min)),
            ],
            Shape::Triangle(triangle) => match triangle.outline {
                Outline::Centered(CenteredTriangle {
                    centroid,
                    normal,
                    spin,
                    ..
                }) => vec![
                    ("centroid", Vector(centroid)),
                    ("normal", Vector(normal)),
                    ("spin", Value::Angle(spin)),
                ],
                Outline::Vertices([v0, v1, v2]) => {
                    vec![("v0", Vector(v0)), ("v1", Vector(v1)), ("v2", Vector(v2))]
                }
            },
            Shape::Checkerboard(board) => vec![("y", Number(board.y))],
        }
    }

    /// Whether its numbers are finite and, where it is a camera, such that it sees anything. The rest is for the language to judge.
    pub fn is_possible(&self) -> bool {
        let are_finite = self.fields().iter().all(|(_, value)| value.is_finite());
        let Self::Camera(camera) = self else {
            return are_finite;
        };
        let (from, to) = camera.view.ends(camera.eye);
        let is_wide = match camera.lens {
            Lens::Distance(d) => d > 0.0,
            Lens::Fov(angle) | Lens::HorizontalFov(angle) => {
                let compared = [0.0, 1.0].map(|half| compare_half_turns(angle, half));
                compared == [Ordering::Greater, Ordering::Less]
            }
        };
        are_finite && from != to && is_wide
    }
}

/// A field that has to change.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    /// The field.
    pub name: &'static str,
    /// The value that it has.
    pub from: Value,
    /// The amount that is to be added to it.
    pub by: Value,
}

/// The fields in which two differ.
pub fn changes(current: &Movable, ideal: &Movable) -> Vec<Change> {
    let pairs = current.fields().into_iter().zip(ideal.fields());
    let changes = pairs.map(|((name, from), (_, to))| Change {
        name,
        from,
        by: difference(to, from),
    });
    changes.filter(|change| change.size() != 0.0).collect()
}

/// What has to be added to one value so that it is the other; of angles in degrees.
pub fn difference(to: Value, from: Value) -> Value {
    match (to, from) {
        (Value::Number(to), Value::Number(from)) => Value::Number(to - from),
        (Value::Vector(to), Value::Vector(from)) => Value::Vector(to - from),
        (Value::Angle(to), Value::Angle(from)) => {
            Value::Angle(Angle::from_degrees(degrees(to) - degrees(from)))
        }
        (to, _) => to,
    }
}

impl Change {
    /// The greatest number in the amount; of an angle, in degrees.
    pub fn size(&self) -> f64 {
        match self.by {
            Value::Number(number) => number.abs(),
            Value::Vector(vector) => vector.abs().max_element(),
            Value::Angle(angle) => degrees(angle).abs(),
            _ => 0.0,
        }
    }
}

/// An angle in degrees.
pub fn degrees(angle: Angle) -> f64 {
    angle.degrees + angle.radians.to_degrees()
}
