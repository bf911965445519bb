//! The camera: nearly parallel up vectors, directions of all lengths, rolls, lenses, wide pictures, and symmetry.

use glam::{DVec3, dvec3};

use super::{
    Case, Claim,
    inputs::Random,
    oracle::{ALL_SIZES, ALL_VIEWS, Oracle, USUAL_SIZES},
    scenes::{along, board, camera, cuboid, scene, sphere, triangle},
    textbook,
    trial::{Tally, Trial},
};
use crate::{
    math::{Angle, Real},
    scene::{Camera, Lens},
    tracer::Basis,
};

/// The cases.
pub const CASES: &[Case] = &[
    Case::new(
        "C1",
        "up within 1e-1 … 1e-200 of the view direction",
        Claim::Roundings(4.0),
        nearly_parallel,
    ),
    Case::new(
        "C2",
        "eye and lookat: subnormal, close, 1e308 apart",
        Claim::Roundings(4.0),
        differences,
    ),
    Case::new(
        "C3a",
        "directions and up vectors of 1e±308",
        Claim::Roundings(4.0),
        lengths,
    ),
    Case::new(
        "C3b",
        "view planes at d = 1e±9 … 1e±302",
        Claim::Ulps(2.0),
        lenses,
    ),
    Case::new(
        "C4",
        "rolls of up to 1e22 degrees",
        Claim::Roundings(4.0),
        rolls,
    ),
    Case::new("C5", "a picture of 2^20 columns", Claim::Ulps(2.0), wide),
    Case::new(
        "C6",
        "a symmetric scene, mirrored",
        Claim::Decisions,
        mirrored,
    ),
];

/// The axes of a camera: their errors in units of 2^−53.
fn basis(camera: &Camera, bits: usize, tally: &mut Tally) {
    let scene = scene(*camera, &[]);
    let oracle = Oracle::new(&scene, bits);
    let basis = Basis::new(camera, &scene.image);
    let ours = [&basis.u, &basis.v, &basis.w].map(|v| v.each_ref().map(Real::to_f64));
    let theirs = textbook::axes(camera).map(|v| v.to_array());
    let errors = [theirs, ours].map(|axes| {
        let mut greatest = 0.0_f64;
        for (axis, truth) in axes.iter().zip(oracle.axes()) {
            for (x, truth) in axis.iter().zip(truth) {
                if !x.is_finite() {
                    return f64::INFINITY;
                }
                let error = (oracle.exact(*x) - truth).to_f64().value().abs();
                greatest = greatest.max(error / (f64::EPSILON / 2.0));
            }
        }
        greatest
    });
    tally.inputs += 1;
    tally.errors(errors.map(Some));
}

fn nearly_parallel(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
        let lowest = random.pick(&[-16.0, -200.0]);
        let view = random.unit() * random.power(-3.0, 3.0);
        let beside = random.unit() * random.power(lowest, -1.0);
        // Up is as near to the view direction as f64s have it; where they are all equal, the world's axes have room.
        let mut camera = along(DVec3::ZERO, view);
        camera.up = view + beside;
        if camera.up.cross(view) == DVec3::ZERO || random.below(2) == 0 {
            camera = along(DVec3::ZERO, dvec3(beside.x, -1.0, beside.z));
        }
        basis(&camera, ALL_SIZES, tally);
    }
}

fn differences(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
        let whole = |random: &mut Random| {
            dvec3(random.whole(-9, 9), random.whole(-9, 9), random.whole(1, 9))
        };
        let least = f64::from_bits(1);
        let far = random.unit() * random.power(6.0, 12.0);
        let (eye, lookat) = match random.below(3) {
            0 => (DVec3::ZERO, whole(random) * least),
            1 => (far, far + random.unit() * random.power(-3.0, 0.0)),
            _ => (random.vector(1.0) * 1.7e308, random.vector(1.0) * 1.7e308),
        };
        if (lookat - eye).cross(DVec3::Y) != DVec3::ZERO {
            basis(&camera(eye, lookat), ALL_SIZES, tally);
        } else {
            tally.inputs += 1;
        }
    }
}

fn lengths(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
        let length = |random: &mut Random| {
            let exponent = random.sign() * random.within(0.0, 307.0);
            random.power(exponent, exponent)
        };
        let mut camera = along(DVec3::ZERO, random.unit() * length(random));
        camera.up = random.unit() * length(random);
        basis(&camera, USUAL_SIZES, tally);
    }
}

/// A world behind lenses that see nearly everything, and behind those that see next to nothing.
///
/// The widest ones make of whole rows of the picture rays that are parallel to the board up to d. That is a tie from 2^−90 on,
/// which we take for one from 2^−310 on, the oracle from 2^−500 on: lenses between are not asked.
fn lenses(random: &mut Random, count: u64, tally: &mut Tally) {
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
    Trial::new(scene(camera, &shapes), ALL_VIEWS).boundaries(random, count, tally);
}

fn rolls(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
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
        basis(&camera, USUAL_SIZES, tally);
    }
}

fn wide(random: &mut Random, count: u64, tally: &mut Tally) {
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
    let mut scene = scene(camera, &shapes);
    scene.image.width = 1 << 20;
    Trial::new(scene, USUAL_SIZES).boundaries(random, count, tally);
}

/// Everything is symmetric in x, and two boxes are each other's mirror images: what is seen must be as well, to the bit.
fn mirrored(random: &mut Random, count: u64, tally: &mut Tally) {
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
    let trial = Trial::new(scene(camera(eye, at), &shapes), USUAL_SIZES);
    trial.symmetry(random, &[0, 2, 1, 3], count, tally);
}
