//! Angles with an exact part in degrees.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// An angle: the sum of a part in degrees and a part in radians.
///
/// Because the parts are separate, degrees are exact: any multiple of 90°, however large, has a
/// sine and a cosine of exactly 0 or ±1.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Angle {
    /// The part in degrees.
    pub degrees: f64,
    /// The part in radians.
    pub radians: f64,
}

impl Angle {
    /// Returns the angle of `degrees` degrees.
    pub const fn from_degrees(degrees: f64) -> Self {
        Self {
            degrees,
            radians: 0.0,
        }
    }

    /// Returns the angle of `radians` radians.
    pub const fn from_radians(radians: f64) -> Self {
        Self {
            degrees: 0.0,
            radians,
        }
    }

    /// Returns the sum of both parts in degrees, rounded.
    pub const fn in_degrees(self) -> f64 {
        self.degrees + self.radians.to_degrees()
    }

    /// Returns the sum of both parts in radians, rounded.
    pub const fn in_radians(self) -> f64 {
        self.degrees.to_radians() + self.radians
    }

    /// Returns whether both parts are finite.
    pub fn is_finite(self) -> bool {
        self.degrees.is_finite() && self.radians.is_finite()
    }
}

impl Add for Angle {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            degrees: self.degrees + other.degrees,
            radians: self.radians + other.radians,
        }
    }
}

impl Sub for Angle {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Angle {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            degrees: -self.degrees,
            radians: -self.radians,
        }
    }
}

impl Mul<f64> for Angle {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self {
            degrees: self.degrees * factor,
            radians: self.radians * factor,
        }
    }
}

impl Div<f64> for Angle {
    type Output = Self;
    fn div(self, divisor: f64) -> Self {
        Self {
            degrees: self.degrees / divisor,
            radians: self.radians / divisor,
        }
    }
}
