//! The three precisions that decisions are made in.

use std::fmt::Debug;

use dashu_int::{IBig, Sign, ops::BitTest};

use super::{
    Big, Radius, Wide,
    big::{PRECISION, exact, is_zero},
};

/// A kind of real number: `f64`, [`Double`](super::Double) or [`Big`], from fast to precise.
///
/// Operations take references, since a big number is not free to copy. Each result is off by at
/// most [`UNIT`](Real::UNIT) of its own size, as long as nothing overflows or underflows; an `f64`
/// or `Double` that overflows becomes infinite or NaN, which every decision takes for doubt.
pub trait Real: Clone + Debug + Sized {
    /// What bounds errors: as wide in range as the kind itself.
    type Radius: Radius;
    /// Bound on the relative error of one operation.
    const UNIT: f64;
    /// Bound on the absolute error of one operation that underflows, its radius included.
    const TINY: Self::Radius;
    /// Whether there is no more precise kind to ask: a value that is not told from zero counts as
    /// zero.
    const LAST: bool;

    /// The number itself, without rounding.
    fn from_f64(x: f64) -> Self;
    /// a − b, without rounding where the kind can hold it.
    fn difference(a: f64, b: f64) -> Self;
    /// The rounding of a more precise number.
    fn from_big(x: &Big) -> Self;
    /// The nearest `f64`, or one of the two nearest.
    fn to_f64(&self) -> f64;
    /// Its absolute value, rounded.
    fn magnitude(&self) -> Self::Radius;
    /// Whether it is less than zero.
    fn is_negative(&self) -> bool;
    /// Whether it is zero, and not merely too small for an `f64`.
    fn is_zero(&self) -> bool;

    /// self + other.
    fn plus(&self, other: &Self) -> Self;
    /// self − other.
    fn minus(&self, other: &Self) -> Self;
    /// self · other.
    fn times(&self, other: &Self) -> Self;
    /// self / other.
    fn over(&self, other: &Self) -> Self;
    /// The square root.
    fn sqrt(&self) -> Self;
    /// −self.
    fn negated(&self) -> Self;
    /// self · 2^exponent, exactly.
    fn scaled(&self, exponent: i32) -> Self;
    /// The greatest integer that is not greater, and whether it is odd.
    fn floor(&self) -> (Self, bool);
}

/// Added to a number below 2^51 and taken away again, it rounds that to a whole number, whose last
/// bit is that of the sum.
pub const ROUND: f64 = 1.5 * (1u64 << 52) as f64;

/// The greatest whole number that is not greater, for |x| < 2^63.
///
/// `f64::floor` is a call of a function where not every processor of the kind has an instruction
/// for it.
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
    /// An underflow loses half a subnormal number's unit, 2^−1075, and this is 2^−1022.
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
        /// Every `f64` from here on is even, as it has 53 bits.
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
        // Between 1/2 and 1, without regard to its exponent.
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
