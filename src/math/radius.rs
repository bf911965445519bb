//! Error bounds, which are non-negative numbers. Error bounds of big numbers have a wider range
//! than `f64`. Operations round to the nearest number, so callers multiply a bound by
//! [`UP`](super::UP) where it must not be too small.

use std::ops::{Add, Div, Mul};

/// A non-negative number that bounds an error. Operations round to the nearest number, so a
/// computed bound can be slightly too small. Where this matters, callers multiply it by a factor
/// above 1.
pub trait Radius:
    Copy
    + std::fmt::Debug
    + PartialOrd
    + Add<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Mul<f64, Output = Self>
{
    /// Radius of a ball that contains only its midpoint.
    const ZERO: Self;
    /// Radius of a ball that contains every number.
    const INFINITE: Self;
    /// Computes the square root.
    fn sqrt(self) -> Self;
    /// Computes `self` · 2^`exponent`.
    fn scaled(self, exponent: i32) -> Self;
    /// Returns the exponent of the least power of two that is greater than the number. Returns 0 if
    /// the number is 0.
    fn exponent(self) -> i32;
    /// Computes `self` − `other`. `other` must be smaller than `self`.
    fn without(self, other: Self) -> Self;
    /// Converts to `f64`; a number that is too large becomes infinite.
    fn to_f64(self) -> f64;

    /// Returns the greater of `self` and `other`.
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
}

impl Radius for f64 {
    const ZERO: Self = 0.0;
    const INFINITE: Self = f64::INFINITY;

    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn scaled(self, exponent: i32) -> Self {
        match exponent {
            // In this range, the power of two is a normal number, so the product equals the result
            // of `ldexp`. The product is faster.
            -1022..=1023 => self * f64::from_bits(((exponent + 1023) as u64) << 52),
            _ => libm::ldexp(self, exponent),
        }
    }
    fn exponent(self) -> i32 {
        libm::frexp(self.min(f64::MAX)).1
    }
    #[inline]
    fn without(self, other: Self) -> Self {
        self - other
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
}

/// A non-negative number that does not overflow: mantissa · 2^exponent. The mantissa is 0,
/// infinite, or at least 1 and less than 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wide {
    mantissa: f64,
    exponent: i64,
}

impl Wide {
    /// Maximum difference between the exponents of two summands. If the difference is greater, the
    /// smaller summand is enlarged until its exponent is only 1000 less than that of the larger
    /// summand. The error is negligible, since error bounds are enlarged by the factor
    /// [`UP`](super::UP) anyway. With a greater maximum, the scaled mantissa could underflow.
    const FAR: i64 = 1000;

    /// Returns `mantissa` · 2^`exponent`. The mantissa must not be negative; it need not be between
    /// 1 and 2.
    pub fn new(mantissa: f64, exponent: i64) -> Self {
        if mantissa == 0.0 || !mantissa.is_finite() {
            return Self {
                mantissa,
                exponent: 0,
            };
        }
        let (fraction, shift) = libm::frexp(mantissa);
        Self {
            mantissa: fraction * 2.0,
            exponent: exponent + i64::from(shift) - 1,
        }
    }
}

impl PartialOrd for Wide {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        let ordinary = |x: f64| x != 0.0 && x.is_finite();
        if ordinary(self.mantissa) && ordinary(other.mantissa) {
            let by_exponent = self.exponent.cmp(&other.exponent);
            return Some(by_exponent.then(self.mantissa.total_cmp(&other.mantissa)));
        }
        self.mantissa.partial_cmp(&other.mantissa)
    }
}

impl Add for Wide {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (large, small) = if self >= other {
            (self, other)
        } else {
            (other, self)
        };
        if small.mantissa == 0.0 || !large.mantissa.is_finite() {
            return Self {
                mantissa: large.mantissa + small.mantissa,
                ..large
            };
        }
        let shift = (large.exponent - small.exponent).min(Self::FAR);
        let sum = large.mantissa + libm::ldexp(small.mantissa, -(shift as i32));
        Self::new(sum, large.exponent)
    }
}

impl Mul for Wide {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.mantissa * other.mantissa,
            self.exponent + other.exponent,
        )
    }
}

impl Div for Wide {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::new(
            self.mantissa / other.mantissa,
            self.exponent - other.exponent,
        )
    }
}

impl Mul<f64> for Wide {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self * Self::new(factor, 0)
    }
}

impl Radius for Wide {
    const ZERO: Self = Self {
        mantissa: 0.0,
        exponent: 0,
    };
    const INFINITE: Self = Self {
        mantissa: f64::INFINITY,
        exponent: 0,
    };

    fn sqrt(self) -> Self {
        let odd = self.exponent & 1;
        Self::new(
            libm::ldexp(self.mantissa, odd as i32).sqrt(),
            (self.exponent - odd) / 2,
        )
    }
    fn scaled(self, exponent: i32) -> Self {
        Self::new(self.mantissa, self.exponent + i64::from(exponent))
    }
    fn exponent(self) -> i32 {
        let of_mantissa = i64::from(self.mantissa != 0.0);
        /// Maximum absolute value of the returned exponent. It must be far beyond the exponents of
        /// `f64`, but so small that sums of returned exponents do not overflow.
        const LIMIT: i64 = 1 << 20;
        (self.exponent + of_mantissa).clamp(-LIMIT, LIMIT) as i32
    }
    fn without(self, other: Self) -> Self {
        let shift = (self.exponent - other.exponent).clamp(0, Self::FAR);
        let rest = self.mantissa - libm::ldexp(other.mantissa, -(shift as i32));
        Self::new(rest.max(0.0), self.exponent)
    }
    fn to_f64(self) -> f64 {
        /// Maximum absolute value of the exponent that is passed to `ldexp`. It is beyond the
        /// exponents of `f64`, −1074 to 1023, so that a greater exponent gives the same result.
        const LIMIT: i64 = 1100;
        libm::ldexp(self.mantissa, self.exponent.clamp(-LIMIT, LIMIT) as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_numbers_are_numbers() {
        let w = |x: f64| Wide::new(x, 0);
        for (computed, expected) in [
            (w(3.0) + w(0.25), 3.25),
            (w(0.25) + w(3.0), 3.25),
            (w(0.0) + w(2.0), 2.0),
            (w(3.0) * w(0.125), 0.375),
            (w(3.0) / w(4.0), 0.75),
            (w(3.0) * 0.5, 1.5),
            (w(2.25).sqrt(), 1.5),
            (w(0.5).sqrt(), 0.5_f64.sqrt()),
            (w(2.0).without(w(0.5)), 1.5),
            (w(2.0).without(w(0.0)), 2.0),
        ] {
            assert_eq!(computed, w(expected));
        }
        let increasing = [
            w(0.0),
            w(1e-300),
            w(1.0),
            w(1.5),
            w(4.0),
            w(1e300),
            Wide::INFINITE,
        ];
        assert!(increasing.is_sorted_by(|a, b| a < b));
        assert!(Wide::INFINITE + w(1.0) > w(1e300));
    }

    #[test]
    fn exponents_do_not_run_out() {
        let tiny = Wide::new(1.5, -5000);
        assert!(tiny > Wide::ZERO && tiny < Wide::new(5e-324, 0));
        assert_eq!(tiny.scaled(5000), Wide::new(1.5, 0));
        assert_eq!(tiny * Wide::new(1.0, 5000), Wide::new(1.5, 0));
        assert!(Wide::new(1.0, 0) + tiny >= Wide::new(1.0, 0));
        assert_eq!((tiny.exponent(), Wide::new(1.0, 0).exponent()), (-4999, 1));
        assert_eq!((Radius::exponent(0.75), Radius::exponent(1.0)), (0, 1));
    }
}
