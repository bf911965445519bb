//! The fields of an image, a camera and a shape by their names.

use std::cmp::Ordering;

use super::{
    model::{Camera, Image, Lens, View},
    shape::Shape,
};
use crate::{
    math::compare_half_turns,
    schema::{CAMERA, IMAGE, NamedField, Value},
};

/// An image, a camera or a shape, whose fields are read and changed by their names.
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
    /// Returns the value of a field; `None` if the field is not used, because another way of a
    /// choice is taken. A box has the fields of both of its ways.
    pub fn value(mut self, field: &str) -> Option<Value> {
        if let Self::Shape(Shape::Box(cuboid)) = &self
            && let Some(value) = cuboid.center_or_size(field)
        {
            return Some(Value::Vector(value));
        }
        let mut fields = self.fields().into_iter();
        let (_, found) = fields.find(|(name, _)| *name == field)?;
        Some(found.value())
    }

    /// Returns the same with another value of a field; `None` if the field is not used, or the
    /// value is of another type. The language's conditions are not checked.
    pub fn with(mut self, field: &str, value: Value) -> Option<Self> {
        if let (Self::Shape(Shape::Box(cuboid)), Value::Vector(to)) = (&mut self, value)
            && cuboid.set_center_or_size(field, to)
        {
            return Some(self);
        }
        let is_it = |(name, _): &NamedField<'_>| *name == field;
        self.fields().into_iter().find(is_it)?.1.set(value)?;
        Some(self)
    }

    /// Returns the fields that are used, except the width and the height of an image, which are no
    /// `f64`s, and the derived ones of a box.
    fn fields(&mut self) -> Vec<NamedField<'_>> {
        match self {
            Self::Image(Image {
                width: _,
                height: _,
                background,
            }) => vec![IMAGE.background.of(background)],
            Self::Camera(camera) => camera_fields(camera),
            Self::Shape(shape) => shape.fields(),
        }
    }

    /// Whether the language's conditions hold, as far as rounded numbers tell.
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

fn camera_fields(camera: &mut Camera) -> Vec<NamedField<'_>> {
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
    let mut fields = vec![CAMERA.eye.of(eye), CAMERA.up.of(up), CAMERA.roll.of(roll)];
    fields.push(CAMERA.near.of(near));
    fields.extend(far.as_mut().map(|far| CAMERA.far.of(far)));
    fields.push(match view {
        View::Lookat(point) => CAMERA.lookat.of(point),
        View::Direction(along) => CAMERA.direction.of(along),
    });
    match lens {
        Lens::Distance(d) => fields.extend([CAMERA.d.of(d), CAMERA.view_height.of(view_height)]),
        Lens::Fov(angle) => fields.push(CAMERA.fov.of(angle)),
        Lens::HorizontalFov(angle) => fields.push(CAMERA.hfov.of(angle)),
    }
    fields
}
