//! Hard cases of boxes: rays in the planes of faces, eyes inside and on the surface, extremely thin
//! boxes, and boxes that share a face.

use glam::{DVec3, dvec3};

use super::case::{Case, CaseScene, Question::Seen, input};
use super::inputs::{CaseRng, MIDDLE};
use crate::{
    math::Angle,
    reference::scenes::{along, camera, cuboid, sphere},
};

/// Hard cases of boxes, in the order of the report.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "B1", title: "rays in the planes of faces, and along edges", bound: 2.0, subject: Seen(in_planes) },
    Case { id: "B2", title: "the eye inside, on a face, an edge, a corner", bound: 2.0, subject: Seen(inside) },
    Case { id: "B3", title: "boxes an ulp thick", bound: 2.0, subject: Seen(thin) },
    Case { id: "B4", title: "rays that graze edges, 1 … 1e9 m away", bound: 2.0, subject: Seen(silhouettes) },
    Case { id: "B5", title: "the seam of two boxes that share a face", bound: 2.0, subject: Seen(neighbours) },
];

/// Returns a view along −z in which the eye may lie in the plane of a box's face. Rays through the
/// vertical or horizontal middle line of the picture may then lie exactly in this plane.
fn in_planes(random: &mut CaseRng) -> CaseScene {
    let min = random.wholes([-9, -9, -40], [9, 9, -9]) / 4.0;
    let max = min + random.wholes([1; 3], [9; 3]) / 4.0;
    let middle = (min + max) / 2.0;
    let mut place = |axis: usize| random.pick(&[min[axis], max[axis], middle[axis]]);
    let (x, y) = (place(0), place(1));
    let eye = dvec3(x, y, random.pick(&[0.0, 0.0, middle.z, min.z, max.z]));
    let mut camera = along(eye, DVec3::NEG_Z);
    camera.roll = Angle::from_degrees(90.0 * random.whole(-3, 3));
    input(camera, &[cuboid(min, max)]).at(move |random| {
        let middle = [MIDDLE[1], MIDDLE[1], MIDDLE[0]];
        let in_plane = random.pick(&middle);
        let other = match random.below(3) {
            0 => random.pick(&middle),
            _ => (random.pixel(), random.within(-0.5, 0.5)),
        };
        random.pick(&[[in_plane, other], [other, in_plane]])
    })
}

fn inside(random: &mut CaseRng) -> CaseScene {
    let min = random.vector(2.0);
    let max = min + random.between([0.5; 3], [3.0; 3]);
    let mut place = |axis: usize| {
        let between = random.within(min[axis], max[axis]);
        random.pick(&[min[axis], max[axis], between])
    };
    let eye = dvec3(place(0), place(1), place(2));
    let middle = (min + max) / 2.0;
    let wall = middle + random.unit() * 0.8;
    let mut shapes = [
        cuboid(min, max),
        sphere(wall, 0.7),
        cuboid(wall - DVec3::splat(0.4), wall),
    ];
    shapes.rotate_left(random.below(3) as usize);
    input(camera(eye, wall), &shapes)
}

fn thin(random: &mut CaseRng) -> CaseScene {
    let min = random.vector(2.0);
    let mut max = min + random.within(0.5, 2.0);
    let axis = random.below(3) as usize;
    max[axis] = min[axis].next_up();
    let mut eye = random.vector(1.0).normalize() * 5.0;
    // The eye may be far from the plane of the thin box, or so close to it that the box is seen
    // edge-on.
    eye[axis] = min[axis] + random.sign() * random.power(-15.0, 0.5);
    let shapes = [cuboid(min, max), sphere((min + max) / 2.0, 0.3)];
    input(camera(eye, (min + max) / 2.0), &shapes)
}

fn silhouettes(random: &mut CaseRng) -> CaseScene {
    let place = random.unit() * random.power(0.0, 9.0);
    let min = place + random.vector(1.0);
    let max = min + random.between([0.5; 3], [2.0; 3]);
    let eye = place + random.unit() * random.within(4.0, 8.0);
    let shapes = [cuboid(min, max)];
    input(camera(eye, (min + max) / 2.0), &shapes)
}

/// Returns two boxes that share a face. The eye may lie exactly in the plane of this face.
fn neighbours(random: &mut CaseRng) -> CaseScene {
    let seam = random.within(-1.0, 1.0);
    let mut shapes = [
        cuboid(dvec3(seam - 1.3, -1.0, -3.0), dvec3(seam, 1.0, -2.0)),
        cuboid(dvec3(seam, -1.0, -3.0), dvec3(seam + 1.7, 1.0, -2.0)),
    ];
    shapes.rotate_left(random.below(2) as usize);
    let beside = random.pick(&[0.0, 1.0]) * random.within(-1.0, 1.0);
    let x = seam + beside;
    let eye = random.between([x, -0.5, 1.0], [x, 1.5, 3.0]);
    let input = input(along(eye, DVec3::NEG_Z), &shapes);
    if beside != 0.0 {
        return input;
    }
    let in_plane = |random: &mut CaseRng| {
        let row = random.pixel();
        let column = random.pick(&[MIDDLE[1], MIDDLE[0]]);
        [column, (row, random.within(-0.5, 0.5))]
    };
    input.at(in_plane).mixed()
}
