//! Arithmetic in three precisions, from fast to precise.

use std::fmt::Debug;

use dashu_int::{IBig, Sign, ops::BitTest};

use super::{
    Big, Radius, Wide,
    big::{PRECISION, exact, is_zero},
};

/// An approximation of the real numbers: `f64`, [`Double`](super::Double) or [`Big`], from fast to
/// precise.
///
/// Operations take references, because copying a big number is expensive. The error of a result is
/// at most [`UNIT`](Real::UNIT) times the result unless something overflows or underflows. An `f64`
/// or `Double` that overflows becomes infinite or NaN, and every decision about it is a
/// [`Doubt`](super::Doubt).
pub trait Real: Clone + Debug + Sized {
    /// Type of the numbers' error bounds, with at least the range of the numbers themselves.
    type Radius: Radius;
    /// Maximum error of the result of one operation, divided by the result.
    const UNIT: f64;
    /// Maximum absolute error of one operation that underflows. It also covers an underflow in the
    /// computation of the result's error bound.
    const TINY: Self::Radius;
    /// Whether the precision is the highest one. In this precision, a value that cannot be
    /// distinguished from zero is treated as zero.
    const LAST: bool;

    /// Converts an `f64` without rounding.
    fn from_f64(x: f64) -> Self;
    /// Computes `a` − `b`, without rounding if the result is representable.
    fn difference(a: f64, b: f64) -> Self;
    /// Rounds `x` to the precision of `Self`.
    fn from_big(x: &Big) -> Self;
    /// Converts the number to the nearest `f64`, or to one of the two nearest.
    fn to_f64(&self) -> f64;
    /// Returns the absolute value, rounded.
    fn magnitude(&self) -> Self::Radius;
    /// Returns whether the number is less than zero.
    fn is_negative(&self) -> bool;
    /// Returns whether the number is exactly zero. A number too small for an `f64` is not zero.
    fn is_zero(&self) -> bool;

    /// Computes `self` + `other`.
    fn plus(&self, other: &Self) -> Self;
    /// Computes `self` − `other`.
    fn minus(&self, other: &Self) -> Self;
    /// Computes `self` · `other`.
    fn times(&self, other: &Self) -> Self;
    /// Computes `self`/`other`.
    fn over(&self, other: &Self) -> Self;
    /// Computes the square root.
    fn sqrt(&self) -> Self;
    /// Computes −`self`.
    fn negated(&self) -> Self;
    /// Computes `self` · 2^`exponent`, without rounding unless the result overflows or underflows.
    fn scaled(&self, exponent: i32) -> Self;
    /// Returns the floor, the greatest integer that is not greater than the number, and whether the
    /// floor is odd.
    fn floor(&self) -> (Self, bool);
}

/// Number with which an `f64` below 2^51 in absolute value is rounded to the nearest integer: it is
/// added and then subtracted again. The sum is between 2^52 and 2^53, where neighbouring `f64`
/// differ by 1. Its last bit shows whether the integer is odd.
pub const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

/// Returns the floor of `x`, the greatest integer that is not greater than `x`. Requires |x| <
/// 2^63.
///
/// This function replaces `f64::floor`, which is a function call on targets whose baseline has no
/// instruction for rounding down.
#[inline]
pub fn floor(x: f64) -> f64 {
    let towards_zero = x as i64 as f64;
    if towards_zero > x {
        towards_zero - 1.0
    } else {
        towards_zero
    }
}

impl Real for f64 {
    type Radius = f64;
    /// Maximum relative error of one operation: the unit roundoff, 2^−53.
    const UNIT: f64 = 1.0 / (1u64 << 53) as f64;
    /// Upper bound of the absolute error of an operation that underflows: 2^−1022, the least normal
    /// number. The error is in fact at most 2^−1075, half of the smallest subnormal number.
    const TINY: f64 = f64::MIN_POSITIVE;
    const LAST: bool = false;

    fn from_f64(x: f64) -> Self {
        x
    }
    fn difference(a: f64, b: f64) -> Self {
        a - b
    }
    fn from_big(x: &Big) -> Self {
        x.to_f64()
    }
    #[inline]
    fn to_f64(&self) -> f64 {
        *self
    }
    #[inline]
    fn magnitude(&self) -> f64 {
        self.abs()
    }
    #[inline]
    fn is_negative(&self) -> bool {
        *self < 0.0
    }
    #[inline]
    fn is_zero(&self) -> bool {
        *self == 0.0
    }
    #[inline]
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
    #[inline]
    fn minus(&self, other: &Self) -> Self {
        self - other
    }
    #[inline]
    fn times(&self, other: &Self) -> Self {
        self * other
    }
    #[inline]
    fn over(&self, other: &Self) -> Self {
        self / other
    }
    #[inline]
    fn sqrt(&self) -> Self {
        f64::sqrt(*self)
    }
    #[inline]
    fn negated(&self) -> Self {
        -self
    }
    #[inline]
    fn scaled(&self, exponent: i32) -> Self {
        Radius::scaled(*self, exponent)
    }
    #[inline]
    fn floor(&self) -> (Self, bool) {
        /// Absolute value from which on every `f64` is an even integer: 2^53, because an `f64` has
        /// a significand of 53 bits. A larger number may not fit into an `i64`, so it is not
        /// converted.
        const ALL_EVEN: f64 = (1u64 << 53) as f64;
        let floor = f64::floor(*self);
        (floor, floor.abs() < ALL_EVEN && floor as i64 & 1 == 1)
    }
}

impl Real for Big {
    type Radius = Wide;

    const UNIT: f64 = f64::from_bits((1023 - PRECISION as u64) << 52);
    /// Maximum absolute error of an operation that underflows: 0, because big numbers do not
    /// underflow.
    const TINY: Wide = Wide::ZERO;
    const LAST: bool = true;

    fn from_f64(x: f64) -> Self {
        Self::round(exact(x))
    }
    fn difference(a: f64, b: f64) -> Self {
        Self::round(exact(a) - exact(b))
    }
    fn from_big(x: &Self) -> Self {
        x.clone()
    }
    fn to_f64(&self) -> f64 {
        self.0.to_f64().value()
    }
    fn magnitude(&self) -> Wide {
        let repr = self.0.repr();
        let bits = repr.significand().bit_len() as isize;
        // `fraction` is the number scaled to an absolute value of 1/2 to 1, so that it does not
        // overflow as an `f64`.
        let fraction = self.0.clone() >> (repr.exponent() + bits);
        let exponent = (repr.exponent() + bits) as i64;
        Wide::new(fraction.to_f64().value().abs(), exponent)
    }
    fn is_negative(&self) -> bool {
        !is_zero(&self.0) && self.0.sign() == Sign::Negative
    }
    fn is_zero(&self) -> bool {
        is_zero(&self.0)
    }
    fn plus(&self, other: &Self) -> Self {
        Self(&self.0 + &other.0)
    }
    fn minus(&self, other: &Self) -> Self {
        Self(&self.0 - &other.0)
    }
    fn times(&self, other: &Self) -> Self {
        Self(&self.0 * &other.0)
    }
    fn over(&self, other: &Self) -> Self {
        Self(&self.0 / &other.0)
    }
    fn sqrt(&self) -> Self {
        Self(self.0.sqrt())
    }
    fn negated(&self) -> Self {
        Self(-self.0.clone())
    }
    fn scaled(&self, exponent: i32) -> Self {
        Self(self.0.clone() << exponent as isize)
    }
    fn floor(&self) -> (Self, bool) {
        let floor = self.0.floor();
        let odd = (floor.to_int().value() & IBig::ONE) == IBig::ONE;
        (Self::round(floor), odd)
    }
}
