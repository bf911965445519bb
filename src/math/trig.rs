//! Trigonometric functions of angles, the same on every machine.
//!
//! In: angles or numbers. Out: for angles, their sines, cosines and tangents, rounded from the
//! double-double numbers of `sine`; for numbers, libm's inverse functions.

use super::{Angle, Ball, Double, Real, sine};

/// Returns the sine of an angle.
pub fn sin(angle: Angle) -> f64 {
    sin_cos(angle).0.to_f64()
}

/// Returns the cosine of an angle.
pub fn cos(angle: Angle) -> f64 {
    sin_cos(angle).1.to_f64()
}

/// Returns the tangent of an angle. It is infinite at an odd multiple of 90 degrees.
pub fn tan(angle: Angle) -> f64 {
    let (sin, cos) = sin_cos(angle);
    if cos.is_zero() {
        f64::INFINITY
    } else {
        sin.over(&cos).to_f64()
    }
}

/// Returns the sine and the cosine of an angle in double-double; both are NaN if the angle is not
/// finite.
fn sin_cos(angle: Angle) -> (Double, Double) {
    if !angle.is_finite() {
        return (Double::from_f64(f64::NAN), Double::from_f64(f64::NAN));
    }
    let (Ball { mid: sin, .. }, Ball { mid: cos, .. }) = sine::sin_cos(angle);
    (sin, cos)
}

/// Returns the angle, from −90 to 90 degrees, whose sine is `sine`. Returns NaN if `sine` is not
/// within −1 to 1.
pub fn asin(sine: f64) -> Angle {
    Angle::from_radians(libm::asin(sine))
}

/// Returns the angle, from 0 to 180 degrees, whose cosine is `cosine`. Returns NaN if `cosine` is
/// not within −1 to 1.
pub fn acos(cosine: f64) -> Angle {
    Angle::from_radians(libm::acos(cosine))
}

/// Returns the angle, from −90 to 90 degrees, whose tangent is `tangent`.
pub fn atan(tangent: f64) -> Angle {
    Angle::from_radians(libm::atan(tangent))
}

/// Returns the angle from the x axis to the point (`x`, `y`), from −180 to 180 degrees.
pub fn atan2(y: f64, x: f64) -> Angle {
    Angle::from_radians(libm::atan2(y, x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_of_a_quarter_turn_are_exact() {
        let values = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
        for turns in [0.0, 1.0, -1.0, 12.0, -7.0, 1e9] {
            for (quarter, (s, c)) in values.iter().enumerate() {
                let angle = Angle::from_degrees(turns * 360.0 + quarter as f64 * 90.0);
                // Bits are compared, because a result that is zero must not be −0.
                let bits = [sin(angle), cos(angle)].map(f64::to_bits);
                assert_eq!(bits, [*s, *c].map(f64::to_bits), "{angle:?}");
            }
        }
        assert_eq!(sin(Angle::from_degrees(360.0 * 1e18)), 0.0);
    }

    #[test]
    fn known_values() {
        let known = [
            (sin as fn(Angle) -> f64, 30.0, 0.5),
            (sin, 150.0, 0.5),
            (sin, -30.0, -0.5),
            (cos, 60.0, 0.5),
            (cos, 120.0, -0.5),
            (cos, 45.0, 0.5_f64.sqrt()),
            (tan, 45.0, 1.0),
            (tan, -45.0, -1.0),
            (tan, 135.0, -1.0),
            (tan, 180.0, 0.0),
            (tan, 90.0, f64::INFINITY),
            (tan, -270.0, f64::INFINITY),
        ];
        for (of, degrees, value) in known {
            assert_eq!(of(Angle::from_degrees(degrees)), value, "{degrees}");
        }
    }

    #[test]
    fn degrees_and_radians_agree() {
        for step in 1..720 {
            let degrees = Angle::from_degrees(f64::from(step) * 0.7);
            let radians = Angle::from_radians(degrees.degrees * (std::f64::consts::PI / 180.0));
            for other in [radians, degrees / 2.0 + radians / 2.0] {
                assert!((sin(degrees) - sin(other)).abs() < 1e-14);
                assert!((cos(degrees) - cos(other)).abs() < 1e-14);
            }
        }
    }
}
