//! The three precisions of decisions.

use std::fmt::Debug;

use dashu_int::{IBig, Sign, ops::BitTest};

use super::{
    Big, Radius, Wide,
    big::{PRECISION, exact, is_zero},
};

/// A kind of real number: `f64`, [`Double`](super::Double) or [`Big`], from fast to precise.
///
/// Operations take references, because a big number is expensive to copy. The error of a result is
/// at most [`UNIT`](Real::UNIT) times the result, as long as nothing overflows or underflows. An
/// `f64` or `Double` that overflows becomes infinite or NaN, which every decision treats as doubt.
pub trait Real: Clone + Debug + Sized {
    /// Type of error bounds, with at least the range of the kind itself.
    type Radius: Radius;
    /// Bound on the relative error of one operation.
    const UNIT: f64;
    /// Bound on the absolute error of one operation that underflows, including its radius.
    const TINY: Self::Radius;
    /// Whether this is the most precise kind, in which a value that cannot be distinguished from
    /// zero counts as zero.
    const LAST: bool;

    /// Converts without rounding.
    fn from_f64(x: f64) -> Self;
    /// Computes a − b, without rounding if the kind can hold the result.
    fn difference(a: f64, b: f64) -> Self;
    /// Rounds a more precise number.
    fn from_big(x: &Big) -> Self;
    /// Returns the nearest `f64`, or one of the two nearest.
    fn to_f64(&self) -> f64;
    /// Returns the absolute value, rounded.
    fn magnitude(&self) -> Self::Radius;
    /// Returns whether the number is less than zero.
    fn is_negative(&self) -> bool;
    /// Returns whether the number is zero, not merely too small for an `f64`.
    fn is_zero(&self) -> bool;

    /// Computes self + other.
    fn plus(&self, other: &Self) -> Self;
    /// Computes self − other.
    fn minus(&self, other: &Self) -> Self;
    /// Computes self · other.
    fn times(&self, other: &Self) -> Self;
    /// Computes self / other.
    fn over(&self, other: &Self) -> Self;
    /// Computes the square root.
    fn sqrt(&self) -> Self;
    /// Computes −self.
    fn negated(&self) -> Self;
    /// Computes self · 2^exponent, exactly.
    fn scaled(&self, exponent: i32) -> Self;
    /// Returns the greatest integer that is not greater, and whether it is odd.
    fn floor(&self) -> (Self, bool);
}

/// Number that rounds another one below 2^51 to an integer if it is added and subtracted again. The
/// last bit of the sum is that of the integer.
pub const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

/// Returns the greatest integer that is not greater, for |x| < 2^63.
///
/// `f64::floor` is a function call on targets whose baseline has no instruction for it.
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
    /// Half a unit in the last of 53 places.
    const UNIT: f64 = 1.0 / (1u64 << 53) as f64;
    /// 2^−1022. An underflow loses half a subnormal number's unit, 2^−1075.
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
        /// Every `f64` from 2^53 on is even, because it has 53 bits.
        const ALL_EVEN: f64 = (1u64 << 53) as f64;
        let floor = f64::floor(*self);
        (floor, floor.abs() < ALL_EVEN && floor as i64 & 1 == 1)
    }
}

impl Real for Big {
    type Radius = Wide;

    const UNIT: f64 = f64::from_bits((1023 - PRECISION as u64) << 52);
    /// A big number does not underflow.
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
        // Between 1/2 and 1, whatever the number's own exponent.
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
