//! Cameras, shapes and scenes for comparisons, with colours that identify the objects.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    color::Color,
    math::Angle,
    scene::{
        Camera, CenteredTriangle, Checkerboard, Count, Cuboid, FieldOwner, Image, Lens, Method,
        Object, Sampler, Scene, Shape, Sphere, Triangle, TriangleOutline, View,
    },
    schema::Value,
    source::{SourceId, Span},
};

/// Number of columns and of rows of a picture, unless a test sets other numbers. A larger picture
/// would make comparisons of all its pixels slower.
pub const SIZE: u32 = 64;

/// Returns a camera at `eye` that looks at `lookat`. Its other fields have the language's defaults.
pub fn camera(eye: DVec3, lookat: DVec3) -> Camera {
    Camera {
        eye,
        view: View::Lookat(lookat),
        up: DVec3::Y,
        roll: Angle::default(),
        lens: Lens::Distance(2.0),
        view_height: 2.0,
        near: 0.0,
        far: None,
    }
}

/// Returns a camera at `eye` that looks along `direction`. Its other fields have the language's
/// defaults.
pub fn along(eye: DVec3, direction: DVec3) -> Camera {
    Camera {
        view: View::Direction(direction),
        ..camera(eye, DVec3::ZERO)
    }
}

/// Returns a black sphere.
pub fn sphere(center: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere {
        center,
        radius,
        color: Color::BLACK,
    })
}

/// Returns a black box with the least corner `min` and the greatest corner `max`.
pub fn cuboid(min: DVec3, max: DVec3) -> Shape {
    Shape::Box(Cuboid {
        min,
        max,
        color: Color::BLACK,
        faces: None,
    })
}

/// Returns a black triangle that is not turned about its normal.
pub fn triangle(centroid: DVec3, normal: DVec3, sides: DVec3) -> Shape {
    spun(centroid, normal, sides, 0.0)
}

/// Returns a black triangle that is turned about its normal by `spin` degrees.
pub fn spun(centroid: DVec3, normal: DVec3, sides: DVec3, spin: f64) -> Shape {
    Shape::Triangle(Triangle {
        outline: TriangleOutline::Centered(CenteredTriangle {
            centroid,
            normal,
            sides,
            spin: Angle::from_degrees(spin),
        }),
        color: Color::BLACK,
    })
}

/// Returns a checkerboard at height `y` with squares of side `square`. Both of its colours are
/// black.
pub fn board(y: f64, square: f64) -> Shape {
    Shape::Checkerboard(Checkerboard {
        y,
        square,
        colors: [Color::BLACK; 2],
    })
}

/// Returns the colour that identifies the object with the index `object`. If `is_odd`, returns the
/// second colour of this object, which must be a checkerboard.
pub fn color(object: usize, is_odd: bool) -> Color {
    let [low, high] = (object as u16 + 1).to_le_bytes();
    Color::from_bytes([low, u8::from(is_odd), high])
}

/// Returns a scene with the given shapes. Each shape gets the colours that identify it (see
/// [`color`]).
pub fn scene(camera: Camera, shapes: &[Shape]) -> Scene {
    let objects = shapes.iter().enumerate().map(|(object, shape)| {
        let own = [false, true].map(|is_odd| color(object, is_odd));
        let owner = FieldOwner::Shape(*shape);
        let of_one_color = owner.with("color", Value::Color(own[0]));
        let colored = of_one_color.or_else(|| owner.with("colors", Value::Colors(own)));
        let shape = match colored {
            Some(FieldOwner::Shape(shape)) => shape,
            _ => *shape,
        };
        Object {
            name: None,
            indices: Box::default(),
            shape,
            span: Span::new(SourceId::File, 0, 0),
        }
    });
    Scene {
        image: Image {
            width: SIZE,
            height: SIZE,
            background: Color::BLACK,
        },
        camera,
        sampler: Sampler {
            method: Method::Random,
            count: Count::PerPixel(1),
            seed: 0,
        },
        objects: Arc::new(objects.collect()),
    }
}
