//! Linear and quadratic forms over a rectangle of the view plane: a pixel, a part of one, or many.
//!
//! In: a form over the view plane, and the rectangle. Out: the same form as a function of the
//! offset from the rectangle's centre, in units of its sides, and the range of its values. One
//! error bound holds for all values in the rectangle; it includes the errors of the form's factors
//! and of its value at the centre, and the rounding errors of the evaluation. If the range does not
//! contain 0, the form has one sign at every sample in the rectangle.

use super::{
    camera::{Camera, Direction},
    form::Form,
    interval::Interval,
    sub_pixel::SubPixel,
};
use crate::{
    area::Area,
    math::{Real, UP},
};

/// Upper bound of the rounding error of a [`LocalForm`]'s value, divided by the sum of the absolute
/// values of the form's factors. The bound is four roundings: one for a factor itself, one for its
/// division by the error bound ([`LocalForm::line`]), and two for the evaluation. The evaluation
/// has more than two roundings, but of smaller numbers: offsets are at most ½, so a product is at
/// most half of its factor.
const LINEAR_ROUNDING: f64 = 4.0 * f64::UNIT;
/// Upper bound of the rounding error of a [`LocalQuadratic`]'s value, divided by the sum of the
/// absolute values of the form's factors. The value is 16 roundings: at most five in the
/// computation of a factor, and at most eleven in the products and sums of the evaluation.
pub const LOCAL_ROUNDING: f64 = 16.0 * f64::UNIT;
/// Error bound for underflow in the evaluation of a form, which has at most 16 products. If a
/// product is below the normal numbers of `f64`, its error is at most half of the least positive
/// number, and so less than `TINY`.
const UNDERFLOW_ERROR: f64 = 16.0 * f64::TINY;

/// A rectangle of the view plane.
#[derive(Clone, Debug)]
pub struct Patch {
    /// The direction through the rectangle's centre.
    pub center: Direction<f64>,
    /// Width and height of the rectangle, measured in X and Y, the first two components of a ray's
    /// direction.
    pub sides: [f64; 2],
}

/// A linear form of the offset (x, y) from the centre of a [`Patch`], in units of its sides.
#[derive(Clone, Copy, Debug)]
pub struct LocalForm {
    /// Factors of x, y and 1 in the form, where (x, y) is the offset from the rectangle's centre in
    /// units of its sides.
    pub factors: [f64; 3],
    pub rad: f64,
}

/// A linear form divided by its error bound, as factors of x, y and 1. The sign of the form is
/// certain where the quotient is above 1 or below −1.
pub type ScaledLine = [f64; 3];

/// A quadratic form of the offset (x, y) from the centre of a [`Patch`], in units of its sides. It
/// has the factors of 1, x, y, x², xy and y², and an error bound `rad` of its values.
#[derive(Clone, Copy, Debug)]
pub struct LocalQuadratic {
    pub factors: [f64; 6],
    pub rad: f64,
}

impl Patch {
    /// Returns the rectangle that an area of pixels occupies in the view plane.
    pub fn new(camera: &Camera<f64>, area: Area) -> Self {
        Self {
            center: camera.direction(&camera.middle(area)),
            sides: [area.width, area.height].map(|pixels| f64::from(pixels) * camera.pitch),
        }
    }

    /// Returns the square that a sub-pixel occupies in the view plane.
    pub fn of_sub_pixel(camera: &Camera<f64>, sub_pixel: SubPixel) -> Self {
        Self {
            center: sub_pixel.middle(camera),
            sides: [sub_pixel.side * camera.pitch; 2],
        }
    }

    /// Returns the rectangle of a camera's whole window, which contains all sample points.
    pub fn window(camera: &Camera<f64>) -> Self {
        let window = camera.window;
        Self {
            center: Direction {
                x: 0.0,
                y: 0.0,
                z: window.z,
                square: window.z * window.z,
            },
            sides: [2.0 * window.x, 2.0 * window.y],
        }
    }
}

impl Form<f64> {
    /// Expands the form about the centre of a rectangle. The form's error bound is doubled, to
    /// cover both the error of the factors and the error of the value at the centre.
    #[inline]
    pub fn local(&self, patch: &Patch) -> LocalForm {
        let [a, b, _] = *self.factors();
        let [width, height] = patch.sides;
        let factors = [a * width, b * height, self.at(&patch.center).mid];
        LocalForm::new(factors, 2.0 * self.rad())
    }

    /// Returns an interval that contains the form's values over a rectangle.
    #[inline]
    pub fn over(&self, patch: &Patch) -> Interval {
        self.local(patch).range()
    }
}

impl LocalForm {
    /// Builds a form from its factors. `inherited` is a bound on the error that the factors' errors
    /// cause in the form's values. The rounding errors of the evaluation are added.
    #[inline]
    pub fn new(factors: [f64; 3], inherited: f64) -> Self {
        let [a, b, c] = factors.map(f64::abs);
        let rad = (inherited + (a + b + c) * LINEAR_ROUNDING + UNDERFLOW_ERROR) * UP;
        Self { factors, rad }
    }

    /// Returns half the difference between the form's greatest and least value in the rectangle.
    pub fn spread(&self) -> f64 {
        let [a, b, _] = self.factors;
        0.5 * (a.abs() + b.abs())
    }

    /// Returns an interval that contains the form's values over the rectangle.
    pub fn range(&self) -> Interval {
        Interval::about(self.factors[2], self.spread() + self.rad)
    }

    pub fn line(&self) -> ScaledLine {
        self.factors.map(|factor| factor / self.rad)
    }

    #[inline(always)]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let [a, b, c] = self.factors;
        a * x + b * y + c
    }

    /// Returns the form `self` − k · `other` for a whole number k.
    pub fn less(&self, k: f64, other: &Self) -> Self {
        let sizes: f64 = (0..3)
            .map(|i| self.factors[i].abs() + (k * other.factors[i]).abs())
            .sum();
        let factors = [0, 1, 2].map(|i| self.factors[i] - k * other.factors[i]);
        // The product k·`other` and the difference are rounded once each.
        let inherited = self.rad + k.abs() * other.rad + sizes * (2.0 * f64::UNIT);
        Self::new(factors, inherited)
    }
}

impl LocalQuadratic {
    /// Builds a form from its factors. `inherited` is a bound on the error that the factors' errors
    /// cause in the form's values. The rounding errors of the evaluation are added.
    pub fn new(factors: [f64; 6], inherited: f64) -> Self {
        let sizes: f64 = factors.iter().map(|factor| factor.abs()).sum();
        let rad = (inherited + sizes * LOCAL_ROUNDING + UNDERFLOW_ERROR) * UP;
        Self { factors, rad }
    }

    /// Returns an interval that contains the form's values over the rectangle. It is the sum of the
    /// ranges of the terms in x and of those in y, widened by a bound of the term in xy.
    pub fn range(&self) -> Interval {
        let [c, x, y, xx, xy, yy] = self.factors.map(|factor| 0.25 * factor);
        let c = 4.0 * c;
        let slack = xy.abs() + self.rad;
        let reach = |sign: f64| {
            let along = greatest(x.abs(), sign * xx) + greatest(y.abs(), sign * yy);
            (along + slack) * UP
        };
        Interval {
            low: c - reach(-1.0),
            high: c + reach(1.0),
        }
    }

    /// Returns the form divided by its error bound. The sign of the form is certain where the
    /// quotient is above 1 or below −1.
    pub fn certain(&self) -> Self {
        Self {
            factors: self.factors.map(|factor| factor / self.rad),
            rad: 1.0,
        }
    }

    #[inline(always)]
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let [c, fx, fy, xx, xy, yy] = self.factors;
        c + x * (fx + xx * x + xy * y) + y * (fy + yy * y)
    }
}

/// Returns the greatest value of 2at + bt² for t from −1 to 1, with a ≥ 0. It occurs at t = 1, or
/// at a smaller t where the derivative vanishes.
fn greatest(a: f64, b: f64) -> f64 {
    if a < -b { a * a / -b } else { 2.0 * a + b }
}
