//! Compares [`Conic::doubtful_area`] with an estimate from grid points. A point lies in the
//! doubtful area if the conic's error leaves open on which side of the conic it lies.

use std::cell::RefCell;

use proptest::{prelude::*, test_runner::TestRunner};

use super::*;
use crate::reference::tightness::Tightness;

/// Number of rows, and of columns, of the grid of points in a pixel.
const POINTS: i32 = 300;

/// Tightness of the three bounds whose minimum is [`Conic::doubtful_area`].
#[derive(Default)]
struct Found {
    any: Tightness,
    steep: Tightness,
    ellipse: Tightness,
}

/// Returns the fraction of the pixel's grid points at which the absolute value of a conic's form is
/// at most the form's error.
fn share(conic: &Conic) -> f64 {
    let [a, b, c, d, e, f] = conic.factors.map(|factor| factor.hi);
    let place = |i: i32| (f64::from(i) + 0.5) / f64::from(POINTS) - 0.5;
    let mut count = 0;
    for (x, y) in (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (place(i), place(j)))) {
        let value = a * x * x + 2.0 * b * x * y + c * y * y + 2.0 * (d * x + e * y) + f;
        count += i32::from(value.abs() <= conic.rad);
    }
    f64::from(count) / f64::from(POINTS * POINTS)
}

#[test]
fn doubtful_areas_of_conics_are_tight() {
    let found = RefCell::new(Found::default());
    let number = || -1.0..1.0_f64;
    let cases = (
        prop::array::uniform6(number()),
        prop::array::uniform2(0.1..1.0_f64),
        0..3_u8,
        -2.5..-1.5_f64,
    );
    TestRunner::default()
        .run(&cases, |([a, b, c, d, e, f], [p, q], kind, rad)| {
            // Kind 0 is nearly a line, kind 1 an ellipse, and kind 2 a pair of lines, one of them
            // through the pixel's centre.
            let factors = match kind {
                0 => [0.1 * a, 0.1 * b, 0.1 * c, 0.5, 0.5 * e, 0.2 * f],
                1 => [p, 0.5 * b * p.min(q), q, 0.02 * d, 0.02 * e, -0.03],
                _ => [a * c, 0.5 * (a * e + b * c), b * e, 0.1 * a, 0.1 * b, 0.0],
            };
            let size = factors.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
            let conic = Conic {
                factors: factors.map(|x| Double::from_f64(x / size)),
                rad: libm::exp10(rad),
            };
            let [a, b, c, d, e, _] = conic.factors.map(|factor| factor.hi);
            let bound = conic.doubtful_area();
            let gradient =
                2.0 * libm::hypot(d, e) - libm::hypot(a.abs() + b.abs(), b.abs() + c.abs());
            let mut found = found.borrow_mut();
            let by = if bound >= 32.0 * conic.rad.sqrt() {
                &mut found.any
            } else if gradient > 0.0 && bound >= 15.9 * conic.rad / gradient {
                &mut found.steep
            } else {
                &mut found.ellipse
            };
            by.add(share(&conic), bound, 1, conic);
            Ok(())
        })
        .unwrap();
    let found = found.into_inner();
    found.any.assert("any conic");
    found.steep.assert("a steep conic");
    found.ellipse.assert("an ellipse");
}

proptest! {
    #[test]
    fn ranges_of_conics_hold_all_values_and_no_others(
        factors in prop::array::uniform6(-1.0..1.0_f64),
    ) {
        let conic = Conic {
            factors: factors.map(Double::from_f64),
            rad: 0.0,
        };
        let range = conic.over_pixel();
        let [a, b, c, d, e, f] = factors;
        let place = |i: i32| f64::from(i) / 40.0 - 0.5;
        let points = (0..=40).flat_map(|i| (0..=40).map(move |j| (place(i), place(j))));
        let values = points.map(|(x, y)| {
            a * x * x + 2.0 * b * x * y + c * y * y + 2.0 * (d * x + e * y) + f
        });
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values.fold(none, |(low, high), value| (low.min(value), high.max(value)));
        // An extreme inside the pixel is at most 1/80 from one of the tested points in x and in y,
        // and the second derivatives are at most 2. The form's value at this tested point therefore
        // differs from the extreme value by at most 4/80².
        let apart = 4.0 / 6400.0;
        prop_assert!(range.low <= low && low - apart <= range.low, "{range:?}, not from {low}");
        prop_assert!(range.high >= high && high + apart >= range.high, "{range:?}, not to {high}");
    }
}
