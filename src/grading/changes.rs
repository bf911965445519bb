//! What the rows of the table of mistakes change in a candidate.

use std::sync::Arc;

use glam::DVec3;

use super::{
    candidate::Candidate,
    faulty_tracer::{Hit, Spheres, Squares, Visible},
    light::{Curve, Look},
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    math::Angle,
    reference::formulas::vertices,
    scene::{Cuboid, Lens, Shape, TriangleOutline, View},
};

/// Gray by a mean of encoded values.
pub fn gray_of_encoded(c: &mut Candidate, weights: [f64; 3]) {
    c.looks.extend([
        Look::Curve(linear_to_srgb),
        Look::Gray(weights),
        Look::Curve(srgb_to_linear),
    ]);
}

/// Each channel's light becomes another one, once.
pub fn look(c: &mut Candidate, curve: fn(f64) -> f64) {
    if c.looks.is_empty() {
        c.looks.push(Look::Curve(curve));
    }
}

/// Samples lie elsewhere, by so many pixels to the right and down in the file.
pub fn shift(c: &mut Candidate, by: [f64; 2]) {
    c.behaviour.offset = c.layout.source_direction(by);
}

pub fn is_square(c: &Candidate) -> bool {
    c.scene.image.width == c.scene.image.height
}

/// How far the view plane is from the eye.
pub fn distance(c: &Candidate) -> f64 {
    let height = c.scene.camera.view_height;
    let half = |angle: Angle| libm::tan(angle.in_radians() / 2.0);
    let [width, tall] = sides(c);
    match c.scene.camera.lens {
        Lens::Distance(d) => d,
        Lens::Fov(angle) => height / (2.0 * half(angle)),
        Lens::HorizontalFov(angle) => height * width / tall / (2.0 * half(angle)),
    }
}

pub fn sides(c: &Candidate) -> [f64; 2] {
    [c.scene.image.width, c.scene.image.height].map(f64::from)
}

/// The window has other proportions than the picture.
pub fn widen(c: &mut Candidate, aspect: f64) {
    let [width, height] = sides(c);
    let by = aspect * height / width;
    if c.behaviour.aspect == 1.0 && (by - 1.0).abs() > 1e-3 {
        c.behaviour.aspect = by;
    }
}

/// Spheres are hit wrongly.
pub fn hit_spheres(c: &mut Candidate, spheres: Spheres) {
    if shapes(c).any(|shape| matches!(shape, Shape::Sphere(_))) {
        c.behaviour.spheres = spheres;
    }
}

/// An object is hit wrongly.
pub fn hit(c: &mut Candidate, object: usize, hit: Hit) {
    let is_about = match (hit, c.scene.objects[object].shape) {
        (Hit::WithoutAxis(_), Shape::Box(_)) => true,
        (Hit::WithoutAxis(_), _) => false,
        (_, shape) => matches!(shape, Shape::Triangle(_)),
    };
    if is_about && c.behaviour.hit.is_none() {
        c.behaviour.hit = Some((object, hit));
    }
}

/// Light is encoded otherwise, once.
pub fn encode(c: &mut Candidate, curve: Curve) {
    if c.curve == Curve::Right {
        c.curve = curve;
    }
}

/// Colours are decoded by a curve, averaged, and encoded by it.
pub fn average(c: &mut Candidate, curve: Curve) {
    if c.curve == Curve::Right {
        (c.averaged, c.curve) = (curve, curve);
    }
}

pub fn show(c: &mut Candidate, visible: Visible) {
    if c.scene.objects.len() > 1 {
        see(c, visible);
    }
}

/// Another surface is seen than the nearest: one mistake of this kind leaves no room for another.
pub fn see(c: &mut Candidate, visible: Visible) {
    if c.behaviour.visible == Visible::Nearest {
        c.behaviour.visible = visible;
    }
}

/// Squares of a board that is drawn are told otherwise, once.
pub fn tell_squares(c: &mut Candidate, is_first: fn(f64, f64) -> bool) {
    let mut drawn = c.scene.objects.iter().zip(&c.is_drawn);
    let is_seen =
        drawn.any(|(object, is_drawn)| *is_drawn && matches!(object.shape, Shape::Checkerboard(_)));
    if is_seen && c.behaviour.squares == Squares::default() {
        c.behaviour.squares = Squares(is_first);
    }
}

pub fn exchange_colors(c: &mut Candidate) {
    for shape in shapes(c) {
        if let Shape::Checkerboard(board) = shape {
            board.colors.reverse();
        }
    }
}

pub fn exchange_sides(c: &mut Candidate) {
    let [width, height] = sides(c);
    match c.scene.camera.lens {
        _ if width == height => {}
        Lens::HorizontalFov(_) => lengthen(c, height / width),
        Lens::Distance(_) | Lens::Fov(_) => lengthen(c, width / height),
    }
}

/// The view plane is so many times as far; a field of view is one of an angle that makes it so.
pub fn lengthen(c: &mut Candidate, by: f64) {
    match &mut c.scene.camera.lens {
        Lens::Distance(d) => *d *= by,
        Lens::Fov(angle) | Lens::HorizontalFov(angle) => *angle = widened(*angle, 1.0 / by),
    }
}

/// An angle whose half has a tangent so many times as large.
fn widened(angle: Angle, by: f64) -> Angle {
    let half = libm::atan(by * libm::tan(angle.in_radians() / 2.0));
    Angle::from_degrees((2.0 * half).to_degrees())
}

/// The distance of the view plane is so many times as large, or the angle as small.
pub fn zoom(c: &mut Candidate, by: f64) {
    let is_less = |angle: Angle| angle.in_radians() < std::f64::consts::PI;
    match &mut c.scene.camera.lens {
        Lens::Distance(d) => *d *= by,
        Lens::Fov(angle) | Lens::HorizontalFov(angle) if is_less(*angle / by) => {
            *angle = *angle / by
        }
        Lens::Fov(_) | Lens::HorizontalFov(_) => {}
    }
}

pub fn exchange_faces(c: &mut Candidate, object: usize, order: [usize; 3]) {
    if let Some(Shape::Box(Cuboid {
        faces: Some(faces), ..
    })) = shapes(c).nth(object)
    {
        *faces = order.map(|axis| faces[axis]);
    }
}

/// A triangle is moved so that a point of it, told by its vertices, lies where its centroid should.
pub fn anchor(c: &mut Candidate, object: usize, point: fn([DVec3; 3]) -> DVec3) {
    if let Some(Shape::Triangle(triangle)) = shapes(c).nth(object) {
        let point = point(vertices(&triangle.outline));
        if let TriangleOutline::Centered(centered) = &mut triangle.outline {
            centered.centroid += centered.centroid - point;
        }
    }
}

/// A box's corners are moved, each by so many times its size.
pub fn stretch(c: &mut Candidate, object: usize, by: [DVec3; 2]) {
    if let Some(Shape::Box(cuboid)) = shapes(c).nth(object) {
        let size = cuboid.max - cuboid.min;
        cuboid.min += by[0] * size;
        cuboid.max += by[1] * size;
    }
}

pub fn shapes(c: &mut Candidate) -> impl Iterator<Item = &mut Shape> {
    let objects = Arc::make_mut(&mut c.scene.objects).iter_mut();
    objects.map(|object| &mut object.shape)
}

pub fn look_back(c: &mut Candidate) {
    let camera = &mut c.scene.camera;
    camera.view = match camera.view {
        View::Lookat(point) => View::Lookat(2.0 * camera.eye - point),
        View::Direction(direction) => View::Direction(-direction),
    };
}
