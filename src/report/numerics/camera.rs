//! The camera: nearly parallel up vectors, directions of all lengths, rolls, lenses, wide pictures, and symmetry.

use glam::{DVec3, dvec3};

use super::{
    case::{
        Case, Input,
        Subject::{Axes, Seen},
        input,
    },
    inputs::Random,
    oracle::ALL_VIEWS,
    scenes::{along, board, camera, cuboid, sphere, triangle},
};
use crate::{
    math::Angle,
    scene::{Camera, Lens},
};

/// The cases: those of the axes, and those of what is seen.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "C1", title: "up within 1e-1 … 1e-200 of the view direction", bound: 4.0, subject: Axes(nearly_parallel) },
    Case { id: "C2", title: "eye and lookat: subnormal, close, 1e308 apart", bound: 4.0, subject: Axes(differences) },
    Case { id: "C3a", title: "directions and up vectors of 1e±308", bound: 4.0, subject: Axes(lengths) },
    Case { id: "C4", title: "rolls of up to 1e22 degrees", bound: 4.0, subject: Axes(rolls) },
    Case { id: "C3b", title: "view planes at d = 1e±9 … 1e±302", bound: 2.0, subject: Seen(lenses) },
    Case { id: "C5", title: "a picture of 2^20 columns", bound: 2.0, subject: Seen(wide) },
    Case { id: "C6", title: "symmetric scenes", bound: 2.0, subject: Seen(symmetric) },
];

fn nearly_parallel(random: &mut Random) -> Camera {
    let lowest = random.pick(&[-16.0, -200.0]);
    let view = random.unit() * random.power(-3.0, 3.0);
    let beside = random.unit() * random.power(lowest, -1.0);
    // Up is as near to the view direction as f64s have it; where they are all equal, the world's axes have room.
    let mut camera = along(DVec3::ZERO, view);
    camera.up = view + beside;
    if camera.up.cross(view) == DVec3::ZERO || random.below(2) == 0 {
        camera = along(DVec3::ZERO, dvec3(beside.x, -1.0, beside.z));
    }
    camera
}

fn differences(random: &mut Random) -> Camera {
    let whole =
        |random: &mut Random| dvec3(random.whole(-9, 9), random.whole(-9, 9), random.whole(1, 9));
    let least = f64::from_bits(1);
    let far = random.unit() * random.power(6.0, 12.0);
    let (eye, lookat) = match random.below(3) {
        0 => (DVec3::ZERO, whole(random) * least),
        1 => (far, far + random.unit() * random.power(-3.0, 0.0)),
        _ => (random.vector(1.0) * 1.7e308, random.vector(1.0) * 1.7e308),
    };
    camera(eye, lookat)
}

fn lengths(random: &mut Random) -> Camera {
    let length = |random: &mut Random| {
        let exponent = random.sign() * random.within(0.0, 307.0);
        random.power(exponent, exponent)
    };
    let mut camera = along(DVec3::ZERO, random.unit() * length(random));
    camera.up = random.unit() * length(random);
    camera
}

/// A world behind lenses that see nearly everything, and behind those that see next to nothing.
///
/// The widest ones make of whole rows of the picture rays that are parallel to the board up to d. That is a tie from 2^−90 on,
/// which we take for one from 2^−310 on, the oracle from 2^−500 on: lenses between are not asked.
fn lenses(random: &mut Random) -> Input {
    let lowest = random.pick(&[9.0, 155.0]);
    let d = random.power(lowest, lowest * 1.95);
    let wide = random.below(2) == 0;
    let (d, eye) = match wide {
        true => (1.0 / d, dvec3(0.1, 2.0, 3.0)),
        false => (d, dvec3(0.1, 2.0, 3.0) * d.min(1e14)),
    };
    let mut camera = camera(eye, DVec3::ZERO);
    camera.lens = Lens::Distance(d);
    if d > 1e14 {
        camera.view_height = d / 1e14;
    }
    let mut shapes = vec![sphere(DVec3::ZERO, 1.0), board(-0.3, 0.5)];
    if wide {
        shapes.push(cuboid(dvec3(-4.0, 0.5, 1.0), dvec3(-3.0, 4.5, 2.0)));
    }
    input(camera, &shapes).bits(ALL_VIEWS)
}

fn rolls(random: &mut Random) -> Camera {
    let mut camera = along(DVec3::ZERO, random.unit());
    let turns = random.whole(-1_000_000, 1_000_000) * libm::exp2(random.whole(0, 40));
    let degrees = match random.below(2) {
        0 => turns * 90.0,
        _ => random.sign() * random.power(0.0, 22.0),
    };
    camera.roll = Angle {
        degrees,
        radians: random.pick(&[0.0, 1.0]) * random.within(-10.0, 10.0),
    };
    camera
}

fn wide(random: &mut Random) -> Input {
    let eye = dvec3(random.within(-1.0, 1.0), 9.0, random.within(-1.0, 1.0));
    let mut camera = along(eye, dvec3(random.within(-0.2, 0.2), -1.0, -0.1));
    let mut shapes = vec![board(0.0, random.within(0.01, 1.0))];
    for _ in 0..8 {
        let corner = dvec3(random.within(-9.0, 9.0), 0.1, -9.0);
        shapes.push(cuboid(
            corner,
            corner + dvec3(0.7, random.within(0.1, 2.0), 18.0),
        ));
    }
    // The window is 2 m high and as wide as 2^20 of its 64 rows.
    camera.lens = Lens::Distance(16384.0);
    let mut input = input(camera, &shapes);
    input.scene.image.width = 1 << 20;
    input
}

/// Everything is symmetric in x, so that what is seen is, too: on the axis of symmetry there are ties.
fn symmetric(random: &mut Random) -> Input {
    let eye = dvec3(0.0, random.within(1.0, 4.0), random.within(4.0, 8.0));
    let at = dvec3(0.0, random.within(0.0, 1.0), random.within(-1.0, 1.0));
    let (min, max) = (
        dvec3(0.7, -1.0, -1.0),
        dvec3(1.9, random.within(0.0, 2.0), 0.7),
    );
    let shapes = [
        sphere(
            dvec3(0.0, random.within(-0.5, 1.5), random.within(-1.0, 0.5)),
            1.0,
        ),
        cuboid(min, max),
        cuboid(dvec3(-max.x, min.y, min.z), dvec3(-min.x, max.y, max.z)),
        triangle(
            dvec3(0.0, 0.5, 1.0),
            dvec3(0.0, random.within(0.0, 1.0), 1.0),
            dvec3(2.0, 2.0, 1.5),
        ),
    ];
    input(camera(eye, at), &shapes)
}
