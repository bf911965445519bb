//! Dyadic numbers: whole numbers times powers of two, which sums, differences and products of `f64`
//! are, without any rounding.
//!
//! They settle the few questions that must not depend on rounding at all: does the eye lie in this
//! plane, on this sphere, is the up vector parallel to the view direction. That takes some
//! microseconds.

use std::{cmp::Ordering, ops};

use dashu_int::Sign;
use glam::DVec3;

use super::{
    Big,
    big::{Float, exact, is_zero},
};

/// A whole number times a power of two: what sums, differences and products of `f64` are.
#[derive(Clone, Debug)]
pub struct Dyadic(Float);

/// A vector of them.
pub type Dyadic3 = [Dyadic; 3];

impl Dyadic {
    /// The number itself.
    pub fn new(x: f64) -> Self {
        Self(exact(x))
    }

    /// Less than, equal to or greater than zero.
    pub fn sign(&self) -> Ordering {
        if is_zero(&self.0) {
            Ordering::Equal
        } else if self.0.sign() == Sign::Negative {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }

    /// The nearest [`Big`].
    pub fn to_big(&self) -> Big {
        Big::round(self.0.clone())
    }

    /// A vector.
    pub fn vector(v: DVec3) -> Dyadic3 {
        v.to_array().map(Self::new)
    }

    /// to − from.
    pub fn between(from: DVec3, to: DVec3) -> Dyadic3 {
        [0, 1, 2].map(|i| Self(exact(to[i]) - exact(from[i])))
    }

    /// The scalar product of two vectors.
    pub fn dot(a: &Dyadic3, b: &Dyadic3) -> Self {
        &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
    }

    /// The vector product of two vectors.
    pub fn cross(a: &Dyadic3, b: &Dyadic3) -> Dyadic3 {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
    }

    /// Whether a vector has no length.
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
