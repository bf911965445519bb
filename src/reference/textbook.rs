//! A tracer that decides by the textbook formulas what is seen at a sample point.
//!
//! Ray directions have length 1. A ray that is nearly parallel to a triangle misses it. The colour
//! of a checkerboard's square depends on whether the sum of the square's two indices is even. This
//! tracer exists only to be compared with the real one.

use glam::{DVec2, DVec3};

use super::formulas::{axes, by_vertices, crossings, radians};
use crate::scene::{Lens, Scene, Shape};

/// A scene prepared for the textbook formulas.
#[derive(Clone, Debug)]
pub struct Textbook {
    eye: DVec3,
    /// The camera's axes: right (u), up (v) and backwards (w).
    axes: [DVec3; 3],
    d: f64,
    pixel: f64,
    /// Width and height of the picture in pixels.
    size: DVec2,
    near: f64,
    far: f64,
    shapes: Vec<Shape>,
}

/// The point at which a ray hits the object that is seen, by the textbook formulas.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextbookHit {
    /// Index of the object in the scene.
    pub object: usize,
    /// Whether a checkerboard shows its second colour.
    pub odd: bool,
    /// Distance of the point from the eye, in metres.
    pub t: f64,
    /// The point itself, in the scene's coordinates.
    pub point: DVec3,
}

/// Minimum absolute value of the determinant in the triangle test of Möller and Trumbore. If it is
/// smaller, the triangle is treated as parallel to the ray, so the ray misses it. The authors' own
/// program uses 10⁻⁶; most later programs use 10⁻⁸.
const EPSILON: f64 = 1e-8;

impl Textbook {
    /// Prepares a scene: derives the camera's axes, the size of a pixel, and the vertices of
    /// triangles.
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
        let shapes = scene.objects.iter().map(|object| by_vertices(object.shape));
        Self {
            eye: camera.eye,
            axes: axes(camera),
            d,
            pixel: camera.view_height / f64::from(scene.image.height),
            size: DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height)),
            near: camera.near,
            far: camera.far.unwrap_or(f64::INFINITY),
            shapes: shapes.collect(),
        }
    }

    /// Returns the visible intersection of the ray through the point `pixels` of the picture, in
    /// pixels from the picture's top left corner. Returns `None` if the ray hits nothing.
    pub fn seen(&self, pixels: DVec2) -> Option<TextbookHit> {
        let [u, v, w] = self.axes;
        let x = self.pixel * (pixels.x - self.size.x / 2.0);
        let y = self.pixel * (self.size.y / 2.0 - pixels.y);
        let direction = (x * u + y * v - self.d * w).normalize();
        let mut nearest: Option<(usize, f64)> = None;
        for (index, shape) in self.shapes.iter().enumerate() {
            let crossings = crossings(shape, self.eye, direction, EPSILON);
            let Some(t) = crossings.into_iter().flatten().find(|&t| t > 0.0) else {
                continue;
            };
            let depth = -t * direction.dot(w);
            if depth > self.near && depth < self.far && nearest.is_none_or(|(_, best)| t < best) {
                nearest = Some((index, t));
            }
        }
        let (object, t) = nearest?;
        let point = self.eye + t * direction;
        let board = self.shapes[object].checkerboard();
        let odd = board.is_some_and(|board| is_odd(point, board.square));
        Some(TextbookHit {
            object,
            odd,
            t,
            point,
        })
    }
}

/// Returns whether a point of a checkerboard lies in a square of the second colour, i.e. whether
/// floor(x/square) + floor(z/square) is odd.
fn is_odd(point: DVec3, square: f64) -> bool {
    let parity = |x: f64| (x / square).floor().abs() % 2.0;
    parity(point.x) != parity(point.z)
}
