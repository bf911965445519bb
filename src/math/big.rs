//! Big numbers, the highest precision. They are used for decisions that are uncertain in
//! double-double.

use std::cmp::Ordering;

use dashu_float::{FBig, round::mode::HalfEven};
use dashu_int::Sign;

use super::Angle;

/// A binary floating-point number with a significand of 320 bits and an exponent that does not
/// overflow.
#[derive(Clone, Debug)]
pub struct Big(pub(super) Float);

/// A binary floating-point number of any precision. A result has the precision of its operands. The
/// precision 0 means that all operations except divisions are exact.
pub(super) type Float = FBig<HalfEven, 2>;

/// Number of bits of a [`Big`]. If a decision is uncertain in [`Double`](super::Double), the
/// compared numbers agree in about 90 bits. The other 230 bits are far more than the formulas lose
/// in their intermediate steps. A difference that cannot be distinguished from 0 with 320 bits is
/// treated as 0.
pub(super) const PRECISION: usize = 320;

/// Number of additional bits, beyond [`PRECISION`], in the few steps that subtract nearly equal
/// numbers. Even if 320 bits cancel, 320 correct bits remain.
const GUARD: usize = 320;

impl Big {
    /// Number of bits of a [`Big`]. An integer with more bits is rounded to this number of bits, so
    /// it is always even.
    pub const BITS: i32 = PRECISION as i32;

    /// Rounds `x` to the nearest big number.
    pub(super) fn round(x: Float) -> Self {
        Self(x.with_precision(PRECISION).value())
    }

    /// Returns the sine and the cosine of an angle. For a multiple of 90°, they are exactly 0 and
    /// ±1.
    pub fn sin_cos(angle: Angle) -> (Self, Self) {
        let (sin, cos) = sin_cos(angle, 1.0);
        (Self::round(sin), Self::round(cos))
    }

    /// Returns π/2, rounded to a big number.
    pub(super) fn quarter_turn() -> Self {
        Self::round(Float::pi(PRECISION + GUARD) / wide(2.0))
    }

    /// Returns the tangent of half of an angle, without loss of accuracy near 180°.
    pub fn tan_half(angle: Angle) -> Self {
        let (sin, cos) = sin_cos(angle, 0.5);
        Self::round(sin / cos)
    }

    /// Rounds to the nearest finite `f64`. The result is 0 only if the number is exactly 0; other
    /// numbers too small for an `f64` become the smallest subnormal number.
    pub fn to_finite(&self) -> f64 {
        let x = self.0.to_f64().value().clamp(f64::MIN, f64::MAX);
        if x != 0.0 || is_zero(&self.0) {
            return x;
        }
        let least = f64::from_bits(1);
        let is_negative = self.0.sign() == Sign::Negative;
        if is_negative { -least } else { least }
    }

    /// Returns the arctangent of the number, in degrees.
    pub fn atan_degrees(&self) -> Self {
        Self(self.0.atan_unit(360))
    }
}

/// Compares an angle with `half_turns` half turns (180° each). If the angle's part in radians is 0,
/// or if its part in degrees is equal to the half turns, the comparison is exact. Otherwise, the
/// difference contains π, which is irrational, so it is never zero. Its sign is determined with 640
/// bits.
pub fn compare_half_turns(angle: Angle, half_turns: f64) -> Ordering {
    let degrees = exact(angle.degrees) - exact(180.0 * half_turns);
    if angle.radians == 0.0 {
        return degrees.cmp(&Float::ZERO);
    }
    if is_zero(&degrees) {
        return exact(angle.radians).cmp(&Float::ZERO);
    }
    let bits = PRECISION + GUARD;
    let degrees = degrees.with_precision(bits).value();
    let left = degrees * Float::pi(bits) / wide(180.0) + wide(angle.radians);
    left.cmp(&Float::ZERO)
}

/// Returns whether `x` is zero, of either sign.
pub(super) fn is_zero(x: &Float) -> bool {
    x.repr().is_pos_zero() || x.repr().is_neg_zero()
}

/// Returns the sine and the cosine of `factor`·`angle`, where `factor` is a power of two.
fn sin_cos(angle: Angle, factor: f64) -> (Float, Float) {
    let part = |x: f64| wide(x) * wide(factor);
    let (sin_degrees, cos_degrees) = part(angle.degrees).sin_cos_unit(360);
    if angle.radians == 0.0 {
        return (sin_degrees, cos_degrees);
    }
    let (sin_radians, cos_radians) = part(angle.radians).sin_cos();
    (
        &sin_degrees * &cos_radians + &cos_degrees * &sin_radians,
        cos_degrees * cos_radians - sin_degrees * sin_radians,
    )
}

/// Converts a finite `f64` to a number of 640 bits, for steps that subtract nearly equal numbers.
fn wide(x: f64) -> Float {
    exact(x).with_precision(PRECISION + GUARD).value()
}

/// Converts a finite `f64` to a float of unlimited precision, whose sums, differences and products
/// are exact. Any other number becomes 0.
pub(super) fn exact(x: f64) -> Float {
    // The numbers of a scene and of sample points are finite. An infinite number or NaN would be a
    // bug, but it must not cause a panic in a release build.
    debug_assert!(x.is_finite());
    let x = if x.is_finite() { x } else { 0.0 };
    let float = Float::try_from(x).unwrap_or(Float::ZERO);
    float.with_precision(0).value()
}
