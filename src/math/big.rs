//! Big numbers: what decides where double-double leaves a doubt.

use std::cmp::Ordering;

use dashu_float::{FBig, round::mode::HalfEven};
use dashu_int::Sign;

use super::Angle;

/// A binary floating-point number with 320 bits and an exponent that does not run out.
#[derive(Clone, Debug)]
pub struct Big(pub(super) Float);

/// A float whose precision is that of its operands; 0 stands for unlimited, exact as long as
/// nothing is divided.
pub(super) type Float = FBig<HalfEven, 2>;

/// Bits of a [`Big`]. A decision that [`Double`](super::Double) cannot make is closer than about
/// 2^−90, and one closer than that counts as a tie anyway; what remains is far more than the
/// intermediate steps of any formula here lose.
pub(super) const PRECISION: usize = 320;

/// Further bits for the few steps that cancel: as many as a result has, so that these are left
/// where as many cancel.
const GUARD: usize = 320;

impl Big {
    /// Bits of a big number. A whole number with more of them has the nearest one with as many in
    /// its place, which is even.
    pub const BITS: i32 = PRECISION as i32;

    /// The nearest with so many bits.
    pub(super) fn round(x: Float) -> Self {
        Self(x.with_precision(PRECISION).value())
    }

    /// Sine and cosine of an angle; of a multiple of 90° exactly 0 and ±1.
    pub fn sin_cos(angle: Angle) -> (Self, Self) {
        let (sin, cos) = sin_cos(angle, 1.0);
        (Self::round(sin), Self::round(cos))
    }

    /// π/2.
    pub(super) fn quarter_turn() -> Self {
        Self::round(Float::pi(PRECISION + GUARD) / wide(2.0))
    }

    /// The tangent of half an angle, without loss near 180°.
    pub fn tan_half(angle: Angle) -> Self {
        let (sin, cos) = sin_cos(angle, 0.5);
        Self::round(sin / cos)
    }

    /// The nearest finite `f64`, and not 0 for what is not 0.
    pub fn to_finite(&self) -> f64 {
        let x = self.0.to_f64().value().clamp(f64::MIN, f64::MAX);
        match x == 0.0 && !is_zero(&self.0) {
            true if self.0.sign() == Sign::Negative => -f64::from_bits(1),
            true => f64::from_bits(1),
            false => x,
        }
    }

    /// The angle whose tangent is this, in degrees.
    pub fn atan_degrees(&self) -> Self {
        Self(self.0.atan_unit(360))
    }
}

/// How an angle compares with so many half turns. Degrees are compared as they are; where radians
/// are added to them, π is, which is irrational: what is left is never zero, and has more digits
/// than would have to cancel.
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

/// Whether it is zero, of either sign.
pub(super) fn is_zero(x: &Float) -> bool {
    x.repr().is_pos_zero() || x.repr().is_neg_zero()
}

/// Sine and cosine of `factor` (a power of two) times an angle.
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

/// A finite `f64` with the precision for steps that cancel.
fn wide(x: f64) -> Float {
    exact(x).with_precision(PRECISION + GUARD).value()
}

/// A finite `f64` as a number whose sums and products are exact.
pub(super) fn exact(x: f64) -> Float {
    // Numbers of a scene are finite, and so are sample points; anything else would be a mistake of
    // ours, and zero keeps it from becoming a panic.
    debug_assert!(x.is_finite());
    let x = if x.is_finite() { x } else { 0.0 };
    let float = Float::try_from(x).unwrap_or(Float::ZERO);
    float.with_precision(0).value()
}
