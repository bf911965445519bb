//! What is seen at a sample point by the formulas of a textbook, in `f64`, as they are written down and typed in everywhere.
//!
//! The basis normalises first, rays have unit directions, the sphere is b² − 4ac, the box three slabs with reciprocals
//! (Kay and Kajiya 1986), the triangle that of Möller and Trumbore (1997) with its epsilon, the board the parity of two floors.
//! All of it is right on paper. It stands here to be compared with.

use glam::{DVec2, DVec3};

use crate::scene::{
    Camera, CenteredTriangle, Checkerboard, Cuboid, Lens, Outline, Scene, Shape, Sphere, View,
};

/// A scene, ready to be asked what is seen.
#[derive(Clone, Debug)]
pub struct Textbook {
    eye: DVec3,
    /// u, v, w.
    axes: [DVec3; 3],
    d: f64,
    pixel: f64,
    /// The picture's size in pixels.
    size: DVec2,
    near: f64,
    far: f64,
    shapes: Vec<(Shape, [DVec3; 3])>,
}

/// A point of a ray on a visible surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The object's index in the scene.
    pub object: usize,
    /// Whether a checkerboard shows its second colour.
    pub odd: bool,
    /// The distance.
    pub t: f64,
    /// The point.
    pub point: DVec3,
}

/// Determinants below this are taken for zero, as Möller and Trumbore's own program does with 10⁻⁶, and most since with this.
const EPSILON: f64 = 1e-8;

impl Textbook {
    /// Prepares a scene.
    pub fn new(scene: &Scene) -> Self {
        let camera = &scene.camera;
        let d = match camera.lens {
            Lens::Distance(d) => d,
            Lens::Fov(angle) => camera.view_height / (2.0 * libm::tan(radians(angle) / 2.0)),
            Lens::HorizontalFov(angle) => {
                let (width, height) = (f64::from(scene.image.width), f64::from(scene.image.height));
                camera.view_height * (width / height) / (2.0 * libm::tan(radians(angle) / 2.0))
            }
        };
        let corners = |shape: &Shape| match shape {
            Shape::Triangle(triangle) => match &triangle.outline {
                Outline::Vertices(vertices) => *vertices,
                Outline::Centered(triangle) => vertices(triangle),
            },
            _ => [DVec3::ZERO; 3],
        };
        let prepared = scene.objects.iter().map(|o| (o.shape, corners(&o.shape)));
        Self {
            eye: camera.eye,
            axes: axes(camera),
            d,
            pixel: camera.view_height / f64::from(scene.image.height),
            size: DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height)),
            near: camera.near,
            far: camera.far.unwrap_or(f64::INFINITY),
            shapes: prepared.collect(),
        }
    }

    /// What is seen at a point so many pixels from the picture's top left corner.
    pub fn seen(&self, pixels: DVec2) -> Option<Seen> {
        let [u, v, w] = self.axes;
        let x = self.pixel * (pixels.x - self.size.x / 2.0);
        let y = self.pixel * (self.size.y / 2.0 - pixels.y);
        let direction = (x * u + y * v - self.d * w).normalize();
        let mut nearest: Option<(usize, f64)> = None;
        for (index, (shape, vertices)) in self.shapes.iter().enumerate() {
            let Some(t) = crossing(shape, vertices, self.eye, direction) else {
                continue;
            };
            let depth = -t * direction.dot(w);
            if depth > self.near && depth < self.far && nearest.is_none_or(|(_, best)| t < best) {
                nearest = Some((index, t));
            }
        }
        let (object, t) = nearest?;
        let point = self.eye + t * direction;
        let odd = match self.shapes[object].0 {
            Shape::Checkerboard(Checkerboard { square, .. }) => is_odd(point, square),
            _ => false,
        };
        Some(Seen {
            object,
            odd,
            t,
            point,
        })
    }
}

/// w = (eye − lookat)/|eye − lookat|, u = (up × w)/|up × w|, v = w × u, and the roll.
pub fn axes(camera: &Camera) -> [DVec3; 3] {
    let backward = match camera.view {
        View::Lookat(at) => camera.eye - at,
        View::Direction(direction) => -direction,
    };
    let w = backward.normalize();
    let u = camera.up.cross(w).normalize();
    let v = w.cross(u);
    let angle = radians(camera.roll);
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    [cos * u - sin * v, sin * u + cos * v, w]
}

fn radians(angle: crate::math::Angle) -> f64 {
    angle.degrees * std::f64::consts::PI / 180.0 + angle.radians
}

fn crossing(shape: &Shape, vertices: &[DVec3; 3], eye: DVec3, d: DVec3) -> Option<f64> {
    match shape {
        Shape::Sphere(shape) => sphere(shape, eye, d),
        Shape::Triangle(_) => triangle(vertices, eye, d),
        Shape::Box(shape) => cuboid(shape, eye, d),
        Shape::Checkerboard(shape) => {
            let t = (shape.y - eye.y) / d.y;
            (t > 0.0).then_some(t)
        }
    }
}

/// The least positive root of a t² + b t + c.
fn sphere(sphere: &Sphere, eye: DVec3, d: DVec3) -> Option<f64> {
    let f = eye - sphere.center;
    let a = d.dot(d);
    let b = 2.0 * f.dot(d);
    let c = f.dot(f) - sphere.radius * sphere.radius;
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)]
        .into_iter()
        .find(|&t| t > 0.0)
}

/// Where the ray enters all three slabs, or from inside leaves the first.
fn cuboid(cuboid: &Cuboid, eye: DVec3, d: DVec3) -> Option<f64> {
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
    [enter, leave].into_iter().find(|&t| t > 0.0)
}

/// Barycentric coordinates by Cramer's rule.
fn triangle([a, b, c]: &[DVec3; 3], eye: DVec3, d: DVec3) -> Option<f64> {
    let (one, other) = (b - a, c - a);
    let p = d.cross(other);
    let determinant = one.dot(p);
    if determinant.abs() < EPSILON {
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
    let t = other.dot(q) * inverse;
    (t > 0.0).then_some(t)
}

/// Left base end, right base end, apex: the law of cosines, and a turn about the centroid.
fn vertices(triangle: &CenteredTriangle) -> [DVec3; 3] {
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

/// Whether floor(x/square) + floor(z/square) is odd.
fn is_odd(point: DVec3, square: f64) -> bool {
    let parity = |x: f64| (x / square).floor().abs() % 2.0;
    parity(point.x) != parity(point.z)
}
