//! Whether the camera sees anything at all.
//!
//! In: a camera and the objects. Out: why all of them are out of its sight, if bounds show that they are. What is in doubt counts as seen,
//! and so does what another object hides: a warning is never false. Errors: numbers here are rounded `f64`s, and each comparison leaves
//! [`MARGIN`] of the sizes in it.

use glam::DVec3;

use super::{Camera, Image, Lens, Object, Outline, Shape, View, level_direction};
use crate::math::{predicates, trig};

/// By so much of the lengths that are compared a comparison has to be clear. With up and the view direction at [`LEAST_SINE`] or more the
/// axes are good to 2^−52/10^−6, about 2·10⁻¹⁰, and all else is better.
const MARGIN: f64 = 1e-8;

/// Below this sine of the angle between them, up and the view direction do not tell the axes well enough.
pub const LEAST_SINE: f64 = 1e-6;

/// Why nothing is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// All of it is behind the camera.
    Behind,
    /// All of it is beside the window, or behind.
    Outside,
    /// Without `near` and `far` something would be seen.
    Clipped,
}

/// Why the camera sees none of the objects; none if it may see one.
pub fn why_unseen(camera: &Camera, image: &Image, objects: &[Object]) -> Option<Unseen> {
    let frustum = Frustum::new(camera, image)?;
    let sees = |near: f64, far: f64| {
        let mut shapes = objects.iter().map(|object| &object.shape);
        shapes.any(|shape| frustum.may_see(shape, near, far))
    };
    if sees(camera.near, camera.far.unwrap_or(f64::INFINITY)) {
        return None;
    }
    if sees(0.0, f64::INFINITY) {
        return Some(Unseen::Clipped);
    }
    let is_before = |object: &Object| match object.shape {
        Shape::Checkerboard(_) => true,
        _ => !frustum.is_beyond(&object.shape, frustum.forward, 0.0),
    };
    Some(match objects.iter().any(is_before) {
        true => Unseen::Outside,
        false => Unseen::Behind,
    })
}

/// The middle of an object, if it has one.
pub fn middle(shape: &Shape) -> Option<DVec3> {
    match shape {
        Shape::Sphere(sphere) => Some(sphere.center),
        Shape::Triangle(triangle) => Some(triangle.outline.centroid()),
        Shape::Box(cuboid) => Some(cuboid.min.midpoint(cuboid.max)),
        Shape::Checkerboard(_) => None,
    }
}

/// What the camera sees: the pyramid of its window.
struct Frustum {
    eye: DVec3,
    /// The view direction, of length 1.
    forward: DVec3,
    /// The axes, times half of the window's extents at depth 1; none where they are not known well enough.
    window: Option<[DVec3; 2]>,
}

impl Frustum {
    fn new(camera: &Camera, image: &Image) -> Option<Self> {
        let (from, to) = camera.view.ends(camera.eye);
        let along = to - from;
        // Of points far from the origin, and near to each other, little is left of the difference.
        let is_precise = along.length() > LEAST_SINE * (from.length() + to.length());
        let forward = along.normalize();
        if !is_precise || !forward.is_finite() {
            return None;
        }
        Some(Self {
            eye: camera.eye,
            forward,
            window: window(camera, image, forward),
        })
    }

    /// Whether a shape may be seen between two depths.
    fn may_see(&self, shape: &Shape, near: f64, far: f64) -> bool {
        if let Shape::Checkerboard(board) = shape {
            return self.may_see_plane(board.y, near, far);
        }
        if self.is_beyond(shape, self.forward, near) || self.is_beyond(shape, -self.forward, -far) {
            return false;
        }
        let Some(window) = self.window else {
            return true;
        };
        // A side goes through the eye and along one of the axes; these point inwards.
        window.iter().all(|axis| {
            let half = axis.length();
            [1.0, -1.0].into_iter().all(|sign| {
                let inwards = (self.forward * half + *axis / half * sign).normalize();
                !self.is_beyond(shape, inwards, 0.0)
            })
        })
    }

    /// Whether all of a shape lies clearly on the outer side of a plane: at n·(p − e) < bound, n of length 1.
    fn is_beyond(&self, shape: &Shape, n: DVec3, bound: f64) -> bool {
        let (reach, size) = match shape {
            Shape::Sphere(sphere) => (
                n.dot(sphere.center - self.eye) + sphere.radius,
                sphere.center.length() + sphere.radius,
            ),
            Shape::Triangle(triangle) => match triangle.outline {
                Outline::Vertices(vertices) => self.reach(n, &vertices),
                // A vertex is no farther from the centroid than the longest side is long.
                Outline::Centered(triangle) => {
                    let radius = triangle.sides.max_element();
                    let (reach, size) = self.reach(n, &[triangle.centroid]);
                    (reach + radius, size + radius)
                }
            },
            Shape::Box(cuboid) => {
                let farthest = DVec3::select(n.cmpgt(DVec3::ZERO), cuboid.max, cuboid.min);
                let (reach, _) = self.reach(n, &[farthest]);
                (reach, cuboid.min.length() + cuboid.max.length())
            }
            Shape::Checkerboard(_) => return false,
        };
        // What is not a number is not less.
        reach < bound - MARGIN * (size + self.eye.length() + bound.abs())
    }

    fn reach(&self, n: DVec3, points: &[DVec3]) -> (f64, f64) {
        let reach = points.iter().map(|point| n.dot(*point - self.eye));
        let sizes = points.iter().map(|point| point.length());
        (
            reach.fold(f64::NEG_INFINITY, f64::max),
            sizes.fold(0.0, f64::max),
        )
    }

    /// The same of the plane of a checkerboard. A ray that goes by y along for each metre of depth meets it at the depth (h − e_y)/y.
    fn may_see_plane(&self, height: f64, near: f64, far: f64) -> bool {
        let Some([across, up]) = self.window else {
            return true;
        };
        let above = height - self.eye.y;
        if above == 0.0 {
            return false;
        }
        let middle = self.forward.y * above.signum();
        let spread = across.y.abs() + up.y.abs();
        let margin = MARGIN * (1.0 + across.length() + up.length());
        let (least, most) = (middle - spread - margin, middle + spread + margin);
        if most <= 0.0 {
            return false;
        }
        let nearest = above.abs() / most;
        let farthest = match least > 0.0 {
            true => above.abs() / least,
            false => f64::INFINITY,
        };
        !(nearest > far || farthest < near)
    }
}

/// Right and top of the picture, times half of the window's width and height at depth 1.
fn window(camera: &Camera, image: &Image, forward: DVec3) -> Option<[DVec3; 2]> {
    let (from, to) = camera.view.ends(camera.eye);
    let up = camera.up / camera.up.abs().max_element();
    let right = match predicates::cross_is_zero(camera.up, from, to) {
        true => level_direction(up).cross(up),
        false => {
            let right = forward.cross(up);
            if right.length() < LEAST_SINE * up.length() {
                return None;
            }
            right
        }
    };
    let right = right.normalize();
    let top = right.cross(forward);
    let (sin, cos) = (trig::sin(camera.roll), trig::cos(camera.roll));
    let aspect = f64::from(image.width) / f64::from(image.height);
    let half = match camera.lens {
        Lens::Distance(d) => camera.view_height / d / 2.0,
        Lens::Fov(angle) => trig::tan(angle * 0.5),
        Lens::HorizontalFov(angle) => trig::tan(angle * 0.5) / aspect,
    };
    let axes = [
        (right * cos - top * sin) * (half * aspect),
        (right * sin + top * cos) * half,
    ];
    axes.iter()
        .all(|axis| axis.is_finite() && *axis != DVec3::ZERO)
        .then_some(axes)
}

impl View {
    /// Two points, from one of which to the other the camera looks.
    pub fn ends(&self, eye: DVec3) -> (DVec3, DVec3) {
        match *self {
            Self::Lookat(point) => (eye, point),
            Self::Direction(direction) => (DVec3::ZERO, direction),
        }
    }
}
