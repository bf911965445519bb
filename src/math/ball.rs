//! Numbers with an error bound.

use std::{borrow::Borrow, cmp::Ordering};

use super::{Big, Radius, Real};

/// Error that is returned if a decision is uncertain in the precision in use. The next higher
/// precision has to make the decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Doubt;

/// A real number known to lie within `rad` of `mid`.
///
/// The radius of each result covers the radii of the operands and the operation's own rounding.
/// After an overflow, the radius is infinite or NaN, and the ball counts as containing every
/// number.
#[derive(Clone, Debug)]
pub struct Ball<T: Real> {
    /// The computed number, the ball's midpoint.
    pub mid: T,
    /// Maximum distance between the true number and `mid`; not negative.
    pub rad: T::Radius,
}

/// Factor by which a computed radius of a [`Ball`] is multiplied so that it is certainly not too
/// small. A radius is computed in `f64` with fewer than 2^12 roundings of 2^−53 each, together less
/// than 2^−41. The factor exceeds 1 by 2^−40, which is more.
pub const UP: f64 = 1.0 + 1.0 / (1u64 << 40) as f64;

/// Factor in the bound on the rounding error of a ball's midpoint. The bound is this factor times
/// [`UNIT`](Real::UNIT) times the computed midpoint. A factor of 2 would suffice: `UNIT` bounds the
/// error relative to the true number, which is less than twice the computed one. The larger factor
/// 4 makes a few more decisions uncertain. This costs little, because an uncertain decision is only
/// repeated in the next precision.
const ROUNDING: f64 = 4.0;

impl<T: Real> Ball<T> {
    /// Returns the ball of radius 0 at `x`.
    pub fn exact(x: f64) -> Self {
        Self {
            mid: T::from_f64(x),
            rad: T::Radius::ZERO,
        }
    }

    /// Returns the ball about the computed number `mid`. Its radius is `inherited`, the error from
    /// the operands, plus the rounding error of `mid`.
    fn rounded(mid: T, inherited: T::Radius) -> Self {
        let rounding = if mid.is_zero() {
            T::Radius::ZERO
        } else {
            mid.magnitude() * (ROUNDING * T::UNIT) + T::TINY
        };
        Self {
            mid,
            rad: (inherited + rounding) * UP,
        }
    }

    /// Computes the difference `a` − `b` of two exact numbers, as a ball.
    pub fn difference(a: f64, b: f64) -> Self {
        Self::rounded(T::difference(a, b), T::Radius::ZERO)
    }

    /// Rounds `x` to the precision `T`. The radius covers the rounding error.
    pub fn from_big(x: &Big) -> Self {
        Self::rounded(T::from_big(x), underflow_loss::<T>(x.is_zero()))
    }

    /// Returns the absolute value of the midpoint.
    pub fn size(&self) -> T::Radius {
        self.mid.magnitude()
    }

    /// Returns whether the ball's relative error is at most 2^−80, far below that of `f64`. If so,
    /// the caller need not repeat the computation in a higher precision.
    pub fn is_precise(&self) -> bool {
        /// Maximum radius of a precise ball, divided by the absolute value of its midpoint: 2^−80,
        /// which is 27 bits below the unit roundoff of `f64`.
        const PRECISE: f64 = 1.0 / (1u128 << 80) as f64;
        self.rad <= self.size() * PRECISE
    }

    /// Returns whether the number is certainly positive or certainly negative. Returns `false` for
    /// NaN.
    fn is_clear(&self) -> bool {
        self.size() > self.rad * UP
    }

    /// Compares the number with zero. Returns a [`Doubt`] if the sign is uncertain. The highest
    /// precision never returns a doubt: a number that cannot be distinguished from zero is treated
    /// as zero.
    #[inline]
    pub fn sign(&self) -> Result<Ordering, Doubt> {
        if self.is_clear() {
            Ok(if self.mid.is_negative() {
                Ordering::Less
            } else {
                Ordering::Greater
            })
        } else if T::LAST || (self.rad == T::Radius::ZERO && self.mid.is_zero()) {
            Ok(Ordering::Equal)
        } else {
            Err(Doubt)
        }
    }

    /// Compares the number with `other`. Returns a [`Doubt`] if the sign of the difference is
    /// uncertain.
    #[inline]
    pub fn compare(&self, other: &Self) -> Result<Ordering, Doubt> {
        (self - other).sign()
    }

    /// Computes `self` · `power`, where `power` is a power of two.
    #[inline]
    pub fn times_power(&self, power: f64) -> Self {
        // The product with a power of two is exact, but it may underflow. So `TINY` is added to the
        // radius.
        Self {
            mid: self.mid.times(&T::from_f64(power)),
            rad: self.rad * power * UP + T::TINY,
        }
    }

    /// Computes `self` · 2^`exponent`.
    pub fn scaled(&self, exponent: i32) -> Self {
        let mid = self.mid.scaled(exponent);
        // The product with a power of two is exact, but it may underflow. So the maximum error by
        // underflow is added to the radius.
        let lost = underflow_loss::<T>(self.mid.is_zero());
        Self {
            mid,
            rad: self.rad.scaled(exponent) + lost,
        }
    }

    /// Computes the square root. The true number must not be negative. The midpoint may be negative
    /// by at most the radius.
    #[inline]
    pub fn sqrt(&self) -> Self {
        if !self.is_clear() {
            // The number may be 0. The root's midpoint is then 0, and its radius follows from |√a −
            // √b| ≤ √|a − b|.
            return Self {
                mid: T::from_f64(0.0),
                rad: ((self.size() + self.rad) * UP).sqrt() * UP,
            };
        }
        let root = self.mid.sqrt();
        // The radius follows from |√a − √b| = |a − b|/(√a + √b).
        let inherited = self.rad / root.magnitude();
        Self::rounded(root, inherited)
    }

    /// Returns the floor, the greatest integer that is not greater than the number, and whether the
    /// floor is odd. Returns a [`Doubt`] if an integer lies within the ball. The highest precision
    /// never returns a doubt: a number that cannot be distinguished from an integer is treated as
    /// this integer.
    pub fn floor(&self) -> Result<(Self, bool), Doubt> {
        let (floor, odd) = self.mid.floor();
        let ceiling = floor.plus(&T::from_f64(1.0));
        let below = self.mid.minus(&floor).magnitude();
        let above = ceiling.minus(&self.mid).magnitude();
        let rad = self.rad * UP;
        let exact = |mid| Self {
            mid,
            rad: T::Radius::ZERO,
        };
        if self.rad == T::Radius::ZERO || (below > rad && above > rad) {
            Ok((exact(floor), odd))
        } else if !T::LAST {
            Err(Doubt)
        } else if below < above {
            Ok((exact(floor), odd))
        } else {
            Ok((exact(ceiling), !odd))
        }
    }

    #[inline]
    fn add(&self, other: &Self) -> Self {
        Self::rounded(self.mid.plus(&other.mid), self.rad + other.rad)
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        Self::rounded(self.mid.minus(&other.mid), self.rad + other.rad)
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        let mid = self.mid.times(&other.mid);
        let (a, b) = (self.size(), other.size());
        let inherited = a * other.rad + self.rad * b + self.rad * other.rad;
        let lost = underflow_loss::<T>(self.mid.is_zero() || other.mid.is_zero());
        Self::rounded(mid, inherited + lost)
    }

    #[inline]
    fn div(&self, other: &Self) -> Self {
        if !other.is_clear() {
            return Self {
                mid: T::from_f64(0.0),
                rad: T::Radius::INFINITE,
            };
        }
        let mid = self.mid.over(&other.mid);
        // Let a and b be the midpoints, and a' and b' the true numbers. Then the error is
        //
        //   |a'/b' − a/b| ≤ (|a' − a| + |a/b|·|b' − b|)/|b'|.
        //
        // Here, |b'| is at least `least`: |b| minus the radius of b.
        let least = other.size().without(other.rad * UP);
        let lost = underflow_loss::<T>(self.mid.is_zero());
        let inherited = (self.rad + mid.magnitude() * other.rad) / least * UP + lost;
        Self::rounded(mid, inherited)
    }
}

impl<T: Real> std::ops::Neg for &Ball<T> {
    type Output = Ball<T>;
    fn neg(self) -> Ball<T> {
        Ball {
            mid: self.mid.negated(),
            rad: self.rad,
        }
    }
}

impl<T: Real> std::ops::Neg for Ball<T> {
    type Output = Self;
    fn neg(self) -> Self {
        -&self
    }
}

/// Implements an arithmetic operator of balls for all combinations of values and references.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        operator!($trait, $method, &Ball<T>, &Ball<T>);
        operator!($trait, $method, &Ball<T>, Ball<T>);
        operator!($trait, $method, Ball<T>, &Ball<T>);
        operator!($trait, $method, Ball<T>, Ball<T>);
    };
    ($trait:ident, $method:ident, $left:ty, $right:ty) => {
        impl<T: Real> std::ops::$trait<$right> for $left {
            type Output = Ball<T>;
            #[inline]
            fn $method(self, other: $right) -> Ball<T> {
                let (left, right): (&Ball<T>, &Ball<T>) = (self.borrow(), other.borrow());
                Ball::$method(left, right)
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

/// Returns the maximum error of an operation by underflow: [`TINY`](Real::TINY), or 0 if the exact
/// result is known to be 0.
#[inline]
fn underflow_loss<T: Real>(is_zero: bool) -> T::Radius {
    if is_zero { T::Radius::ZERO } else { T::TINY }
}

/// A vector of balls.
pub type Ball3<T> = [Ball<T>; 3];

/// Computes the dot product of `a` and `b`.
pub fn dot<T: Real>(a: &Ball3<T>, b: &Ball3<T>) -> Ball<T> {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// Computes the cross product `a` × `b`.
pub fn cross<T: Real>(a: &Ball3<T>, b: &Ball3<T>) -> Ball3<T> {
    [
        &a[1] * &b[2] - &a[2] * &b[1],
        &a[2] * &b[0] - &a[0] * &b[2],
        &a[0] * &b[1] - &a[1] * &b[0],
    ]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::math::Double;

    /// Returns the results of a few formulas that subtract nearly equal numbers, divide and take
    /// roots.
    fn formula<T: Real>(x: f64, y: f64, z: f64) -> Vec<Ball<T>> {
        let [a, b, c] = [x, y, z].map(Ball::<T>::exact);
        let three = Ball::exact(3.0);
        let third = &a / &three;
        let square = &b * &b + &c * &c;
        let root = square.sqrt();
        let cancelled = &(&third * &three) - &a;
        let small = (&root - &b) * (&root + &b) - &c * &c;
        let quotient = &(&a + &root) / &(&square + &three);
        vec![third, square, root, cancelled, small, quotient]
    }

    fn big(x: &Double) -> Big {
        Big::from_f64(x.hi).plus(&Big::from_f64(x.lo))
    }

    proptest! {
        #[test]
        fn balls_hold_the_true_number(
            x in -1e9..1e9f64, y in -1e3..1e3f64, z in prop::num::f64::NORMAL.prop_map(|z| z % 1e6)
        ) {
            let singles = formula::<f64>(x, y, z).into_iter();
            let singles = singles.map(|ball| (Big::from_f64(ball.mid), ball.rad));
            let doubles = formula::<Double>(x, y, z).into_iter();
            let doubles = doubles.map(|ball| (big(&ball.mid), ball.rad));
            let precise = formula::<Big>(x, y, z);
            for ((mid, rad), precise) in singles.chain(doubles).zip(precise.iter().cycle()) {
                let error = Real::to_f64(&mid.minus(&precise.mid)).abs();
                prop_assert!(error <= rad, "{error} > {rad}");
            }
        }

        #[test]
        fn double_operations_keep_their_bound(
            a in -1e20..1e20f64, low in -0.5..0.5f64, b in 1e-20..1e20f64, other in -0.5..0.5f64
        ) {
            let join = |hi: f64, lo: f64| crate::math::two_sum(hi, lo * hi * f64::EPSILON / 2.0);
            let (a, b) = (join(a, low), join(b, other));
            for (got, want) in [
                (a.plus(&b), big(&a).plus(&big(&b))),
                (a.minus(&b), big(&a).minus(&big(&b))),
                (a.times(&b), big(&a).times(&big(&b))),
                (a.over(&b), big(&a).over(&big(&b))),
                (b.sqrt(), big(&b).sqrt()),
            ] {
                let error = big(&got).minus(&want).to_f64().abs();
                prop_assert!(error <= Double::UNIT * want.to_f64().abs());
            }
        }

        #[test]
        fn floors_and_parities_agree(x in -1e15..1e15f64) {
            let expected = Ok((x.floor(), (x.floor() as i64).rem_euclid(2) == 1));
            prop_assert_eq!(floor::<f64>(&Ball { mid: x, rad: 0.0 }), expected);
            prop_assert_eq!(floor::<Double>(&Ball::exact(x)), expected);
            prop_assert_eq!(floor::<Big>(&Ball::exact(x)), expected);
        }
    }

    fn floor<T: Real>(x: &Ball<T>) -> Result<(f64, bool), Doubt> {
        x.floor().map(|(floor, odd)| (floor.mid.to_f64(), odd))
    }

    #[test]
    fn a_number_just_below_an_integer_is_not_that_integer() {
        assert_eq!(floor(&Ball::<Big>::exact(-5e-17)), Ok((-1.0, true)));
        let tie = Ball::<Big>::exact(1.0) / Ball::exact(3.0) * Ball::exact(3.0);
        assert_eq!(floor(&tie), Ok((1.0, true)));
    }

    #[test]
    fn overflow_is_doubt() {
        let huge = Ball::<f64>::exact(1e200);
        let overflow = &huge * &huge;
        assert_eq!((&overflow - &overflow).sign(), Err(Doubt));
        assert_eq!(overflow.compare(&huge), Err(Doubt));
        assert_eq!((&huge / &Ball::exact(0.0)).sign(), Err(Doubt));
    }

    #[test]
    fn underflow_is_doubt() {
        let tiny = Big::from_f64(1e-300).scaled(-1000);
        assert_eq!(Ball::<Double>::from_big(&tiny).sign(), Err(Doubt));
        assert_eq!(Ball::<Big>::from_big(&tiny).sign(), Ok(Ordering::Greater));
    }
}
