//! Projection of points in world coordinates to points of the picture, and back, in `f64`.

use glam::{DVec2, DVec3};

use crate::{
    math::{Big, Real},
    reference::formulas::{self, radians},
    scene::{Camera, Image, pixel_size},
    tracer::Basis,
};

/// Projection by a camera: its eye, its axes and the size of its pixels, in `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Position of the eye, in world coordinates.
    pub eye: DVec3,
    /// Unit vector to the picture's right.
    pub right: DVec3,
    /// Unit vector to the picture's top.
    pub top: DVec3,
    /// The view direction, of length 1.
    pub ahead: DVec3,
    /// Side of a pixel at depth 1, in metres.
    pub pitch: f64,
    /// Width and height of the picture, in pixels.
    pub size: DVec2,
}

impl Projection {
    /// Derives the projection; each field is the correctly rounded exact value.
    pub fn new(camera: &Camera, image: &Image) -> Self {
        let basis = Basis::new(camera, image);
        let rounded = |v: &[Big; 3]| DVec3::from(v.each_ref().map(Real::to_f64));
        Self {
            eye: camera.eye,
            right: rounded(&basis.u),
            top: rounded(&basis.v),
            ahead: -rounded(&basis.w),
            pitch: basis.pitch.to_f64(),
            size: size(image),
        }
    }

    /// Derives the projection by textbook formulas in `f64`, for callers that need thousands of
    /// projections per second.
    pub fn quick(camera: &Camera, image: &Image) -> Self {
        let [right, top, backward] = formulas::axes(camera);
        // If the length of a vector overflows, the textbook formulas give axes that are not finite.
        // The axes are then computed exactly.
        if !(right + top).is_finite() {
            return Self::new(camera, image);
        }
        Self {
            eye: camera.eye,
            right,
            top,
            ahead: -backward,
            pitch: pixel_size(camera, image, |angle| libm::tan(radians(angle) / 2.0)),
            size: size(image),
        }
    }

    /// Returns the depth of a point: its distance from the eye along the view direction. The depth
    /// is negative behind the eye.
    pub fn depth(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.ahead)
    }

    /// Projects a point to the picture plane, in pixels from the top left corner. Returns `None` if
    /// the point is not in front of the eye or its projection is not finite.
    pub fn point(&self, point: DVec3) -> Option<DVec2> {
        let seen = self.projected(point);
        (self.depth(point) > 0.0 && seen.is_finite()).then_some(seen)
    }

    /// Returns the point where the line through the eye and `point` hits the picture plane, in
    /// pixels from the top left corner. `point` may be behind the eye.
    pub fn projected(&self, point: DVec3) -> DVec2 {
        let from_eye = point - self.eye;
        let across = DVec2::new(from_eye.dot(self.right), -from_eye.dot(self.top));
        across / (self.depth(point) * self.pitch) + self.size / 2.0
    }

    /// Returns the point at depth 1 on the ray through `point`, relative to the eye. `point` is a
    /// point of the picture, in pixels from the top left corner.
    pub fn ray(&self, point: DVec2) -> DVec3 {
        let across = (point - self.size / 2.0) * self.pitch;
        self.ahead + self.right * across.x - self.top * across.y
    }

    /// Returns the point at the depth `depth` on the ray through a point of the picture.
    pub fn at_depth(&self, point: DVec2, depth: f64) -> DVec3 {
        self.eye + self.ray(point) * depth
    }

    /// Intersects the ray through the point `at` of the picture with a plane. The plane contains
    /// the world point `through` and is perpendicular to `normal`. Returns `None` if the
    /// intersection is not in front of the eye or not finite.
    pub fn on_plane(&self, at: DVec2, through: DVec3, normal: DVec3) -> Option<DVec3> {
        let ray = self.ray(at);
        let depth = (through - self.eye).dot(normal) / ray.dot(normal);
        (depth > 0.0 && depth.is_finite()).then(|| self.eye + ray * depth)
    }
}

fn size(image: &Image) -> DVec2 {
    DVec2::new(f64::from(image.width), f64::from(image.height))
}
