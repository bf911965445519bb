//! From points of the world to points of the picture, and back, in rounded numbers.

use glam::{DVec2, DVec3};

use crate::{
    math::{Big, Real},
    scene::{Camera, Image, Lens},
    textbook::{self, radians},
    tracer::Basis,
};

/// A camera in rounded numbers.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    /// Where the eye is.
    pub eye: DVec3,
    /// The picture's right.
    pub right: DVec3,
    /// The picture's top.
    pub top: DVec3,
    /// The view direction, of length 1.
    pub ahead: DVec3,
    /// The side of a pixel at depth 1.
    pub pitch: f64,
    /// The picture's width and height in pixels.
    pub size: DVec2,
}

impl Projection {
    /// Each number the rounding of what real arithmetic makes of a camera.
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

    /// By a textbook's formulas, for callers that need thousands in a second.
    pub fn quick(camera: &Camera, image: &Image) -> Self {
        let [right, top, backward] = textbook::axes(camera);
        // Lengths out of the range of numbers leave no axes of them.
        if !(right + top).is_finite() {
            return Self::new(camera, image);
        }
        let size = size(image);
        let slope = |angle| 2.0 * libm::tan(radians(angle) / 2.0);
        Self {
            eye: camera.eye,
            right,
            top,
            ahead: -backward,
            pitch: match camera.lens {
                Lens::Distance(d) => camera.view_height / d / size.y,
                Lens::Fov(angle) => slope(angle) / size.y,
                Lens::HorizontalFov(angle) => slope(angle) / size.x,
            },
            size,
        }
    }

    /// How far ahead of the eye a point lies.
    pub fn depth(&self, point: DVec3) -> f64 {
        (point - self.eye).dot(self.ahead)
    }

    /// Where a point is seen; none if it is not in front of the eye.
    pub fn point(&self, point: DVec3) -> Option<DVec2> {
        let seen = self.projected(point);
        (self.depth(point) > 0.0 && seen.is_finite()).then_some(seen)
    }

    /// Where the line through the eye and a point meets the picture.
    pub fn projected(&self, point: DVec3) -> DVec2 {
        let from_eye = point - self.eye;
        let across = DVec2::new(from_eye.dot(self.right), -from_eye.dot(self.top));
        across / (self.depth(point) * self.pitch) + self.size / 2.0
    }

    /// The direction of the ray through a point of the picture, as long as it takes to a depth of
    /// 1.
    pub fn ray(&self, point: DVec2) -> DVec3 {
        let across = (point - self.size / 2.0) * self.pitch;
        self.ahead + self.right * across.x - self.top * across.y
    }

    /// What lies at a depth on the ray through a point of the picture.
    pub fn at_depth(&self, point: DVec2, depth: f64) -> DVec3 {
        self.eye + self.ray(point) * depth
    }

    /// Where the ray through a point of the picture meets the plane through a point of the world;
    /// none if that is not in front of the eye.
    pub fn on_plane(&self, at: DVec2, through: DVec3, normal: DVec3) -> Option<DVec3> {
        let ray = self.ray(at);
        let depth = (through - self.eye).dot(normal) / ray.dot(normal);
        (depth > 0.0 && depth.is_finite()).then(|| self.eye + ray * depth)
    }
}

fn size(image: &Image) -> DVec2 {
    DVec2::new(f64::from(image.width), f64::from(image.height))
}
