//! Checks the fraction of a pixel's area that a triangle covers, and its error bound. The reference
//! is the area of the part of the pixel inside the triangle, computed in multiple precision.

use std::cell::RefCell;

use glam::DVec3;
use proptest::{prelude::*, test_runner::TestRunner};

use super::super::Integrator;
use super::PIXEL;
use crate::{
    area::Area,
    cancel,
    color::Color,
    reference::{
        exact_board::{area, point, split},
        oracle::{N, Oracle, USUAL_SIZES, V},
        scenes::{camera, scene},
        tightness::Tightness,
    },
    scene::{Shape, Triangle, TriangleOutline},
    tracer::World,
};

fn cross(a: &V, b: &V) -> V {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// Returns the fraction of a pixel's area that shows a triangle. The triangle is in front of the
/// eye.
fn share(oracle: &Oracle, [x, y]: [u32; 2], eye: DVec3, vertices: [DVec3; 3]) -> N {
    let number = oracle.number;
    let difference = |a: &V, b: &V| [0, 1, 2].map(|i| &a[i] - &b[i]);
    let dot = |a: &V, b: &V| &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2];
    // The ray's direction is linear in the position within the pixel, so three rays determine all
    // others.
    let ray =
        |x_offset: f64, y_offset: f64| oracle.direction(x, y, glam::dvec2(x_offset, y_offset));
    let middle = ray(0.0, 0.0);
    let [right, down] = [ray(1.0, 0.0), ray(0.0, 1.0)].map(|ray| difference(&ray, &middle));
    let eye = eye.to_array().map(|x| number.exact(x));
    let [a, b, c] = vertices.map(|v| difference(&v.to_array().map(|x| number.exact(x)), &eye));
    let side = dot(&a, &cross(&b, &c));
    let mut polygon = PIXEL.map(point).to_vec();
    for (from, to) in [(&a, &b), (&b, &c), (&c, &a)] {
        let normal = cross(from, to);
        let line = [&right, &down, &middle].map(|v| dot(&normal, v) * &side);
        let [_, inside] = split(&polygon, &line);
        if inside.len() < 3 {
            return number.exact(0.0);
        }
        polygon = inside;
    }
    area(&polygon)
}

#[test]
fn errors_of_a_triangles_share_are_within_tight_bounds() {
    let found = RefCell::new(Tightness::default());
    let number = || -1.0..1.0_f64;
    let vector =
        |size: f64| prop::array::uniform3(number()).prop_map(move |v| size * DVec3::from(v));
    let cases = (
        vector(1.0),
        prop::array::uniform3(vector(1.0)),
        0.0..360.0_f64,
        0.0..3.0_f64,
    );
    TestRunner::default()
        .run(&cases, |(at, vertices, roll, near)| {
            let eye = at + DVec3::new(0.3, 0.2, 3.0 + libm::exp10(near));
            let mut camera = camera(eye, DVec3::ZERO);
            camera.roll = crate::math::Angle::from_degrees(roll);
            let triangle = Shape::Triangle(Triangle {
                outline: TriangleOutline::Vertices(vertices),
                color: Color::BLACK,
            });
            let mut scene = scene(camera, &[triangle]);
            [scene.image.width, scene.image.height] = [12, 12];
            let oracle = Oracle::new(&scene, USUAL_SIZES);
            let world = World::new(&scene);
            // The triangle's colour has the value 1 and the background 0, so that the mean is the
            // triangle's share of the pixel.
            let integrator = Integrator::for_values(&world, |color| {
                [f64::from(u8::from(color != Color::BLACK))]
            });
            let whole = Area::whole(12, 12);
            let pixels = integrator.pixels(whole, &cancel::NEVER).unwrap();
            for (pixel, (x, y)) in pixels.iter().zip(whole.iter()) {
                if pixel.bound > 0.0 && x % 3 == 0 {
                    let expected = share(&oracle, [x, y], eye, vertices);
                    let error = (expected - oracle.number.exact(pixel.mean[0]))
                        .to_f64()
                        .value();
                    found
                        .borrow_mut()
                        .add(error.abs(), pixel.bound, 1, (vertices, x, y));
                }
            }
            Ok(())
        })
        .unwrap();
    found.into_inner().assert("lines");
}
