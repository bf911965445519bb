//! Checks the results of batched pixels, and their error bounds. The reference is a sum over the
//! board's squares, computed in multiple precision.

use std::cell::RefCell;

use proptest::test_runner::TestRunner;

use super::*;
use crate::reference::{
    exact_board::{ExactBoard, NUMBER},
    oracle::{Oracle, USUAL_SIZES},
    tightness::Tightness,
};

/// Returns the linear forms that map a position in `pixel` to coordinates on a board. The board has
/// the height `y`, below `eye`. Each coordinate is the quotient of two of the forms, in squares
/// with the side `square`.
///
/// A ray with the direction r from the eye e meets the board at x = e_x + (y − e_y)·r_x/r_y. The
/// formula for the other coordinate is the same with z instead of x. Every component of r is a
/// linear form of the position in the pixel.
fn forms(oracle: &Oracle, pixel: &BoardPixel, eye: DVec3, [y, square]: [f64; 2]) -> ExactBoard {
    let number = |x| oracle.number.exact(x);
    let ray = |x, y| oracle.direction(pixel.x, pixel.y, dvec2(x, y));
    let [middle, right, down] = [ray(0.0, 0.0), ray(1.0, 0.0), ray(0.0, 1.0)];
    let component = |axis: usize| {
        let middle = &middle[axis];
        [&right[axis] - middle, &down[axis] - middle, middle.clone()]
    };
    let denominator = component(1).map(|factor| -factor);
    let height = number(eye.y) - number(y);
    let numerators = [0, 2].map(|axis| {
        let along = component(axis);
        let from = number(eye.to_array()[axis]);
        [0, 1, 2].map(|k| (&from * &denominator[k] + &height * &along[k]) / number(square))
    });
    ExactBoard {
        numerators,
        denominator,
    }
}

#[test]
fn errors_of_batches_are_within_tight_bounds() {
    let found = RefCell::new(Tightness::default());
    let cases = (
        prop::array::uniform2(-9.0..9.0_f64),
        prop::array::uniform2(-0.5..1.5_f64),
        0.0..360.0_f64,
        0.0..89.0_f64,
        0.0..360.0_f64,
        5.0..120.0_f64,
    );
    TestRunner::default()
        .run(
            &cases,
            |([x, z], [height, square], yaw, down, roll, fov)| {
                let (yaw, down) = (yaw.to_radians(), down.to_radians());
                let [height, square] = [height, square].map(libm::exp10);
                let eye = dvec3(x, 0.25 + height, z);
                let camera = Camera {
                    roll: Angle::from_degrees(roll),
                    lens: Lens::Fov(Angle::from_degrees(fov)),
                    ..along(eye, dvec3(libm::cos(yaw), -libm::tan(down), libm::sin(yaw)))
                };
                let mut scene = scene(camera, &[board(0.25, square)]);
                [scene.image.width, scene.image.height] = SIZE;
                let oracle = Oracle::new(&scene, USUAL_SIZES);
                // A test of every pixel would take long, so only every 17th is tested.
                for (pixel, sum) in sums(&World::new(&scene)).into_iter().step_by(17) {
                    let Some(sum) = sum else { continue };
                    let board = forms(&oracle, &pixel, eye, [0.25, square]);
                    let error = board.integral(&PIXEL) - NUMBER.exact(sum.value);
                    // Each of the lines that cross the pixel contributes seven roundings to the
                    // error.
                    let lines = board.lines(&PIXEL);
                    let mut found = found.borrow_mut();
                    found.add(
                        error.to_f64().value().abs(),
                        sum.bound,
                        7 * lines,
                        (camera, pixel),
                    );
                }
                Ok(())
            },
        )
        .unwrap();
    found.into_inner().assert("batches");
}
