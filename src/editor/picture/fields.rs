//! An object or the camera as values of fields, and back.

use std::cmp::Ordering;

use glam::DVec3;

use crate::{
    math::compare_half_turns,
    scene::{Camera, CenteredTriangle, Cuboid, Lens, Outline, Shape, View},
    schema::Value,
};

/// What is dragged.
#[derive(Clone, Copy, Debug)]
pub enum Subject {
    Object {
        shape: Shape,
        /// Whether a box is given by its corners.
        by_corners: bool,
    },
    Camera(Camera),
}

impl Subject {
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

    /// Whether its numbers are those of an object or a camera, so that questions about it have answers.
    pub fn is_possible(&self) -> bool {
        let are_finite = self.fields().iter().all(|(_, value)| value.is_finite());
        are_finite
            && match self {
                Self::Camera(camera) => {
                    let (from, to) = camera.view.ends(camera.eye);
                    let is_wide = match camera.lens {
                        Lens::Distance(d) => d > 0.0,
                        Lens::Fov(angle) | Lens::HorizontalFov(angle) => {
                            let compared = [0.0, 1.0].map(|half| compare_half_turns(angle, half));
                            compared == [Ordering::Greater, Ordering::Less]
                        }
                    };
                    from != to && is_wide
                }
                Self::Object { shape, .. } => match shape {
                    Shape::Sphere(sphere) => sphere.radius > 0.0,
                    Shape::Box(cuboid) => cuboid.min.cmplt(cuboid.max).all(),
                    Shape::Triangle(triangle) => match triangle.outline {
                        Outline::Centered(triangle) => triangle.normal != DVec3::ZERO,
                        Outline::Vertices(_) => true,
                    },
                    Shape::Checkerboard(_) => true,
                },
            }
    }

    /// The same with other values of these fields.
    pub fn with(&self, fields: &[(&'static str, Value)]) -> Self {
        use Value::{Number, Vector};
        let mut changed = *self;
        match &mut changed {
            Self::Camera(camera) => {
                for field in fields {
                    match *field {
                        ("eye", Vector(eye)) => camera.eye = eye,
                        ("lookat", Vector(point)) => camera.view = View::Lookat(point),
                        ("direction", Vector(along)) => camera.view = View::Direction(along),
                        ("roll", Value::Angle(roll)) => camera.roll = roll,
                        ("d", Number(d)) => camera.lens = Lens::Distance(d),
                        ("fov", Value::Angle(angle)) => camera.lens = Lens::Fov(angle),
                        ("hfov", Value::Angle(angle)) => camera.lens = Lens::HorizontalFov(angle),
                        _ => {}
                    }
                }
            }
            Self::Object { shape, .. } => {
                for &(name, value) in fields {
                    set(shape, name, value);
                }
            }
        }
        changed
    }
}

fn set(shape: &mut Shape, name: &str, value: Value) {
    use Value::{Number, Vector};
    match (shape, value) {
        (Shape::Sphere(sphere), Vector(center)) => sphere.center = center,
        (Shape::Sphere(sphere), Number(radius)) => sphere.radius = radius,
        (Shape::Box(cuboid), Vector(v)) => {
            let (center, size) = (cuboid.min.midpoint(cuboid.max), cuboid.max - cuboid.min);
            let around = |center, size| (center - size / 2.0, center + size / 2.0);
            (cuboid.min, cuboid.max) = match name {
                "min" => (v, cuboid.max),
                "max" => (cuboid.min, v),
                "center" => around(v, size),
                _ => around(center, v),
            };
        }
        (Shape::Triangle(triangle), value) => match (&mut triangle.outline, name, value) {
            (Outline::Centered(triangle), "centroid", Vector(v)) => triangle.centroid = v,
            (Outline::Centered(triangle), _, Vector(v)) => triangle.normal = v,
            (Outline::Centered(triangle), _, Value::Angle(spin)) => triangle.spin = spin,
            (Outline::Vertices([v0, v1, v2]), name, Vector(v)) => match name {
                "v0" => *v0 = v,
                "v1" => *v1 = v,
                _ => *v2 = v,
            },
            _ => {}
        },
        (Shape::Checkerboard(board), Number(y)) => board.y = y,
        _ => {}
    }
}
