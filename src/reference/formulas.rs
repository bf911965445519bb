//! The usual textbook formulas in `f64`: a camera's axes, a triangle's vertices, and the
//! intersection of a ray with a shape.
//!
//! A sphere is intersected by the quadratic formula, with the discriminant b² − 4ac. A box is
//! intersected as three slabs (Kay and Kajiya 1986), and a triangle by the method of Möller and
//! Trumbore (1997). All formulas are correct in exact arithmetic, but the tracer uses none of them.
//! `report` compares the tracer with them, and `grading` uses them to imitate students' programs.

use glam::{BVec3, DVec2, DVec3};

use crate::{
    math::Angle,
    scene::{
        Camera, CenteredTriangle, Cuboid, Shape, Sphere, Triangle, TriangleOutline, View,
        level_direction,
    },
};

/// Returns the camera's axes u (right), v (up) and w (backwards), after its roll:
///
/// w = (eye − lookat)/|eye − lookat|, u = (up × w)/|up × w|, v = w × u.
///
/// If the view direction is parallel to `up`, u follows from the level direction that the language
/// defines for this case.
pub fn axes(camera: &Camera) -> [DVec3; 3] {
    let backward = match camera.view {
        View::Lookat(at) => camera.eye - at,
        View::Direction(direction) => -direction,
    };
    let w = backward.normalize();
    let right = match camera.up.cross(backward) {
        DVec3::ZERO => level_direction(camera.up).cross(camera.up),
        _ => camera.up.cross(w),
    };
    let u = right.normalize();
    let v = w.cross(u);
    let angle = radians(camera.roll);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [cos * u - sin * v, sin * u + cos * v, w]
}

/// Converts an angle to radians. An angle has a part in degrees and a part in radians.
pub fn radians(angle: Angle) -> f64 {
    angle.degrees * std::f64::consts::PI / 180.0 + angle.radians
}

/// Returns the vertices of a triangle. If the scene does not give them, computes the left end of
/// the base, the right end, and the apex.
pub fn vertices(outline: &TriangleOutline) -> [DVec3; 3] {
    match outline {
        TriangleOutline::Vertices(vertices) => *vertices,
        TriangleOutline::Centered(triangle) => centered(triangle),
    }
}

/// Computes the vertices of a triangle from its sides, by the law of cosines and a rotation about
/// the centroid: the left end of the base, the right end, and the apex.
fn centered(triangle: &CenteredTriangle) -> [DVec3; 3] {
    let n = triangle.normal.normalize();
    let reference = if n.x == 0.0 && n.z == 0.0 {
        DVec3::NEG_Z
    } else {
        DVec3::Y
    };
    let right = reference.cross(n).normalize();
    let top = n.cross(right);
    let DVec3 { x: a, y: b, z: c } = triangle.sides;
    let cos = (a * a + c * c - b * b) / (2.0 * a * c);
    let apex = DVec2::new(a * cos, a * (1.0 - cos * cos).sqrt());
    let corners = [DVec2::ZERO, DVec2::new(c, 0.0), apex];
    let mean = (corners[0] + corners[1] + corners[2]) / 3.0;
    let angle = radians(triangle.spin);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    corners.map(|corner| {
        let p = corner - mean;
        let (x, y) = (cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        triangle.centroid + x * right + y * top
    })
}

/// Returns the corners of the box from `min` to `max`.
pub fn corners(min: DVec3, max: DVec3) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let is_max = |bit: u32| corner >> bit & 1 == 1;
        DVec3::select(BVec3::new(is_max(0), is_max(1), is_max(2)), max, min)
    })
}

/// Converts a triangle that is given by its sides to the form with vertices, so that the vertices
/// are not computed again for each ray. Returns other shapes unchanged.
pub fn by_vertices(shape: Shape) -> Shape {
    match shape {
        Shape::Triangle(Triangle { outline, color }) => Shape::Triangle(Triangle {
            outline: TriangleOutline::Vertices(vertices(&outline)),
            color,
        }),
        other => other,
    }
}

/// Intersects the line `eye` + t·`d` with a shape. Returns the two values of t, the smaller first;
/// for a flat shape, they are equal. Returns `None` if the line misses the shape. A triangle is
/// treated as missed if the absolute value of the determinant of Möller and Trumbore's formula is
/// less than `epsilon`.
#[inline(always)]
pub fn crossings(shape: &Shape, eye: DVec3, d: DVec3, epsilon: f64) -> Option<[f64; 2]> {
    match shape {
        Shape::Sphere(shape) => sphere(shape, eye, d),
        Shape::Triangle(shape) => triangle(&vertices(&shape.outline), eye, d, epsilon),
        Shape::Box(shape) => cuboid(shape, eye, d),
        Shape::Checkerboard(shape) => Some([(shape.y - eye.y) / d.y; 2]),
    }
}

/// Intersects the line `eye` + t·`d` with a sphere. Returns both values of t, the smaller first, or
/// `None` if the line misses the sphere. The values are the roots of a quadratic equation a·t² +
/// b·t + c = 0.
fn sphere(sphere: &Sphere, eye: DVec3, d: DVec3) -> Option<[f64; 2]> {
    let f = eye - sphere.center;
    let a = d.dot(d);
    let b = 2.0 * f.dot(d);
    let c = f.dot(f) - sphere.radius * sphere.radius;
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    Some([(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)])
}

/// Intersects the line `eye` + t·`d` with a box. A box is the intersection of three slabs, each
/// between two parallel planes. The line is in the box from the greatest t at which it enters a
/// slab to the least t at which it leaves one. Returns these two numbers. Returns `None` if the
/// second is less than the first.
fn cuboid(cuboid: &Cuboid, eye: DVec3, d: DVec3) -> Option<[f64; 2]> {
    let inverse = 1.0 / d;
    let a = (cuboid.min - eye) * inverse;
    let b = (cuboid.max - eye) * inverse;
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (near, far) = if a[axis] < b[axis] {
            (a[axis], b[axis])
        } else {
            (b[axis], a[axis])
        };
        if near > enter {
            enter = near;
        }
        if far < leave {
            leave = far;
        }
    }
    if enter > leave {
        return None;
    }
    Some([enter, leave])
}

/// Intersects the line `eye` + t·`d` with a triangle, by barycentric coordinates from Cramer's
/// rule. Returns the same t as entry and as exit. Returns `None` if the line misses the triangle or
/// is nearly parallel to it.
fn triangle([a, b, c]: &[DVec3; 3], eye: DVec3, d: DVec3, epsilon: f64) -> Option<[f64; 2]> {
    let (one, other) = (b - a, c - a);
    let p = d.cross(other);
    let determinant = one.dot(p);
    if determinant.abs() < epsilon {
        return None;
    }
    let inverse = 1.0 / determinant;
    let s = eye - a;
    let u = s.dot(p) * inverse;
    let q = s.cross(one);
    let v = d.dot(q) * inverse;
    if !(0.0..=1.0).contains(&u) || v < 0.0 || u + v > 1.0 {
        return None;
    }
    Some([other.dot(q) * inverse; 2])
}
