//! Sine and cosine with an error bound.
//!
//! Degrees are reduced modulo 360 without rounding before they are converted to radians. Multiples
//! of 90°, however large, therefore have sines and cosines of exactly 0 or ±1. The reduced angle is
//! at most 45°.

use std::{array, ops::Neg, sync::LazyLock};

use super::{Angle, Ball, Big, Double, Real, double::two_product};

/// Maximum absolute value of an angle's part in radians at which the sine and the cosine are
/// computed by series in double-double. For larger values, [`Big`] computes them, because its π has
/// enough digits for any angle. An angle up to the limit has less than 2^20 quarter turns. The
/// error from the rounding of π/2 is therefore at most 2^20·2^−163 = 2^−143, which is negligible
/// compared with the unit roundoff of double-double, 2^−102.
const MAX_RADIANS: f64 = (1u64 << 20) as f64;

/// Number of terms of the series of the sine, and of the series of the cosine. The argument r is at
/// most 0.8, a little more than π/4. With 15 terms, the first omitted term of the cosine is r³⁰/30!
/// < 2^−117. The first omitted term of the sine, divided by r, is r³⁰/31! < 2^−122.
const TERMS: usize = 15;
/// Maximum truncation error of a series: 2^−116. For the cosine, it is the absolute error. For the
/// sine, it is the error divided by the series' argument. The terms alternate in sign and decrease,
/// so the error is at most the first omitted term, which is less than 2^−117.
const TRUNCATION: f64 = 1.0 / (1u128 << 116) as f64;

/// Constants for the reduction of angles modulo quarter turns, and coefficients of the series.
struct Constants {
    /// π/2 as the sum of three `f64`. The error is at most half a unit in the last place of the
    /// third `f64`, 2^−163.
    quarter_turn: [f64; 3],
    radians_per_degree: Ball<Double>,
    /// Coefficients (−1)ⁿ/(2n)! of the cosine.
    cosine: [Ball<Double>; TERMS],
    /// Coefficients (−1)ⁿ/(2n + 1)! of the sine divided by its argument.
    sine: [Ball<Double>; TERMS],
}

static CONSTANTS: LazyLock<Constants> = LazyLock::new(|| {
    let quarter_turn = Big::quarter_turn();
    let mut rest = quarter_turn.clone();
    let parts = array::from_fn(|_| {
        let part = Real::to_f64(&rest);
        rest = rest.minus(&Big::from_f64(part));
        part
    });
    // The factorials 0!, 1!, 2!, … are each computed from the previous one.
    let mut factorial = Big::from_f64(1.0);
    let reciprocals: [Ball<Double>; 2 * TERMS] = array::from_fn(|n| {
        factorial = factorial.times(&Big::from_f64(n.max(1) as f64));
        let reciprocal = Ball::from_big(&Big::from_f64(1.0).over(&factorial));
        // The list holds the coefficients of both series: those of the cosine at even n, and those
        // of the sine at odd n. Their signs alternate within each series, so they are +, +, −, −,
        // and so on.
        if n % 4 < 2 { reciprocal } else { -reciprocal }
    });
    Constants {
        quarter_turn: parts,
        radians_per_degree: Ball::from_big(&quarter_turn.over(&Big::from_f64(90.0))),
        cosine: array::from_fn(|n| reciprocals[2 * n].clone()),
        sine: array::from_fn(|n| reciprocals[2 * n + 1].clone()),
    }
});

/// Returns the sine and the cosine of an angle. For a multiple of 90°, they are exactly 0 and ±1.
/// In double-double, they are computed by series if the part in radians is at most 2^20. Otherwise,
/// they are rounded from a [`Big`].
pub fn sin_cos<T: Real>(angle: Angle) -> (Ball<T>, Ball<T>) {
    if T::UNIT == Double::UNIT && angle.radians.abs() <= MAX_RADIANS {
        let (sin, cos) = by_series(angle);
        return (from_double(&sin), from_double(&cos));
    }
    let (sin, cos) = Big::sin_cos(angle);
    (Ball::from_big(&sin), Ball::from_big(&cos))
}

/// Converts a ball of [`Double`] to a ball of `T` in generic code, where `T` must be [`Double`],
/// too. The two `f64` of a double-double number are the number rounded to `f64` and the remaining
/// difference. Adding the two in double-double gives the same number again, without rounding.
fn from_double<T: Real>(x: &Ball<Double>) -> Ball<T> {
    let [hi, lo, rad] = [x.mid.hi, x.mid.lo, x.rad].map(T::from_f64);
    Ball {
        mid: hi.plus(&lo),
        rad: rad.magnitude(),
    }
}

fn by_series(angle: Angle) -> (Ball<Double>, Ball<Double>) {
    let degrees = sin_cos_degrees(angle.degrees);
    if angle.radians == 0.0 {
        return degrees;
    }
    let radians = sin_cos_radians(angle.radians);
    if angle.degrees == 0.0 {
        return radians;
    }
    let ((s, c), (t, d)) = (degrees, radians);
    (&s * &d + &c * &t, &c * &d - &s * &t)
}

fn sin_cos_degrees(degrees: f64) -> (Ball<Double>, Ball<Double>) {
    let (rest, quarters) = reduce_degrees(degrees);
    if rest == 0.0 {
        // In most scenes, all angles are multiples of 90°. `CONSTANTS` takes time to compute and is
        // not needed for them.
        return add_quarter_turns((Ball::exact(0.0), Ball::exact(1.0)), quarters);
    }
    let rest = Ball::exact(rest) * &CONSTANTS.radians_per_degree;
    add_quarter_turns(series(&rest), quarters)
}

/// Returns the sine and the cosine of an angle in radians. The angle is reduced modulo π/2 in three
/// steps (Cody and Waite). The first two steps subtract exact products.
fn sin_cos_radians(radians: f64) -> (Ball<Double>, Ball<Double>) {
    let [first, second, third] = CONSTANTS.quarter_turn;
    let quarters = (radians / first).round();
    let product = |part: f64| Ball {
        mid: two_product(quarters, part),
        rad: 0.0,
    };
    let last = Ball {
        mid: Double::from_f64(third),
        rad: third.abs() * f64::EPSILON,
    };
    let rest = Ball::exact(radians) - product(first) - product(second);
    add_quarter_turns(series(&(rest - Ball::exact(quarters) * last)), quarters)
}

/// Splits an angle in degrees into a rest, from −45 to 45 degrees, and a number of quarter turns.
/// Every step is exact: remainders are exact, and so is the difference between 90 and a number from
/// 45 to 90 (Sterbenz).
fn reduce_degrees(degrees: f64) -> (f64, f64) {
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

/// Returns the sine and the cosine of an angle plus `quarters` quarter turns, from the sine `sin`
/// and the cosine `cos` of the angle.
fn add_quarter_turns<T: Neg<Output = T>>((sin, cos): (T, T), quarters: f64) -> (T, T) {
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Evaluates the series of the sine and the cosine at the angle `r`, |r| ≤ 0.8 radians. The terms
/// are added from the smallest to the largest.
fn series(r: &Ball<Double>) -> (Ball<Double>, Ball<Double>) {
    let (zero, one) = (Ball::exact(0.0), Ball::exact(1.0));
    if r.mid.is_zero() && r.rad == 0.0 {
        return (zero, one);
    }
    let square = r * r;
    let sum = |terms: &[Ball<Double>; TERMS]| {
        let rest = Ball {
            mid: Double::from_f64(0.0),
            rad: TRUNCATION,
        };
        let all = |sum: Ball<Double>, term: &Ball<Double>| &sum * &square + term;
        let sum = terms.iter().rev().fold(zero.clone(), all);
        sum + rest
    };
    (r * &sum(&CONSTANTS.sine), sum(&CONSTANTS.cosine))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Maximum radius of the ball of a sine or cosine, in units of 2^−102, the unit roundoff of
    /// double-double. The three values are for angles in degrees, in radians, and with both parts.
    /// The values are upper bounds that follow from the error rules of [`Ball`]:
    ///
    /// - Radius of the reduced angle r: at most 8·|r| units for degrees, and 12·π/4 for radians.
    /// - Radius of the sine and of the cosine at |r| = π/4: 19.9 and 19.6 units for degrees, 23.4
    ///   and 22.1 units for radians.
    /// - Angles with both parts, where two products of numbers about √½ are added:
    ///   2 + 2 + 4 + √½·(19.9 + 19.6 + 23.4 + 22.1) = 68.1 units.
    const WIDEST: [f64; 3] = [20.0, 24.0, 69.0];

    /// Returns whether the balls of the sine and the cosine contain the true numbers and are no
    /// wider than [`WIDEST`].
    fn is_right(degrees: f64, radians: f64) -> bool {
        let widest = match (degrees == 0.0, radians == 0.0) {
            (_, true) => WIDEST[0],
            (true, _) => WIDEST[1],
            _ => WIDEST[2],
        };
        let angle = Angle { degrees, radians };
        let (sin, cos) = sin_cos::<Double>(angle);
        let (true_sin, true_cos) = Big::sin_cos(angle);
        [(sin, true_sin), (cos, true_cos)]
            .iter()
            .all(|(Ball { mid, rad }, truth)| {
                let mid = Big::from_f64(mid.hi).plus(&Big::from_f64(mid.lo));
                let error = Real::to_f64(&mid.minus(truth)).abs();
                error <= *rad && *rad <= widest * Double::UNIT
            })
    }

    proptest! {
        #[test]
        fn the_true_numbers_lie_within(degrees in -1e6..1e6f64, radians in -1e6..1e6f64, size in 0..300i32) {
            let small = libm::exp2(f64::from(-size));
            prop_assert!(is_right(degrees * small, 0.0));
            prop_assert!(is_right(0.0, radians * small));
            prop_assert!(is_right(degrees, radians * small));
        }

        #[test]
        fn so_they_do_at_and_beside_eighths_of_a_turn(
            off in prop_oneof![Just(0.0), -1e-6..1e-6, -1e-300..1e-300],
            eighths in (-400..400i32).prop_map(f64::from),
        ) {
            prop_assert!(is_right(45.0 * eighths + off, 0.0));
            prop_assert!(is_right(0.0, std::f64::consts::FRAC_PI_4 * eighths + off));
        }
    }

    #[test]
    fn angles_far_away_and_the_widest_balls_are_right() {
        // Both parts of the angle are about 45° from a multiple of 90°, where the balls of the sine
        // and the cosine are widest.
        assert!(is_right(-302176.406925716, -675013.4458038831 / 64.0));
        for radians in [1e7, -3e20, MAX_RADIANS, 1e300] {
            assert!(is_right(0.0, radians), "{radians}");
        }
    }

    #[test]
    fn quarter_turns_have_no_error() {
        for (degrees, expected) in [(0.0, (0.0, 1.0)), (-90.0, (-1.0, 0.0)), (5.4e5, (0.0, 1.0))] {
            let (sin, cos) = sin_cos::<Double>(Angle::from_degrees(degrees));
            assert_eq!((sin.mid.hi, cos.mid.hi), expected, "{degrees}");
            assert_eq!((sin.rad, cos.rad), (0.0, 0.0), "{degrees}");
        }
    }
}
