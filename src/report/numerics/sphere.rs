//! Hard cases of spheres: rays that touch the sphere, tiny and distant spheres, huge ones, and eyes
//! inside and on the surface.

use glam::{DVec3, dvec3};

use super::case::{Case, CaseScene, Question::Seen, input};
use super::inputs::CaseRng;
use crate::{
    reference::scenes::{SIZE, along, camera, cuboid, sphere},
    scene::Lens,
};

/// Hard cases of spheres, in the order of the report.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "S1a", title: "rays that nearly touch a sphere", bound: 1.0, subject: Seen(silhouettes) },
    Case { id: "S1b", title: "rays that touch it exactly: they miss", bound: 1.0, subject: Seen(touches) },
    Case { id: "S2", title: "small and far, 1e6 … 1e15 radii away", bound: 1.0, subject: Seen(far_and_small) },
    Case { id: "S3", title: "the eye inside", bound: 1.0, subject: Seen(inside) },
    Case { id: "S4", title: "the eye on the surface, and 1e-16 … 1e-3 off", bound: 1.0, subject: Seen(at_the_surface) },
    Case { id: "S5", title: "a globe of 1e6 … 1e15 m, the eye 1 m above it", bound: 1.0, subject: Seen(globes) },
    Case { id: "S6", title: "scenes of 1e±160 … 1e±300 m", bound: 1.0, subject: Seen(out_of_range) },
    Case { id: "S7", title: "equal spheres, and radii an ulp apart", bound: 1.0, subject: Seen(concentric) },
    Case { id: "S8", title: "centre and eye 1e9 … 1e300 m from the origin", bound: 1.0, subject: Seen(displaced) },
];

fn silhouettes(random: &mut CaseRng) -> CaseScene {
    let center = random.vector(2.0);
    let eye = center + random.unit() * random.within(3.0, 8.0);
    let camera = camera(eye, center + random.vector(0.2));
    let shape = sphere(center, random.within(0.5, 2.0));
    input(camera, &[shape])
}

/// Returns a view along −z from the origin, and a sphere that touches the plane x = 0. In the
/// picture, this plane is the vertical middle line. Rays in the plane touch the sphere or miss it,
/// and the language treats touching as a miss. Rays beside the plane, on the sphere's side, may hit
/// the sphere.
fn touches(random: &mut CaseRng) -> CaseScene {
    let camera = along(DVec3::ZERO, DVec3::NEG_Z);
    let row = random.pixel();
    let depth = random.whole(16, 400);
    // The vertical slope of a ray changes by 1/64 from row to row. The ray through the upper edge
    // of the row `row` has the slope (32 − `row`)/64. The sphere is placed so that this ray meets
    // the point where the sphere touches the plane.
    let y = depth * (f64::from(SIZE) / 2.0 - f64::from(row)) / 64.0;
    let radius = random.whole(1, 80) / 8.0;
    let side = random.sign();
    let shape = sphere(dvec3(side * radius, y, -depth), radius);
    input(camera, &[shape]).at(move |random| {
        let steps = random.pick(&[0.0, 0.0, 1.0, 2.0, 64.0, 1e6]) * f64::EPSILON / 4.0;
        let column = match random.below(2) {
            0 => (SIZE / 2, -0.5 + steps),
            _ => (SIZE / 2 - 1, 0.5_f64.next_down() - steps),
        };
        [column, (row, -0.5)]
    })
}

fn far_and_small(random: &mut CaseRng) -> CaseScene {
    let eye = random.vector(1.0);
    let radius = random.power(-3.0, 3.0);
    let distance = radius * random.power(6.0, 15.0);
    let center = eye + random.unit() * distance;
    let mut camera = camera(eye, center);
    camera.lens = Lens::Distance(distance);
    camera.view_height = 3.0 * radius;
    input(camera, &[sphere(center, radius)])
}

fn inside(random: &mut CaseRng) -> CaseScene {
    let (center, radius) = (random.vector(2.0), random.within(1.0, 3.0));
    let eye = center + random.unit() * radius * random.within(0.0, 0.999);
    let wall = center + random.unit() * radius;
    let corner = wall - random.unit() * radius / 2.0;
    let shapes = [
        sphere(center, radius),
        sphere(wall, radius / 2.0),
        cuboid(corner, corner + DVec3::splat(radius)),
    ];
    input(camera(eye, wall), &shapes)
}

fn at_the_surface(random: &mut CaseRng) -> CaseScene {
    // These points are exactly 5 m from the origin, so the eye is exactly on the surface of the
    // first sphere if `above` is 0.
    let on = random.pick(&[
        dvec3(3.0, 4.0, 0.0),
        dvec3(0.0, 4.0, -3.0),
        dvec3(0.0, 5.0, 0.0),
    ]);
    let above = random.pick(&[0.0, 1.0, 1.0, -1.0]) * random.power(-16.0, -3.0);
    let eye = on * (1.0 + above);
    let tangent = on.cross(random.unit()).normalize();
    let ahead = eye + tangent * random.within(0.5, 2.0);
    let shapes = [sphere(DVec3::ZERO, 5.0), sphere(ahead, 0.4)];
    let camera = along(eye, tangent - on * random.within(-0.05, 0.1));
    input(camera, &shapes)
}

fn globes(random: &mut CaseRng) -> CaseScene {
    let radius = random.power(6.0, 15.0);
    let eye = dvec3(random.within(-1.0, 1.0), 1.0, 0.2);
    let shapes = [
        sphere(dvec3(0.0, -radius, 0.0), radius),
        sphere(dvec3(3.0, random.within(0.2, 0.7), -4.0), 0.8),
    ];
    input(camera(eye, dvec3(3.0, 0.9, -4.0)), &shapes)
}

fn out_of_range(random: &mut CaseRng) -> CaseScene {
    let exponent = random.within(160.0, 300.0) * random.sign();
    let size = random.power(exponent, exponent);
    let center = random.vector(2.0) * size;
    let eye = center + random.unit() * (4.0 * size);
    let shapes = [
        sphere(center, size),
        sphere(center + random.unit() * size, size / 2.0),
    ];
    input(camera(eye, center), &shapes)
}

fn concentric(random: &mut CaseRng) -> CaseScene {
    let center = random.vector(2.0);
    let radius = random.within(0.5, 2.0);
    let radii = random.pick(&[
        [radius, radius],
        [radius, radius.next_up()],
        [radius.next_up(), radius],
    ]);
    let eye = center + random.unit() * random.within(0.0, 8.0);
    let shapes = radii.map(|radius| sphere(center, radius));
    input(camera(eye, center + random.vector(0.3)), &shapes).anywhere()
}

fn displaced(random: &mut CaseRng) -> CaseScene {
    let distance = random.power(9.0, 300.0);
    let center = random.unit() * distance;
    let radius = distance * random.power(-12.0, -2.0);
    let eye = center + random.unit() * (4.0 * radius);
    input(along(eye, center - eye), &[sphere(center, radius)])
}
