//! What is certain of an object over a whole rectangle of the picture.
//!
//! In: an object's forms, and a rectangle of the view plane. Out: whether all of its rays meet the object, and the interval of its inverse depths.
//!
//! The ranges of an object's forms over the rectangle, widened by the error bounds of its decisions, so that what is said here of
//! the rectangle is also what every sample in it says.

use glam::DVec2;

use crate::{area::Area, math::UP};

use super::{
    camera::{Camera, Direction},
    form::Form,
    sub_pixel::SubPixel,
};

/// A rectangle of the view plane.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The direction through its centre.
    pub center: Direction<f64>,
    /// Half its extent in X and Y, rounded up.
    pub half: [f64; 2],
}

/// The numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least.
    pub low: f64,
    /// The greatest.
    pub high: f64,
}

/// How an object that may be seen in a rectangle stands to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cover {
    /// Whether every ray through the rectangle meets the object, between the near and the far plane.
    pub is_whole: bool,
    /// Holds the inverse depths of what is met of it, seen or hidden.
    pub inverse_depth: Range,
}

impl Patch {
    /// The rectangle of some pixels.
    pub fn new(camera: &Camera<f64>, area: Area) -> Self {
        let half = |pixels: u32| 0.5 * f64::from(pixels) * camera.pitch * UP + f64::MIN_POSITIVE;
        let middle = camera.middle(area);
        Self {
            center: camera.direction(&middle),
            half: [half(area.width), half(area.height)],
        }
    }

    /// The square of a sub-pixel.
    pub fn of_sub_pixel(camera: &Camera<f64>, sub_pixel: SubPixel) -> Self {
        let half = 0.5 * sub_pixel.side * camera.pitch * UP + f64::MIN_POSITIVE;
        let middle = camera.sample_point(sub_pixel.x, sub_pixel.y, sub_pixel.offset(DVec2::ZERO));
        Self {
            center: camera.direction(&middle),
            half: [half; 2],
        }
    }
}

impl Patch {
    /// All that a camera sees.
    pub fn window(camera: &Camera<f64>) -> Self {
        let window = camera.window;
        Self {
            center: Direction {
                x: 0.0,
                y: 0.0,
                z: window.z,
                square: window.z * window.z,
            },
            half: [window.x, window.y],
        }
    }
}

impl Range {
    /// All numbers.
    pub const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// The numbers that are no farther from `middle` than `reach`.
    pub fn about(middle: f64, reach: f64) -> Self {
        let reach = reach * UP + f64::MIN_POSITIVE;
        Self {
            low: middle - reach,
            high: middle + reach,
        }
    }

    /// Itself, or all numbers where an overflow left none.
    pub fn or_all(self) -> Self {
        if self.low <= self.high {
            self
        } else {
            Self::ALL
        }
    }

    /// Whether it holds 0, as far as is known: NaN holds everything.
    pub fn holds_zero(self) -> bool {
        !(self.low > 0.0 || self.high < 0.0)
    }

    /// The greatest (or least) of some numbers, one of each range.
    pub fn fold(ranges: impl Iterator<Item = Self>, which: fn(f64, f64) -> f64) -> Option<Self> {
        // Not so NaN, of which the greater would be the other.
        ranges.map(Self::or_all).reduce(|a, b| Self {
            low: which(a.low, b.low),
            high: which(a.high, b.high),
        })
    }

    /// Times a power of two.
    pub fn times_power(self, power: f64) -> Self {
        Self {
            low: self.low * power,
            high: self.high * power,
        }
    }
}

impl Form<f64> {
    /// The range of its values over a rectangle.
    pub fn over(&self, patch: &Patch) -> Range {
        let [a, b, _] = self.factors();
        let spread = a.abs() * patch.half[0] + b.abs() * patch.half[1];
        let middle = self.at(&patch.center);
        Range::about(middle.mid, spread + middle.rad)
    }
}
