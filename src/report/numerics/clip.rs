//! The near and the far plane.

use glam::{DVec3, dvec3};

use super::{
    case::{Case, Input, Subject::Seen, input},
    inputs::Random,
    scenes::{along, board, camera, cuboid, sphere, triangle},
};

/// The cases.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "K2", title: "surfaces exactly at the near or the far plane", bound: 2.0, subject: Seen(exactly_there) },
    Case { id: "K3", title: "objects cut by both planes", bound: 2.0, subject: Seen(cut) },
    Case { id: "K4", title: "the near plane within objects", bound: 2.0, subject: Seen(within) },
];

/// View directions with a length that is a whole number, so that depths can be.
const WHOLE: [(DVec3, f64); 4] = [
    (dvec3(0.0, 0.0, -1.0), 1.0),
    (dvec3(3.0, 0.0, -4.0), 5.0),
    (dvec3(2.0, -1.0, -2.0), 3.0),
    (dvec3(6.0, 3.0, -2.0), 7.0),
];

/// A wall across the view, at a depth that is one of the two planes' or a neighbouring f64.
fn exactly_there(random: &mut Random) -> Input {
    let (direction, length) = random.pick(&WHOLE);
    let steps = random.whole(1, 1 << 20) / 1024.0;
    let depth = length * steps;
    let eye = random.wholes(-9, 9) / 4.0;
    let wall = eye + direction * steps;
    let shape = triangle(wall, direction * random.sign(), DVec3::splat(8.0 * depth));
    let mut camera = along(eye, direction);
    let at = random.pick(&[depth, depth, depth.next_up(), depth.next_down()]);
    match random.below(2) {
        0 => camera.near = at,
        _ => camera.far = Some(at),
    }
    input(camera, &[shape]).anywhere()
}

fn cut(random: &mut Random) -> Input {
    let at = random.vector(1.0);
    let eye = at + random.unit() * random.within(4.0, 8.0);
    let distance = (at - eye).length();
    let mut camera = camera(eye, at);
    camera.near = distance - random.within(0.2, 1.5);
    camera.far = Some(distance + random.within(0.0, 1.0));
    let corner = at + random.vector(1.0);
    let shapes = [
        board(at.y + random.within(-0.5, 0.5), 0.6),
        sphere(at + random.unit(), 1.0),
        cuboid(corner, corner + DVec3::ONE),
        triangle(at + random.vector(0.5), random.unit(), dvec3(2.0, 2.0, 1.0)),
    ];
    input(camera, &shapes)
}

fn within(random: &mut Random) -> Input {
    let at = random.vector(1.0);
    let eye = at + random.unit() * random.within(4.0, 8.0);
    let mut camera = camera(eye, at);
    camera.near = (at - eye).length() + random.within(-0.5, 0.5);
    let (one, other) = (random.unit(), random.unit());
    let shapes = [
        sphere(at + one * 0.5, 1.0),
        cuboid(
            at + other * 0.5 - DVec3::splat(0.7),
            at + other * 0.5 + DVec3::splat(0.7),
        ),
    ];
    input(camera, &shapes).mixed()
}
