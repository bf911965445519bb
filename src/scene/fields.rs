//! The fields of an image, a camera and a shape by their names: the value of each, and the same
//! with another one.

use std::cmp::Ordering;

use glam::DVec3;

use super::model::{Camera, Image, Lens, Outline, Shape, View};
use crate::{
    color::Color,
    math::{Angle, compare_half_turns},
    schema::Value,
};

/// What has fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// The picture.
    Image(Image),
    /// The camera.
    Camera(Camera),
    /// An object's shape.
    Shape(Shape),
}

/// Where a field's value stands.
enum Place<'a> {
    Number(&'a mut f64),
    Angle(&'a mut Angle),
    Vector(&'a mut DVec3),
    Color(&'a mut Color),
    Colors(&'a mut [Color; 2]),
    FaceColors(&'a mut [Color; 3]),
}

impl Part {
    /// The value of a field, if it is used: of alternatives the one that it is written in. A box
    /// has all of its four.
    pub fn value(mut self, field: &str) -> Option<Value> {
        if let (Self::Shape(Shape::Box(cuboid)), "center" | "size") = (self, field) {
            return Some(Value::Vector(tidy(match field {
                "center" => cuboid.min.midpoint(cuboid.max),
                _ => cuboid.max - cuboid.min,
            })));
        }
        Some(match self.place(field)? {
            Place::Number(number) => Value::Number(*number),
            Place::Angle(angle) => Value::Angle(*angle),
            Place::Vector(vector) => Value::Vector(*vector),
            Place::Color(color) => Value::Color(*color),
            Place::Colors(colors) => Value::Colors(*colors),
            Place::FaceColors(colors) => Value::FaceColors(*colors),
        })
    }

    /// The same with another value of a field that is used. Whether the language's conditions hold
    /// is not asked.
    pub fn with(mut self, field: &str, value: Value) -> Option<Self> {
        if let (Self::Shape(Shape::Box(cuboid)), "center" | "size", Value::Vector(to)) =
            (&mut self, field, value)
        {
            let (center, half) = match field {
                "center" => (to, (cuboid.max - cuboid.min) / 2.0),
                _ => (tidy(cuboid.min.midpoint(cuboid.max)), to / 2.0),
            };
            (cuboid.min, cuboid.max) = (center - half, center + half);
            return Some(self);
        }
        match (self.place(field)?, value) {
            (Place::Number(place), Value::Number(number)) => *place = number,
            (Place::Angle(place), Value::Angle(angle)) => *place = angle,
            (Place::Vector(place), Value::Vector(vector)) => *place = vector,
            (Place::Color(place), Value::Color(color)) => *place = color,
            (Place::Colors(place), Value::Colors(colors)) => *place = colors,
            (Place::FaceColors(place), Value::FaceColors(colors)) => *place = colors,
            _ => return None,
        }
        Some(self)
    }

    fn place(&mut self, field: &str) -> Option<Place<'_>> {
        let shape = match self {
            Self::Image(image) => {
                return (field == "background").then_some(Place::Color(&mut image.background));
            }
            Self::Camera(camera) => return camera_place(camera, field),
            Self::Shape(shape) => shape,
        };
        Some(match (shape, field) {
            (Shape::Sphere(sphere), "center") => Place::Vector(&mut sphere.center),
            (Shape::Sphere(sphere), "radius") => Place::Number(&mut sphere.radius),
            (Shape::Sphere(sphere), "color") => Place::Color(&mut sphere.color),
            (Shape::Triangle(triangle), "color") => Place::Color(&mut triangle.color),
            (Shape::Triangle(triangle), _) => match (&mut triangle.outline, field) {
                (Outline::Vertices([vertex, _, _]), "v0")
                | (Outline::Vertices([_, vertex, _]), "v1")
                | (Outline::Vertices([_, _, vertex]), "v2") => Place::Vector(vertex),
                (Outline::Centered(own), "centroid") => Place::Vector(&mut own.centroid),
                (Outline::Centered(own), "normal") => Place::Vector(&mut own.normal),
                (Outline::Centered(own), "sides") => Place::Vector(&mut own.sides),
                (Outline::Centered(own), "spin") => Place::Angle(&mut own.spin),
                _ => return None,
            },
            (Shape::Box(cuboid), "min") => Place::Vector(&mut cuboid.min),
            (Shape::Box(cuboid), "max") => Place::Vector(&mut cuboid.max),
            (Shape::Box(cuboid), "color" | "colors") => match (&mut cuboid.faces, field) {
                (Some(faces), "colors") => Place::FaceColors(faces),
                (None, "color") => Place::Color(&mut cuboid.color),
                _ => return None,
            },
            (Shape::Checkerboard(board), "y") => Place::Number(&mut board.y),
            (Shape::Checkerboard(board), "square") => Place::Number(&mut board.square),
            (Shape::Checkerboard(board), "colors") => Place::Colors(&mut board.colors),
            _ => return None,
        })
    }

    /// Whether the language's conditions hold, in rounded numbers.
    pub fn is_possible(&self) -> bool {
        match self {
            Self::Image(_) => true,
            Self::Camera(camera) => {
                let (from, to) = camera.view.ends(camera.eye);
                let sees = match camera.lens {
                    Lens::Distance(d) => d > 0.0 && d.is_finite(),
                    Lens::Fov(angle) | Lens::HorizontalFov(angle) => {
                        let compared = [0.0, 1.0].map(|half| compare_half_turns(angle, half));
                        compared == [Ordering::Greater, Ordering::Less]
                    }
                };
                sees && from != to
                    && [camera.eye, from, to].iter().all(|point| point.is_finite())
                    && camera.roll.is_finite()
                    && camera.near >= 0.0
                    && camera.far.is_none_or(|far| far > camera.near)
            }
            Self::Shape(Shape::Sphere(sphere)) => {
                sphere.radius > 0.0 && sphere.radius.is_finite() && sphere.center.is_finite()
            }
            Self::Shape(Shape::Triangle(triangle)) => match triangle.outline {
                Outline::Vertices([a, b, c]) => (b - a).cross(c - a).length_squared() > 0.0,
                Outline::Centered(own) => {
                    let [a, b, c] = own.sides.to_array();
                    let is_triangle = a < b + c && b < a + c && c < a + b;
                    own.normal.length_squared() > 0.0 && is_triangle && own.centroid.is_finite()
                }
            },
            Self::Shape(Shape::Box(cuboid)) => {
                cuboid.min.cmplt(cuboid.max).all()
                    && cuboid.min.is_finite()
                    && cuboid.max.is_finite()
            }
            Self::Shape(Shape::Checkerboard(board)) => {
                board.square > 0.0 && board.square.is_finite() && board.y.is_finite()
            }
        }
    }
}

fn camera_place<'a>(camera: &'a mut Camera, field: &str) -> Option<Place<'a>> {
    Some(match (field, &mut camera.view, &mut camera.lens) {
        ("eye", ..) => Place::Vector(&mut camera.eye),
        ("lookat", View::Lookat(vector), _) | ("direction", View::Direction(vector), _) => {
            Place::Vector(vector)
        }
        ("up", ..) => Place::Vector(&mut camera.up),
        ("roll", ..) => Place::Angle(&mut camera.roll),
        ("d", _, Lens::Distance(d)) => Place::Number(d),
        ("view_height", _, Lens::Distance(_)) => Place::Number(&mut camera.view_height),
        ("fov", _, Lens::Fov(angle)) | ("hfov", _, Lens::HorizontalFov(angle)) => {
            Place::Angle(angle)
        }
        ("near", ..) => Place::Number(&mut camera.near),
        ("far", ..) => Place::Number(camera.far.as_mut()?),
        _ => return None,
    })
}

/// Without what the rounding of two corners leaves behind the fifteenth digit.
fn tidy(v: DVec3) -> DVec3 {
    let tidy = |x: f64| format!("{x:.14e}").parse().unwrap_or(x);
    DVec3::from(v.to_array().map(tidy))
}
