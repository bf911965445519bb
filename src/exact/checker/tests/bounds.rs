//! Checks the integrals of boards, and their error bounds. The reference is a sum over the board's
//! squares, computed in multiple precision.

use std::cell::RefCell;

use proptest::{prelude::*, test_runner::TestRunner};

use super::{
    super::{MAX_CUT_SQUARES, NEAR_SQUARES, form, split},
    *,
};
use crate::reference::{
    exact_board::{ExactBoard, NUMBER},
    tightness::Tightness,
};

/// Errors found, grouped by the method by which [`Homography::over`] computes the integral.
#[derive(Default)]
struct Found {
    few: Tightness,
    near: Tightness,
    mixed: Tightness,
    far: Tightness,
}

/// Returns a board whose forms differ from those of `board` by rounding errors. Each factor is
/// changed by a unit roundoff, in the direction that increases the integral over the pixel.
fn worst(board: &Homography) -> ExactBoard {
    let [a, b] = board.numerators;
    let forms = [a, b, board.denominator];
    let integral = |roundings| ExactBoard::of_rounded(forms, roundings).integral(&PIXEL);
    let of_rounded = integral([[0.0; 3]; 3]);
    let roundings = [0, 1, 2].map(|form| {
        [0, 1, 2].map(|factor| {
            let mut roundings = [[0.0; 3]; 3];
            roundings[form][factor] = 1.0;
            if integral(roundings) < of_rounded {
                -1.0
            } else {
                1.0
            }
        })
    });
    ExactBoard::of_rounded(forms, roundings)
}

/// Pixels of boards below the horizon, seen from any side.
fn pixels() -> impl Strategy<Value = Homography> {
    let parts = (
        0.0..360.0_f64,
        0.0..360.0_f64,
        prop::bool::ANY,
        (0.0..1.3_f64, -0.5..2.5_f64, -3.0..0.5_f64),
        prop::array::uniform2(-0.5..0.5_f64),
    );
    parts.prop_map(
        |(degrees, roll, mirrored, (height, focal, below), [x, y])| {
            let [height, focal, below] = [height, focal, below].map(libm::exp10);
            let view = PixelView {
                height,
                focal,
                degrees,
                place: DVec2::new(x * focal, 1.0 + height * focal * below),
                foot: DVec2::new(x, y),
            };
            let (sin, cos) = (libm::sin(roll.to_radians()), libm::cos(roll.to_radians()));
            let sign = if mirrored { -1.0 } else { 1.0 };
            let [a, b, below] = view
                .forms()
                .map(|[x, y, z]| [sign * (cos * x - sin * y), sin * x + cos * y, z]);
            Homography::new([a, b], below)
        },
    )
}

#[test]
fn errors_of_boards_are_within_tight_bounds() {
    let found = RefCell::new(Found::default());
    let half = ProptestConfig::default().cases / 2;
    let mut runner = TestRunner::new(ProptestConfig::with_cases(half));
    runner
        .run(&pixels(), |board| {
            let squares = board.squares(&PIXEL);
            prop_assume!(squares > 8.0 && squares < 200.0);
            let sum = board.alone(&PIXEL);
            let worst = worst(&board);
            let error = worst.integral(&PIXEL) - NUMBER.exact(sum.value);
            let [p, q] = board.slope;
            let depth = NEAR_SQUARES * (p.abs() + q.abs());
            let (mut far, mut near) = (Vec::new(), Vec::new());
            split(
                &PIXEL,
                |at| depth * form(&board.denominator, at) - 1.0,
                &mut far,
                &mut near,
            );
            let mut found = found.borrow_mut();
            let by = if squares <= MAX_CUT_SQUARES {
                &mut found.few
            } else if far.len() < 3 {
                &mut found.near
            } else if near.len() < 3 {
                &mut found.far
            } else {
                &mut found.mixed
            };
            // The errors of the lines on the two sides of a square have opposite signs. A typical
            // error is therefore smaller than the bound, by a factor of the square root of the
            // number of lines.
            let error = error.to_f64().value().abs();
            by.add(error, sum.bound, worst.lines(&PIXEL), &board);
            Ok(())
        })
        .unwrap();
    let found = found.into_inner();
    found.few.assert("few squares");
    found.near.assert("near squares");
    found
        .mixed
        .assert("near squares and the boundary of others");
    found.far.assert("the boundary of far squares");
}

/// The error bound is small if a single square, of any size, reaches up to the horizon.
#[test]
fn a_square_that_goes_to_the_horizon_is_known() {
    // The eye is 10^−`exponent` squares above the board, and one square fills nearly all of the
    // floor in the pixel. If the exponent is 90 or more, the board's matrix cannot be distinguished
    // from a singular one.
    for exponent in 0..90 {
        let view = PixelView {
            height: libm::pow(10.0, -f64::from(exponent)),
            focal: 14.0,
            degrees: 3.0,
            place: DVec2::new(0.0, 0.01),
            foot: DVec2::new(0.3, 0.4),
        };
        let board = view.board();
        let BoundedSum { value, bound } = board.alone(&PIXEL);
        assert!(bound < 1e-9, "{bound} of {view:?}");
        // A little more than half of the pixel, 0.51, shows the floor. The eye is above one square
        // and at least 0.3 squares away from all others. This square therefore fills nearly all of
        // the visible floor.
        let others = view.focal * view.height / 0.3;
        let is_one = (value - 0.51).abs() <= bound + 2.0 * others;
        assert!(is_one, "{value} of {view:?}");
    }
}
