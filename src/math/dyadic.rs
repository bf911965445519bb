//! Dyadic numbers: integers times powers of two. Every `f64` is a dyadic number, and so is every
//! sum, difference and product of dyadic numbers. These operations are therefore exact.
//!
//! Dyadic numbers decide the few questions that must not depend on rounding at all, such as whether
//! the eye lies in a plane or on a sphere, or whether the up vector is parallel to the view
//! direction. A decision takes some microseconds.

use std::{cmp::Ordering, ops};

use dashu_int::Sign;
use glam::DVec3;

use super::{
    Big,
    big::{Float, exact, is_zero},
};

/// An integer times a power of two. Sums, differences and products are exact.
#[derive(Clone, Debug)]
pub struct Dyadic(Float);

/// A vector of dyadic numbers.
pub type Dyadic3 = [Dyadic; 3];

impl Dyadic {
    /// Converts an `f64` exactly.
    pub fn new(x: f64) -> Self {
        Self(exact(x))
    }

    /// Compares the number with zero.
    pub fn sign(&self) -> Ordering {
        if is_zero(&self.0) {
            Ordering::Equal
        } else if self.0.sign() == Sign::Negative {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }

    /// Rounds to the nearest [`Big`].
    pub fn to_big(&self) -> Big {
        Big::round(self.0.clone())
    }

    /// Converts the components of a vector exactly.
    pub fn vector(v: DVec3) -> Dyadic3 {
        v.to_array().map(Self::new)
    }

    /// Computes the vector `to` − `from`.
    pub fn between(from: DVec3, to: DVec3) -> Dyadic3 {
        [0, 1, 2].map(|i| Self(exact(to[i]) - exact(from[i])))
    }

    /// Computes the dot product of two vectors.
    pub fn dot(a: &Dyadic3, b: &Dyadic3) -> Self {
        &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
    }

    /// Computes the cross product of two vectors.
    pub fn cross(a: &Dyadic3, b: &Dyadic3) -> Dyadic3 {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
    }

    /// Returns whether a vector is zero.
    pub fn is_zero(v: &Dyadic3) -> bool {
        v.iter().all(|x| is_zero(&x.0))
    }
}

impl ops::Add for &Dyadic {
    type Output = Dyadic;
    fn add(self, other: Self) -> Dyadic {
        Dyadic(&self.0 + &other.0)
    }
}

impl ops::Sub for &Dyadic {
    type Output = Dyadic;
    fn sub(self, other: Self) -> Dyadic {
        Dyadic(&self.0 - &other.0)
    }
}

impl ops::Mul for &Dyadic {
    type Output = Dyadic;
    fn mul(self, other: Self) -> Dyadic {
        Dyadic(&self.0 * &other.0)
    }
}
