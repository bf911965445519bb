//! Reads and changes the fields of an image, a camera or a shape by their names.

use std::cmp::Ordering;

use super::{
    model::{Camera, Image, Lens, View},
    shape::Shape,
};
use crate::{
    math::compare_half_turns,
    schema::{CAMERA, FieldValue, IMAGE, Value},
};

/// Part of a scene that has fields: an image, a camera or a shape.
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
    pub fn value(mut self, field: &str) -> Option<Value> {
        if let Self::Shape(Shape::Box(cuboid)) = &self
            && let Some(value) = cuboid.center_or_size(field)
        {
            return Some(Value::Vector(value));
        }
        Some(self.field_mut(field)?.value())
    }

    /// Returns a copy in which `field` has the value `value`. Returns `None` if the owner does not
    /// use the field, or if the value has another type. Does not check the language's conditions.
    pub fn with(mut self, field: &str, value: Value) -> Option<Self> {
        if let (Self::Shape(Shape::Box(cuboid)), Value::Vector(to)) = (&mut self, value)
            && cuboid.set_center_or_size(field, to)
        {
            return Some(self);
        }
        self.field_mut(field)?.set(value)?;
        Some(self)
    }

    /// Returns a mutable reference to the field `name`. Returns `None` if the owner does not use
    /// the field. Also returns `None` for the width and the height of an image, because they are
    /// not of type `f64`, and for the `center` and the `size` of a box, because they are computed
    /// from its corners.
    fn field_mut(&mut self, name: &str) -> Option<&mut dyn FieldValue> {
        match self {
            Self::Image(Image {
                width: _,
                height: _,
                background,
            }) => IMAGE.background.of(name, background),
            Self::Camera(camera) => camera_field_mut(camera, name),
            Self::Shape(shape) => shape.field_mut(name),
        }
    }

    /// Returns whether the language's conditions on the fields hold, such as a radius above 0. They
    /// are checked in `f64`, so a value within rounding error of a limit may be misjudged.
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

fn camera_field_mut<'a>(camera: &'a mut Camera, name: &str) -> Option<&'a mut dyn FieldValue> {
    let Camera {
        eye,
        view,
        up,
        roll,
        view_height,
        lens,
        near,
        far,
    } = camera;
    let field = CAMERA.eye.of(name, eye).or(CAMERA.up.of(name, up));
    let field = field.or(CAMERA.roll.of(name, roll));
    let field = field.or(CAMERA.near.of(name, near));
    let field = field.or(far.as_mut().and_then(|far| CAMERA.far.of(name, far)));
    let field = field.or(match view {
        View::Lookat(point) => CAMERA.lookat.of(name, point),
        View::Direction(along) => CAMERA.direction.of(name, along),
    });
    field.or(match lens {
        Lens::Distance(d) => {
            let field = CAMERA.d.of(name, d);
            field.or(CAMERA.view_height.of(name, view_height))
        }
        Lens::Fov(angle) => CAMERA.fov.of(name, angle),
        Lens::HorizontalFov(angle) => CAMERA.hfov.of(name, angle),
    })
}
