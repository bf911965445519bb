//! Reads and changes the fields of an image, a camera or a shape by their names.

use std::cmp::Ordering;

use super::{
    field_ref::FieldRef,
    model::{Camera, Image, Lens, View},
    shape::Shape,
};
use crate::{
    math::compare_half_turns,
    schema::{CAMERA, IMAGE, Value},
};

/// An image, a camera or a shape: the owner of fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldOwner {
    /// The picture.
    Image(Image),
    /// The camera.
    Camera(Camera),
    /// An object's shape.
    Shape(Shape),
}

impl FieldOwner {
    /// Returns the value of a field. Returns `None` if the owner does not use the field, such as
    /// `direction` of a camera that has a `lookat`. For a box, all of `min`, `max`, `center` and
    /// `size` are available.
    pub fn value(self, field: &str) -> Option<Value> {
        match self {
            Self::Image(mut image) => Some(image_field(&mut image, field)?.get()),
            Self::Camera(mut camera) => Some(camera_field(&mut camera, field)?.get()),
            Self::Shape(shape) => shape.field(field),
        }
    }

    /// Returns a copy in which `field` has the value `value`. Returns `None` if the owner does not
    /// use the field, or if the value has another type. Does not check the language's conditions.
    pub fn with(mut self, field: &str, value: Value) -> Option<Self> {
        match &mut self {
            Self::Image(image) => image_field(image, field)?.set(value)?,
            Self::Camera(camera) => camera_field(camera, field)?.set(value)?,
            Self::Shape(shape) => *shape = shape.with_field(field, value)?,
        }
        Some(self)
    }

    /// Returns whether all fields meet the language's conditions. These are checked in `f64`, so a
    /// value within rounding error of a limit may be misjudged.
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
            Self::Shape(shape) => shape.is_possible(),
        }
    }
}

/// Returns a reference to a field of an image. Returns `None` for `width` and `height`, which are
/// not `f64`s.
fn image_field<'a>(image: &'a mut Image, field: &str) -> Option<FieldRef<'a>> {
    let Image {
        width: _,
        height: _,
        background,
    } = image;
    (field == IMAGE.background.name).then_some(FieldRef::Color(background))
}

fn camera_field<'a>(camera: &'a mut Camera, field: &str) -> Option<FieldRef<'a>> {
    let Camera {
        eye,
        view,
        up,
        roll,
        lens,
        view_height,
        near,
        far,
    } = camera;
    Some(match (view, lens) {
        _ if field == CAMERA.eye.name => FieldRef::Vector(eye),
        _ if field == CAMERA.up.name => FieldRef::Vector(up),
        _ if field == CAMERA.roll.name => FieldRef::Angle(roll),
        _ if field == CAMERA.near.name => FieldRef::Number(near),
        _ if field == CAMERA.far.name => FieldRef::Number(far.as_mut()?),
        (View::Lookat(point), _) if field == CAMERA.lookat.name => FieldRef::Vector(point),
        (View::Direction(along), _) if field == CAMERA.direction.name => FieldRef::Vector(along),
        (_, Lens::Distance(d)) if field == CAMERA.d.name => FieldRef::Number(d),
        (_, Lens::Distance(_)) if field == CAMERA.view_height.name => FieldRef::Number(view_height),
        (_, Lens::Fov(angle)) if field == CAMERA.fov.name => FieldRef::Angle(angle),
        (_, Lens::HorizontalFov(angle)) if field == CAMERA.hfov.name => FieldRef::Angle(angle),
        _ => return None,
    })
}
