//! Numbers without any rounding.
//!
//! They settle the few questions that must not depend on rounding at all: does the eye lie in this plane, on this sphere, is the up vector parallel
//! to the view direction. That takes some microseconds.

use std::{cmp::Ordering, ops};

use dashu_int::Sign;
use glam::DVec3;

use super::{
    Big,
    big::{Float, exact, is_zero},
};

/// A number made of `f64` by sums, differences and products alone.
#[derive(Clone, Debug)]
pub struct Exact(Float);

/// A vector of them.
pub type Exact3 = [Exact; 3];

impl Exact {
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
    pub fn vector(v: DVec3) -> Exact3 {
        v.to_array().map(Self::new)
    }

    /// to − from.
    pub fn between(from: DVec3, to: DVec3) -> Exact3 {
        [0, 1, 2].map(|i| Self(exact(to[i]) - exact(from[i])))
    }

    /// The scalar product of two vectors.
    pub fn dot(a: &Exact3, b: &Exact3) -> Self {
        &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
    }

    /// The vector product of two vectors.
    pub fn cross(a: &Exact3, b: &Exact3) -> Exact3 {
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
    }

    /// Whether a vector has no length.
    pub fn is_zero(v: &Exact3) -> bool {
        v.iter().all(|x| is_zero(&x.0))
    }
}

impl ops::Add for &Exact {
    type Output = Exact;
    fn add(self, other: Self) -> Exact {
        Exact(&self.0 + &other.0)
    }
}

impl ops::Sub for &Exact {
    type Output = Exact;
    fn sub(self, other: Self) -> Exact {
        Exact(&self.0 - &other.0)
    }
}

impl ops::Mul for &Exact {
    type Output = Exact;
    fn mul(self, other: Self) -> Exact {
        Exact(&self.0 * &other.0)
    }
}
