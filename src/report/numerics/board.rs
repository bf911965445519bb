//! Hard cases of checkerboards: rays near the horizon or parallel to the board, extreme heights and
//! distances, exact corners of squares, and other surfaces in the board's plane.

use glam::{DVec3, dvec3};

use super::case::{Case, CaseScene, Question::Seen, input};
use super::inputs::{CaseRng, MIDDLE};
use crate::reference::{
    oracle::ALL_SIZES,
    scenes::{SIZE, along, board, camera, cuboid, sphere, spun, triangle},
};

/// Hard cases of checkerboards, in the order of the report.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "P1", title: "up to 1e-13 pixels below the horizon", bound: 2.0, subject: Seen(horizon) },
    Case { id: "P2", title: "rays parallel to the board, and next to it", bound: 2.0, subject: Seen(parallels) },
    Case { id: "P3", title: "planes through the eye", bound: 2.0, subject: Seen(edge_on) },
    Case { id: "P4", title: "the eye 1e-9 … 5e-324 m above the board", bound: 2.0, subject: Seen(low) },
    Case { id: "P5", title: "the eye 1e9 … 1e15 squares above it", bound: 2.0, subject: Seen(high) },
    Case { id: "P6a", title: "1e9 … 4e15 squares from the origin", bound: 2.0, subject: Seen(displaced) },
    Case { id: "P6b", title: "exact corners of squares, and next to them", bound: 2.0, subject: Seen(corners) },
    Case { id: "P7", title: "boxes and triangles on the board, from below", bound: 2.0, subject: Seen(from_below) },
    Case { id: "P8", title: "two boards or two triangles in one plane", bound: 2.0, subject: Seen(coincident) },
];

fn horizon(random: &mut CaseRng) -> CaseScene {
    let eye = random.between([-9.0, 0.5, -9.0], [9.0, 4.0, 9.0]);
    let level = random.between([-1.0, 0.0, -1.0], [1.0, 0.0, -1.0]);
    input(along(eye, level), &[board(0.0, 1.0)]).at(move |random| {
        let (column, below) = (random.pixel(), random.power(-13.0, -0.01));
        let x = random.within(-0.5, 0.5);
        [(column, x), (SIZE / 2, -0.5 + below)]
    })
}

fn parallels(random: &mut CaseRng) -> CaseScene {
    let height = random.power(-3.0, 3.0) * random.sign();
    let eye = random.between([-9.0, height, -9.0], [9.0, height, 9.0]);
    let level = dvec3(
        random.within(-1.0, 1.0),
        random.pick(&[0.0, -0.0]),
        random.sign(),
    );
    let mut camera = along(eye, level);
    camera.up = random.pick(&[DVec3::Y, DVec3::NEG_Y]);
    input(camera, &[board(0.0, 1.0)]).at(move |random| {
        let column = (random.pixel(), random.within(-0.5, 0.5));
        let [before, middle] = MIDDLE;
        let behind = (SIZE / 2, (-0.5_f64).next_up());
        [column, random.pick(&[middle, behind, before])]
    })
}

/// Returns a scene in which a board, a triangle and a box's top face lie exactly in one plane with
/// the eye.
fn edge_on(random: &mut CaseRng) -> CaseScene {
    let eye = random.vector(3.0);
    let ahead = dvec3(random.within(-0.5, 0.5), random.within(-0.3, 0.3), -1.0);
    let at = eye + dvec3(0.0, 0.0, -4.0);
    let (low, high) = (at - DVec3::ONE, at + DVec3::ONE);
    let shapes = [
        triangle(dvec3(at.x, eye.y, at.z), DVec3::Y, DVec3::splat(6.0)),
        board(eye.y, 1.0),
        cuboid(low, dvec3(high.x, eye.y, high.z)),
        sphere(at, 0.5),
    ];
    input(along(eye, ahead), &shapes)
}

fn low(random: &mut CaseRng) -> CaseScene {
    let height = random.power(-323.0, -9.0);
    let eye = random.between([-9.0, height, -9.0], [9.0, height, 9.0]);
    let shapes = [
        board(0.0, random.power(-3.0, 0.0) * height.max(1e-300)),
        sphere(eye - DVec3::Z, 0.3),
    ];
    let ahead = random.between([-1.0, -0.5, -1.0], [1.0, 0.0, -1.0]);
    input(along(eye, ahead), &shapes).bits(ALL_SIZES)
}

fn high(random: &mut CaseRng) -> CaseScene {
    let height = random.power(9.0, 15.0);
    let eye = random.between([-9.0, height, -9.0], [9.0, height, 9.0]);
    let down = random.between([-1.0, -1.0, -1.0], [1.0, -0.2, -1.0]);
    input(along(eye, down), &[board(0.0, random.power(0.0, 3.0))])
}

fn displaced(random: &mut CaseRng) -> CaseScene {
    let distance = |random: &mut CaseRng| random.sign() * random.power(9.0, 15.6);
    let eye = dvec3(distance(random), random.within(0.5, 4.0), distance(random));
    let down = random.between([-1.0, -1.0, -1.0], [1.0, -0.2, -1.0]);
    input(along(eye, down), &[board(0.0, 1.0)])
}

/// Returns a view straight down on a board. The height of the eye is 64 times a square's side, and
/// from pixel to pixel, the slope of the ray changes by 1/64. So the upper left corner of each
/// pixel shows exactly a corner of a square.
fn corners(random: &mut CaseRng) -> CaseScene {
    let (reach, size) = (1 << random.below(53), libm::exp2(random.whole(-60, 60)));
    let eye = random.wholes([-reach, 64, -reach], [reach, 64, reach]) * size;
    let mut camera = along(eye, DVec3::NEG_Y);
    camera.up = random.pick(&[DVec3::X, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Z]);
    input(camera, &[board(0.0, size)]).at(move |random| {
        [0, 0].map(|_: u32| {
            let pixel = random.pixel();
            let beside = random.pick(&[0.0, 0.0, 1.0, 2.0, 3.0, 1e5]) * f64::EPSILON / 4.0;
            match random.below(2) {
                0 => (pixel, -0.5 + beside),
                _ => (pixel, 0.5_f64.next_down() - beside),
            }
        })
    })
}

fn from_below(random: &mut CaseRng) -> CaseScene {
    let y = random.within(-2.0, 2.0);
    let at = |random: &mut CaseRng| random.between([-1.5, y, -1.5], [1.5, y, 1.5]);
    let eye = at(random) - DVec3::Y * random.within(1.0, 5.0);
    let (one, other) = (at(random), at(random));
    let mut shapes = [
        board(y, random.within(0.1, 1.0)),
        cuboid(one - dvec3(1.0, 0.0, 1.0), one + dvec3(0.5, 1.5, 1.0)),
        triangle(
            at(random),
            DVec3::Y * random.power(-3.0, 3.0),
            DVec3::splat(2.0),
        ),
        cuboid(other - dvec3(0.5, 0.2, 0.5), other + dvec3(0.5, 0.0, 0.5)),
    ];
    shapes.rotate_left(random.below(4) as usize);
    input(camera(eye, at(random)), &shapes).mixed()
}

fn coincident(random: &mut CaseRng) -> CaseScene {
    let y = random.within(-2.0, 2.0);
    let (eye, at) = (random.vector(3.0) + DVec3::Y * 6.0, random.vector(1.0));
    let normal = random.wholes([-9, 1, -9], [9, 9, 9]);
    let sides = DVec3::splat(8.0);
    let shapes = match random.below(2) {
        0 => [0, 1].map(|_: u32| board(y, random.within(0.2, 2.0))),
        _ => {
            let (against, spin) = (normal * random.whole(-9, -1), random.within(0.0, 360.0));
            [triangle(at, normal, sides), spun(at, against, sides, spin)]
        }
    };
    input(camera(eye, at), &shapes).mixed()
}
