//! Hard cases of the camera: up vectors nearly parallel to the view, directions of all lengths,
//! rolls, lenses, and wide pictures.

use glam::{DVec3, dvec3};

use super::{
    case::{
        Case, CaseScene,
        Question::{Axes, Seen},
        input,
    },
    inputs::CaseRng,
};
use crate::{
    math::Angle,
    reference::{
        oracle::ALL_VIEWS,
        scenes::{along, board, camera, cuboid, sphere, triangle},
    },
    scene::{Camera, Lens},
};

/// Hard cases of the camera, in the order of the report. The first cases test the camera's axes,
/// and the other cases test what is seen.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "C1", title: "up within 1e-1 … 1e-200 of the view direction", bound: 4.0, subject: Axes(nearly_parallel) },
    Case { id: "C2", title: "eye and lookat: subnormal, close, 1e308 apart", bound: 4.0, subject: Axes(differences) },
    Case { id: "C3a", title: "directions and up vectors of 1e±308", bound: 4.0, subject: Axes(lengths) },
    Case { id: "C4", title: "rolls of up to 1e22 degrees", bound: 4.0, subject: Axes(rolls) },
    Case { id: "C3b", title: "view planes at d = 1e±9 … 1e±302", bound: 2.0, subject: Seen(lenses) },
    Case { id: "C5", title: "a picture of 2^20 columns", bound: 2.0, subject: Seen(wide) },
    Case { id: "K2", title: "surfaces exactly at the near or the far plane", bound: 2.0, subject: Seen(exactly_there) },
    Case { id: "K3", title: "objects cut by both planes", bound: 2.0, subject: Seen(cut) },
];

fn nearly_parallel(random: &mut CaseRng) -> Camera {
    let lowest = random.pick(&[-16.0, -200.0]);
    let view = random.unit() * random.power(-3.0, 3.0);
    let beside = random.unit() * random.power(lowest, -1.0);
    // `beside` is a vector that is usually much shorter than the view direction. In one half of the
    // inputs, the up vector is the sum of the view direction and `beside`. In the other half, the
    // up vector is the y axis, and the view direction is −y plus the x and z of `beside`. This half
    // also includes inputs in which `beside` is so short that the sum is exactly parallel to the
    // view direction.
    let mut camera = along(DVec3::ZERO, view);
    camera.up = view + beside;
    if camera.up.cross(view) == DVec3::ZERO || random.below(2) == 0 {
        camera = along(DVec3::ZERO, dvec3(beside.x, -1.0, beside.z));
    }
    camera
}

fn differences(random: &mut CaseRng) -> Camera {
    let least = f64::from_bits(1);
    let far = random.unit() * random.power(6.0, 12.0);
    let (eye, lookat) = match random.below(3) {
        0 => (DVec3::ZERO, random.wholes([-9, -9, 1], [9, 9, 9]) * least),
        1 => (far, far + random.unit() * random.power(-3.0, 0.0)),
        _ => (random.vector(1.0) * 1.7e308, random.vector(1.0) * 1.7e308),
    };
    camera(eye, lookat)
}

fn lengths(random: &mut CaseRng) -> Camera {
    let length = |random: &mut CaseRng| {
        let exponent = random.sign() * random.within(0.0, 307.0);
        random.power(exponent, exponent)
    };
    let mut camera = along(DVec3::ZERO, random.unit() * length(random));
    camera.up = random.unit() * length(random);
    camera
}

/// Returns a scene that is seen through an extremely wide or narrow lens, i.e. with the view plane
/// at a tiny or huge distance d from the eye.
///
/// If d is tiny, some rays have a slope of about d towards the checkerboard. A ray is treated as
/// parallel to the board if its slope is below a threshold: about 2^−90 in the language's rules,
/// 2^−310 in the tracer, and 2^−1071 in the oracle (the reference, with 3000 bits). For d between
/// 2^−310 and 2^−90, rays with the slope d are parallel to the board by the language's rules, but
/// not in the tracer. Therefore, these distances are not tested.
fn lenses(random: &mut CaseRng) -> CaseScene {
    let lowest = random.pick(&[9.0, 155.0]);
    let d = random.power(lowest, lowest * 1.95);
    let wide = random.below(2) == 0;
    let (d, eye) = if wide {
        (1.0 / d, dvec3(0.1, 2.0, 3.0))
    } else {
        (d, dvec3(0.1, 2.0, 3.0) * d.min(1e14))
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

fn rolls(random: &mut CaseRng) -> Camera {
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

fn wide(random: &mut CaseRng) -> CaseScene {
    let eye = random.between([-1.0, 9.0, -1.0], [1.0, 9.0, 1.0]);
    let mut camera = along(eye, dvec3(random.within(-0.2, 0.2), -1.0, -0.1));
    let mut shapes = vec![board(0.0, random.within(0.01, 1.0))];
    for _ in 0..8 {
        let corner = dvec3(random.within(-9.0, 9.0), 0.1, -9.0);
        let size = dvec3(0.7, random.within(0.1, 2.0), 18.0);
        shapes.push(cuboid(corner, corner + size));
    }
    // The picture has 64 rows and 2^20 columns. It shows a window in space that is 2 m high, and
    // therefore 32768 m wide. The window's distance from the eye is half its width, so the
    // horizontal field of view is 90°.
    camera.lens = Lens::Distance(16384.0);
    let mut input = input(camera, &shapes);
    input.scene.image.width = 1 << 20;
    input
}

/// View directions whose components and length are integers, each with its length. A wall that is
/// perpendicular to such a direction can have an exactly representable depth.
const WHOLE: [(DVec3, f64); 4] = [
    (dvec3(0.0, 0.0, -1.0), 1.0),
    (dvec3(3.0, 0.0, -4.0), 5.0),
    (dvec3(2.0, -1.0, -2.0), 3.0),
    (dvec3(6.0, 3.0, -2.0), 7.0),
];

/// Returns a scene with a wall perpendicular to the view direction, and with a near or far plane.
/// The depth of the near or far plane is exactly that of the wall, or a neighbouring `f64`.
fn exactly_there(random: &mut CaseRng) -> CaseScene {
    let (direction, length) = random.pick(&WHOLE);
    let steps = random.whole(1, 1 << 20) / 1024.0;
    let depth = length * steps;
    let eye = random.wholes([-9; 3], [9; 3]) / 4.0;
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

fn cut(random: &mut CaseRng) -> CaseScene {
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
