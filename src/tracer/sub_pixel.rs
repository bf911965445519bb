//! A pixel, or a square part of one, for exact integration.
//!
//! In: a pixel that is quartered repeatedly. Out: points of a part as offsets from the pixel's
//! centre. Offsets have no rounding error, because sides are powers of two.

use glam::DVec2;

use super::camera::{Camera, Direction};
use crate::math::Real;

/// A pixel, or a square part of one. A point (x, y) of the part is measured from the part's centre
/// in units of the part's side, x to the right and y down.
#[derive(Clone, Copy, Debug)]
pub struct SubPixel {
    /// The pixel's column.
    pub x: u32,
    /// The pixel's row.
    pub y: u32,
    /// Offset of the part's centre from the pixel's centre, in pixels.
    center: DVec2,
    /// Side in pixels: a power of two.
    pub side: f64,
}

impl SubPixel {
    /// Returns a whole pixel.
    pub fn pixel(x: u32, y: u32) -> Self {
        Self {
            x,
            y,
            center: DVec2::ZERO,
            side: 1.0,
        }
    }

    /// Returns the four quarters of the part.
    pub fn quarters(self) -> [Self; 4] {
        [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)].map(|(x, y)| Self {
            center: self.offset(DVec2::new(x, y)),
            side: 0.5 * self.side,
            ..self
        })
    }

    /// Returns the direction of the ray through the part's centre.
    pub(crate) fn middle<T: Real>(&self, camera: &Camera<T>) -> Direction<T> {
        camera.direction(&camera.sample_point(self.x, self.y, self.center))
    }

    /// Converts a point of the part to an offset from the pixel's centre, in pixels.
    pub(crate) fn offset(&self, at: DVec2) -> DVec2 {
        self.center + at * self.side
    }
}
