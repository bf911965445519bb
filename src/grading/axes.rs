//! A camera's axes in plain `f64`: where points are seen, and which rays pass through places of the picture.

use glam::{DVec2, DVec3};

use crate::{
    math::Angle,
    scene::{Camera, Image, Lens, View, level_direction},
};

/// A camera's axes, and the pixels of a unit of the view plane at distance 1.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// Where the eye is.
    pub eye: DVec3,
    u: DVec3,
    v: DVec3,
    w: DVec3,
    /// Pixels for a unit at distance 1.
    pub focal: f64,
    /// The middle of the picture.
    pub middle: DVec2,
}

impl Axes {
    /// Those of a camera.
    pub fn new(camera: &Camera, image: &Image) -> Self {
        let forward = match camera.view {
            View::Lookat(point) => point - camera.eye,
            View::Direction(direction) => direction,
        };
        let w = -forward.normalize_or(DVec3::NEG_Z);
        let mut u = camera.up.cross(w);
        if u.length_squared() <= 1e-24 * camera.up.length_squared() {
            // Tilted from looking along the level direction.
            let level = level_direction(camera.up);
            u = match w.dot(camera.up) > 0.0 {
                true => level.cross(w),
                false => -level.cross(w),
            };
        }
        let u = u.normalize_or(DVec3::X);
        let v = w.cross(u);
        let roll = camera.roll.in_radians();
        let (sin, cos) = (libm::sin(roll), libm::cos(roll));
        let (width, height) = (f64::from(image.width), f64::from(image.height));
        Self {
            eye: camera.eye,
            u: cos * u - sin * v,
            v: sin * u + cos * v,
            w,
            focal: focal(camera, image),
            middle: DVec2::new(width, height) / 2.0,
        }
    }

    /// The ray through a place of the picture, of depth 1.
    pub fn ray(&self, place: DVec2) -> DVec3 {
        let at = (place - self.middle) / self.focal;
        at.x * self.u - at.y * self.v - self.w
    }

    /// Where a point is seen, if it lies before the eye.
    pub fn place(&self, point: DVec3) -> Option<DVec2> {
        let (place, depth) = self.projected(point);
        (depth > 0.0).then_some(place)
    }

    /// Where the line through the eye and a point meets the picture, and how far the point lies before the eye.
    pub fn projected(&self, point: DVec3) -> (DVec2, f64) {
        let to = point - self.eye;
        let depth = -to.dot(self.w);
        let place = DVec2::new(to.dot(self.u), -to.dot(self.v)) * (self.focal / depth);
        (self.middle + place, depth)
    }

    /// How large a pixel is at a point, in metres.
    pub fn pixel_at(&self, point: DVec3) -> f64 {
        (point - self.eye).length().max(1e-9) / self.focal
    }
}

/// How many pixels a unit of the view plane at distance 1 has.
pub fn focal(camera: &Camera, image: &Image) -> f64 {
    let (width, height) = (f64::from(image.width), f64::from(image.height));
    let half = |angle: Angle| libm::tan(angle.in_radians() / 2.0);
    match camera.lens {
        Lens::Distance(d) => d * height / camera.view_height,
        Lens::Fov(angle) => height / (2.0 * half(angle)),
        Lens::HorizontalFov(angle) => width / (2.0 * half(angle)),
    }
}
