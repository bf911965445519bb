//! Sine and kin of angles, the same on every machine.
//!
//! In: angles, or numbers. Out: the double-double numbers of `sine`, rounded; and libm's inverse functions.

use super::{Angle, Ball, Double, Real, sine};

/// The sine of an angle.
pub fn sin(angle: Angle) -> f64 {
    let (sin, _) = sin_cos(angle);
    sin.to_f64()
}

/// The cosine of an angle.
pub fn cos(angle: Angle) -> f64 {
    let (_, cos) = sin_cos(angle);
    cos.to_f64()
}

/// The tangent of an angle; infinite at an odd multiple of 90 degrees.
pub fn tan(angle: Angle) -> f64 {
    let (sin, cos) = sin_cos(angle);
    match cos.is_zero() {
        true => f64::INFINITY,
        false => sin.over(&cos).to_f64(),
    }
}

/// Sine and cosine in double-double, not a number of an angle that is none.
fn sin_cos(angle: Angle) -> (Double, Double) {
    if !angle.is_finite() {
        return (Double::from_f64(f64::NAN), Double::from_f64(f64::NAN));
    }
    let (Ball { mid: sin, .. }, Ball { mid: cos, .. }) = sine::sin_cos(angle);
    (sin, cos)
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
            let radians = Angle::from_radians(angle * (std::f64::consts::PI / 180.0));
            assert!((sin(degrees(angle)) - sin(radians)).abs() < 1e-14);
            assert!((cos(degrees(angle)) - cos(radians)).abs() < 1e-14);
            let mixed = degrees(angle / 2.0) + Angle::from_radians(radians.radians / 2.0);
            assert!((sin(mixed) - sin(radians)).abs() < 1e-14);
        }
    }
}
