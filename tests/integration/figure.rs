//! The scene of the assignment as data, for the tests that need one.

use glam::dvec3;
use pinhole::{
    color::Color,
    math::Angle,
    scene::{
        Camera, Checkerboard, Count, Cuboid, Image, Lens, Method, Object, Sampler, Scene, Shape,
        Sphere, Triangle, View,
    },
    source::{SourceId, Span},
};

pub fn figure(width: u32, height: u32, method: Method, count: Count) -> Scene {
    let shapes = [
        Shape::Sphere(Sphere {
            center: dvec3(-1.6, 1.0, 0.0),
            radius: 1.0,
            color: Color::from_bytes([128, 128, 0]),
        }),
        Shape::Triangle(Triangle {
            centroid: dvec3(0.2, 1.0, 0.6),
            normal: dvec3(0.3, 0.0, 1.0),
            sides: dvec3(2.0, 2.0, 1.0),
            spin: Angle::default(),
            color: Color::from_bytes([0, 128, 128]),
        }),
        Shape::Box(Cuboid {
            min: dvec3(1.75, 0.0, -1.5),
            max: dvec3(2.25, 1.5, 0.5),
            color: Color::from_bytes([255, 165, 0]),
        }),
        Shape::Checkerboard(Checkerboard {
            y: 0.0,
            square: 1.0,
            colors: [Color::from_bytes([128; 3]), Color::from_bytes([255; 3])],
        }),
    ];
    Scene {
        image: Image {
            width,
            height,
            background: Color::BLACK,
        },
        camera: Camera {
            eye: dvec3(3.0, 3.5, 8.0),
            view: View::Lookat(dvec3(0.2, 0.8, 0.0)),
            up: dvec3(0.0, 1.0, 0.0),
            roll: Angle::default(),
            lens: Lens::Distance(2.75),
            view_height: 2.0,
            near: 0.0,
            far: None,
        },
        sampler: Sampler {
            method,
            count,
            seed: 1,
        },
        objects: shapes
            .into_iter()
            .map(|shape| Object {
                name: None,
                shape,
                span: Span::new(SourceId::File, 0, 0),
            })
            .collect(),
    }
}
