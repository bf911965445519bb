//! Compares the values of forms with those in the highest precision.

use std::cell::RefCell;

use glam::{DVec2, DVec3};
use proptest::{prelude::*, test_runner::TestRunner};

use super::*;
use crate::{
    math::{Angle, Big, Double, Radius as _},
    reference::{
        scenes::{SIZE, along, board, scene},
        tightness::Tightness,
    },
    scene::Lens,
    tracer::{Object, Precision, World},
};

type Sample = (u32, u32, DVec2);

/// Returns the values of a checkerboard's three linear forms at a sample point, with their error
/// bounds. The forms are its inverse depth and the numerators of its two coordinates.
fn values<T: Precision>(world: &World, (x, y, offset): Sample) -> [Ball<T>; 3] {
    let camera = &T::frame(&world.geometry).camera;
    let ray = camera.direction(&camera.sample_point(x, y, offset));
    let object = T::object(&world.geometry, 0);
    let Object::Checkerboard(board) = &*object else {
        unreachable!("the world has a board");
    };
    let [a, b] = &board.numerators;
    [&board.denominator, a, b].map(|form| form.at(&ray))
}

fn compare<T: Precision>(
    world: &World,
    sample: Sample,
    exactly: impl Fn(&T) -> Big,
    found: &RefCell<Tightness>,
) {
    let exact = values::<Big>(world, sample);
    for (value, exact) in values::<T>(world, sample).iter().zip(exact) {
        let error = exactly(&value.mid).minus(&exact.mid).to_f64().abs();
        let roundings = FORM_ROUNDINGS as usize;
        let bound = value.rad.to_f64();
        found
            .borrow_mut()
            .add(error, bound, roundings, (sample, value));
    }
}

#[test]
fn errors_of_forms_are_within_tight_bounds() {
    let [narrow, wide, double] = [0; 3].map(|_| RefCell::new(Tightness::default()));
    let number = || -1.0..1.0_f64;
    let cases = (
        prop::array::uniform3(number()),
        prop::array::uniform3(number()),
        (-3.0..2.2_f64, 0.0..360.0_f64),
        prop::array::uniform2(-2.0..2.0_f64),
        (0..SIZE, 0..SIZE, prop::array::uniform2(-0.5..0.5_f64)),
    );
    // The errors of double-doubles are mostly far below their bounds. Many cases are needed to find
    // errors that come close to the bounds.
    let config = ProptestConfig {
        cases: 1024,
        ..ProptestConfig::default()
    };
    TestRunner::new(config)
        .run(
            &cases,
            |(eye, ahead, (fov, roll), [y, square], (column, row, offset))| {
                let mut camera = along(9.0 * DVec3::from(eye), DVec3::from(ahead));
                camera.roll = Angle::from_degrees(roll);
                camera.lens = Lens::Fov(Angle::from_degrees(libm::exp10(fov)));
                let world = World::new(&scene(camera, &[board(y, libm::exp10(square))]));
                let sample = (column, row, offset.into());
                let by = if fov < 0.0 { &narrow } else { &wide };
                compare::<f64>(&world, sample, |x| Big::from_f64(*x), by);
                let exactly = |x: &Double| Big::from_f64(x.hi).plus(&Big::from_f64(x.lo));
                compare::<Double>(&world, sample, exactly, &double);
                Ok(())
            },
        )
        .unwrap();
    narrow.borrow().assert("f64 in narrow views");
    wide.borrow().assert("f64 in wide views");
    double.borrow().assert("double-double");
}
