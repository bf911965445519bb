//! Sine and kin of angles, the same on every machine.
//!
//! Degrees are reduced mod 360 without rounding before they become radians, so that multiples of 90° give exactly 0 and ±1
//! however large they are. What is left is at most 45°; it becomes radians in two parts, and libm does the rest.

use std::ops::Neg;

use super::Angle;

/// π/180 rounded to an f64, and what is left of it: together they are good to 107 bits.
const RADIANS_PER_DEGREE: (f64, f64) = (0.017453292519943295, 2.9486522708701687e-19);

/// The sine and the cosine of an angle.
pub fn sin_cos(angle: Angle) -> (f64, f64) {
    let radians = angle.radians;
    if angle.degrees == 0.0 {
        return (libm::sin(radians), libm::cos(radians));
    }
    let (sin, cos) = sin_cos_degrees(angle.degrees);
    if radians == 0.0 {
        return (sin, cos);
    }
    let (s, c) = (libm::sin(radians), libm::cos(radians));
    (sin * c + cos * s, cos * c - sin * s)
}

/// The sine of an angle.
pub fn sin(angle: Angle) -> f64 {
    sin_cos(angle).0
}

/// The cosine of an angle.
pub fn cos(angle: Angle) -> f64 {
    sin_cos(angle).1
}

/// The tangent of an angle; infinite at an odd multiple of 90 degrees.
pub fn tan(angle: Angle) -> f64 {
    if angle.degrees == 0.0 {
        return libm::tan(angle.radians);
    }
    if angle.radians == 0.0 && angle.degrees % 45.0 == 0.0 {
        // Not the quotient of two roundings of √½.
        return match (angle.degrees / 45.0) % 4.0 {
            0.0 => 0.0,
            1.0 | -3.0 => 1.0,
            -1.0 | 3.0 => -1.0,
            _ => f64::INFINITY,
        };
    }
    let (sin, cos) = sin_cos(angle);
    sin / cos
}

/// The angle whose sine this is; none outside of −1 to 1.
pub fn asin(sine: f64) -> Angle {
    Angle::from_radians(libm::asin(sine))
}

/// The angle whose cosine this is; none outside of −1 to 1.
pub fn acos(cosine: f64) -> Angle {
    Angle::from_radians(libm::acos(cosine))
}

/// The angle whose tangent this is, between −90 and 90 degrees.
pub fn atan(tangent: f64) -> Angle {
    Angle::from_radians(libm::atan(tangent))
}

/// The angle from the x axis to the point (x, y).
pub fn atan2(y: f64, x: f64) -> Angle {
    Angle::from_radians(libm::atan2(y, x))
}

/// Sine and cosine of an angle in degrees.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let (rest, quarters) = reduced(degrees);
    let (sine, cosine) = turned(sin_cos_up_to_45(rest), quarters);
    // The sign of a zero would show in atan2; adding 0 takes it away.
    (sine + 0.0, cosine + 0.0)
}

/// What is left of an angle in degrees, 45 at most, beside so many quarter turns. Every step is exact: a remainder is, and so is a difference to 90 of
/// a number between 45 and 90 (Sterbenz).
pub(super) fn reduced(degrees: f64) -> (f64, f64) {
    let within_turn = degrees % 360.0;
    let mut rest = within_turn % 90.0;
    let mut quarters = (within_turn - rest) / 90.0;
    if rest > 45.0 {
        rest -= 90.0;
        quarters += 1.0;
    } else if rest < -45.0 {
        rest += 90.0;
        quarters -= 1.0;
    }
    (rest, quarters)
}

/// Sine and cosine after so many quarter turns more.
pub(super) fn turned<T: Neg<Output = T>>((sin, cos): (T, T), quarters: f64) -> (T, T) {
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

fn sin_cos_up_to_45(degrees: f64) -> (f64, f64) {
    if degrees == 0.0 {
        return (degrees, 1.0);
    }
    let (high, low) = RADIANS_PER_DEGREE;
    let radians = degrees * high;
    let left = libm::fma(degrees, high, -radians) + degrees * low;
    let (s, c) = (libm::sin(radians), libm::cos(radians));
    // sin(r + h) = sin r + h cos r, as far as h shows.
    let cosine = c - left * s;
    let sine = if degrees.abs() == 30.0 {
        // Half, which no rounding is to take away.
        0.5_f64.copysign(degrees)
    } else {
        s + left * c
    };
    (sine, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn degrees(degrees: f64) -> Angle {
        Angle::from_degrees(degrees)
    }

    #[test]
    fn multiples_of_a_quarter_turn_are_exact() {
        let values = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
        for turns in [0.0, 1.0, -1.0, 12.0, -7.0, 1e9, 2.0_f64.powi_exact(60)] {
            for (quarter, (s, c)) in values.iter().enumerate() {
                let angle = degrees(turns * 360.0 + quarter as f64 * 90.0);
                if turns.abs() < 1e12 {
                    assert_eq!((sin(angle), cos(angle)), (*s, *c), "{angle:?}");
                    let negative = |x: f64| x == 0.0 && x.is_sign_negative();
                    assert!(!negative(sin(angle)) && !negative(cos(angle)), "{angle:?}");
                }
            }
        }
        assert_eq!(sin(degrees(360.0 * 1e18)), 0.0);
    }

    trait PowiExact {
        fn powi_exact(self, power: u32) -> f64;
    }

    impl PowiExact for f64 {
        fn powi_exact(self, power: u32) -> f64 {
            (0..power).fold(1.0, |product, _| product * self)
        }
    }

    #[test]
    fn known_values() {
        assert_eq!(sin(degrees(30.0)), 0.5);
        assert_eq!(sin(degrees(150.0)), 0.5);
        assert_eq!(cos(degrees(60.0)), 0.5);
        assert_eq!(cos(degrees(120.0)), -0.5);
        assert_eq!(sin(degrees(-30.0)), -0.5);
        assert_eq!(tan(degrees(45.0)), 1.0);
        assert_eq!(tan(degrees(-45.0)), -1.0);
        assert_eq!(tan(degrees(135.0)), -1.0);
        assert_eq!(tan(degrees(180.0)), 0.0);
        assert!(tan(degrees(90.0)).is_infinite());
        assert!(tan(degrees(-270.0)).is_infinite());
        assert_eq!(cos(degrees(45.0)), 0.5_f64.sqrt());
    }

    #[test]
    fn degrees_and_radians_agree() {
        for step in 1..720 {
            let angle = f64::from(step) * 0.7;
            let radians = Angle::from_radians(angle * RADIANS_PER_DEGREE.0);
            assert!((sin(degrees(angle)) - sin(radians)).abs() < 1e-14);
            assert!((cos(degrees(angle)) - cos(radians)).abs() < 1e-14);
            let mixed = degrees(angle / 2.0) + Angle::from_radians(radians.radians / 2.0);
            assert!((sin(mixed) - sin(radians)).abs() < 1e-14);
        }
    }
}
