//! Linear and quadratic forms in the coordinates of a pixel or of a rectangle of pixels.
//!
//! In: a form over the view plane, and the pixel. Out: the same form as a function of the offset from the pixel's centre, in units of its sides.
//! Errors: one bound for all values there, the form's own taken twice (its factors, its value at the centre) and the roundings of its evaluation.

use super::{
    camera::{Camera, Direction},
    form::Form,
};
use crate::{
    area::Area,
    math::{Real, UP},
};

/// A linear form of the offset, and a bound on the error of its computed values in the pixel.
#[derive(Clone, Copy, Debug)]
pub struct LocalForm {
    /// Factors of x, y and 1.
    pub(crate) factors: [f64; 3],
    pub(crate) rad: f64,
}

/// A linear form in units of its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaledLine(pub(super) [f64; 3]);

/// A quadratic form of the offset: factors of 1, x, y, x², xy and y²; and a bound on the error of its values.
#[derive(Clone, Copy, Debug)]
pub struct LocalQuadratic {
    pub(super) factors: [f64; 6],
    pub(super) rad: f64,
}

/// A pixel, or a rectangle of pixels; the offsets of its forms are in units of its sides.
#[derive(Clone, Debug)]
pub struct PixelFrame {
    /// The ray through its centre.
    pub center: Direction<f64>,
    /// Its sides in units of X and Y.
    pub sides: [f64; 2],
}

/// Where a form stands to 0 all over a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    Above,
    Below,
    Both,
    /// It has overflowed.
    Unknown,
}

/// Roundings on the way to a value of a local form, of the sum of its factors' sizes: of a linear one each factor has one, and so has its quotient by the error;
/// products and sums, where offsets are at most ½, have two. Of a quadratic one each of six terms has five at most, generously counted.
const LINEAR_ROUNDINGS: f64 = 4.0 * f64::UNIT;
pub(super) const ROUNDINGS: f64 = 16.0 * f64::UNIT;

impl LocalForm {
    /// From its factors, and a bound on what it is off but for the roundings of its evaluation.
    pub fn new(factors: [f64; 3], inherited: f64) -> Self {
        let [a, b, c] = factors.map(f64::abs);
        let rad = (inherited + (a + b + c) * LINEAR_ROUNDINGS + 16.0 * f64::TINY) * UP;
        Self { factors, rad }
    }

    /// Half the difference between its greatest and its least value in the pixel.
    pub(super) fn spread(&self) -> f64 {
        let [a, b, _] = self.factors;
        0.5 * (a.abs() + b.abs())
    }

    pub(super) fn side(&self) -> Side {
        side(self.factors[2], self.spread() * UP, self.rad)
    }

    pub(super) fn line(&self) -> ScaledLine {
        ScaledLine(self.factors.map(|factor| factor / self.rad))
    }

    #[inline(always)]
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let [a, b, c] = self.factors;
        a * x + b * y + c
    }

    /// self − k · other, for a whole number k.
    pub(crate) fn less(&self, k: f64, other: &Self) -> Self {
        let sizes: f64 = (0..3)
            .map(|i| self.factors[i].abs() + (k * other.factors[i]).abs())
            .sum();
        let factors = [0, 1, 2].map(|i| self.factors[i] - k * other.factors[i]);
        // Of a product and a difference.
        let inherited = self.rad + k.abs() * other.rad + sizes * (2.0 * f64::UNIT);
        Self::new(factors, inherited)
    }
}

impl PixelFrame {
    pub(super) fn new(camera: &Camera<f64>, area: Area) -> Self {
        Self {
            center: camera.direction(&camera.middle(area)),
            sides: [area.width, area.height].map(|pixels| f64::from(pixels) * camera.pitch),
        }
    }
}

/// A form's side, from its value at the centre.
fn side(center: f64, spread: f64, rad: f64) -> Side {
    let reach = spread + rad;
    if !(center.abs() + reach).is_finite() {
        Side::Unknown
    } else if center > reach {
        Side::Above
    } else if center < -reach {
        Side::Below
    } else {
        Side::Both
    }
}

impl Form<f64> {
    /// The form in a pixel. Its own error bound counts twice: for its factors, and for its value at the pixel's centre.
    pub(super) fn local(&self, frame: &PixelFrame) -> LocalForm {
        let [a, b, _] = *self.factors();
        let [width, height] = frame.sides;
        let factors = [a * width, b * height, self.at(&frame.center).mid];
        LocalForm::new(factors, 2.0 * self.rad())
    }
}

impl LocalQuadratic {
    /// From its factors, and a bound on what it is off but for the roundings of its evaluation.
    pub fn new(factors: [f64; 6], inherited: f64) -> Self {
        let sizes: f64 = factors.iter().map(|factor| factor.abs()).sum();
        let rad = (inherited + sizes * ROUNDINGS + 16.0 * f64::TINY) * UP;
        Self { factors, rad }
    }

    pub(super) fn side(&self) -> Side {
        let [c, x, y, xx, xy, yy] = self.factors;
        let spread = 0.5 * (x.abs() + y.abs()) + 0.25 * (xx.abs() + xy.abs() + yy.abs());
        side(c, spread * UP, self.rad)
    }

    /// The same in units of its error.
    pub(super) fn certain(&self) -> Self {
        Self {
            factors: self.factors.map(|factor| factor / self.rad),
            rad: 1.0,
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let [c, fx, fy, xx, xy, yy] = self.factors;
        c + x * (fx + xx * x + xy * y) + y * (fy + yy * y)
    }
}
