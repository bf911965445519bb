//! Hard cases of triangles: tiny and extremely thin ones, shared edges, normals of all lengths, and
//! vertices behind the eye.

use glam::{DVec3, dvec3};

use super::case::{Case, CaseScene, Question::Seen, input};
use super::inputs::CaseRng;
use crate::{
    reference::scenes::{SIZE, along, camera, spun, triangle},
    scene::Lens,
};

/// Hard cases of triangles, in the order of the report.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { id: "T1", title: "triangles of 1e-3 … 1e-9 m", bound: 2.0, subject: Seen(tiny) },
    Case { id: "T2", title: "the eye 1e-3 … 1e-15 m off the plane", bound: 2.0, subject: Seen(slivers) },
    Case { id: "T3a", title: "close to an edge that two triangles share", bound: 2.0, subject: Seen(shared_edges) },
    Case { id: "T3b", title: "exactly on such an edge", bound: 2.0, subject: Seen(lattice_points) },
    Case { id: "T4", title: "needles of 1 to 1e3 … 1e12, and flat ones", bound: 2.0, subject: Seen(needles) },
    Case { id: "T5", title: "normals of 1e±307, nearly or wholly vertical", bound: 2.0, subject: Seen(normals) },
    Case { id: "T6", title: "1e6 … 1e15 m from the origin", bound: 2.0, subject: Seen(displaced) },
    Case { id: "T7", title: "vertices behind the eye", bound: 2.0, subject: Seen(around) },
];

/// Lengths of a triangle's sides, in metres. They are taken from the triangle in
/// `examples/figure_9_9.scn`.
const SIDES: DVec3 = dvec3(2.0, 2.0, 1.0);

fn tiny(random: &mut CaseRng) -> CaseScene {
    let size = random.power(-9.0, -3.0);
    let normal = random.unit();
    let eye = (normal + random.unit() * 0.5) * 3.0;
    let mut camera = camera(eye, DVec3::ZERO);
    camera.lens = Lens::Distance(5.0 / size);
    let shape = spun(DVec3::ZERO, normal, SIDES * size, random.within(0.0, 360.0));
    input(camera, &[shape]).mixed()
}

fn slivers(random: &mut CaseRng) -> CaseScene {
    let height = random.power(-15.0, -3.0);
    let (centroid, normal) = (random.vector(2.0), random.unit());
    let aside = normal.cross(random.unit()).normalize();
    let eye = centroid + aside * 3.0 + normal * height;
    let mut camera = camera(eye, centroid);
    camera.up = normal;
    camera.lens = Lens::Distance(3.0 / height);
    let shape = spun(centroid, normal, SIDES, random.within(0.0, 360.0));
    input(camera, &[shape])
}

/// Lengths of the sides of a triangle whose vertices have integer coordinates in its plane: (−9,
/// −4), (9, −4) and (0, 8), relative to its centroid. Integers are represented exactly, so two such
/// triangles can share an edge without any rounding.
const LATTICE: DVec3 = dvec3(15.0, 15.0, 18.0);

/// Edges that a triangle with the sides [`LATTICE`] can share with a second such triangle, which is
/// rotated by 180°. For each edge, contains the centroid of the second triangle, and some points of
/// the edge. All coordinates are relative to the first triangle's centroid.
#[rustfmt::skip]
const SHARED: [([f64; 2], &[[f64; 2]]); 3] = [
    ([0.0, -8.0], &[[-9.0, -4.0], [-4.0, -4.0], [0.0, -4.0], [7.0, -4.0], [9.0, -4.0]]),
    ([9.0, 4.0], &[[9.0, -4.0], [6.0, 0.0], [3.0, 4.0], [0.0, 8.0]]),
    ([-9.0, 4.0], &[[-9.0, -4.0], [-6.0, 0.0], [-3.0, 4.0], [0.0, 8.0]]),
];

fn shared_edges(random: &mut CaseRng) -> CaseScene {
    let normal = random.pick(&[DVec3::X, DVec3::Y, DVec3::Z]) * random.sign();
    let size = libm::exp2(random.whole(-8, 8));
    let (right, top) = match normal.y {
        0.0 => (DVec3::Y.cross(normal), DVec3::Y),
        _ => (DVec3::X * normal.y, DVec3::NEG_Z),
    };
    let ([x, y], _) = random.pick(&SHARED);
    let centroid = (right * random.whole(-20, 20) + top * random.whole(-20, 20)) * size;
    let other = centroid + (right * x + top * y) * size;
    let mut shapes = [
        spun(centroid, normal, LATTICE * size, 0.0),
        spun(other, normal, LATTICE * size, 180.0),
    ];
    shapes.rotate_left(random.below(2) as usize);
    let middle = (centroid + other) / 2.0;
    let eye = middle + (normal * random.sign() + random.unit() * 0.7) * (30.0 * size);
    input(camera(eye, middle), &shapes)
}

/// Returns two triangles that share an edge and face the camera. In units of `size`, the vertices
/// and some points of the edge have integer coordinates, and the points that are seen at the
/// corners of neighbouring pixels are 1 apart. So the corners of some pixels show exactly a point
/// of the edge.
fn lattice_points(random: &mut CaseRng) -> CaseScene {
    let size = libm::exp2(random.whole(-8, 8));
    let (other, points) = random.pick(&SHARED);
    let place = [random.whole(-8, 8), random.whole(-8, 8)];
    let at = |x: f64, y: f64| dvec3(x, y, -64.0) * size;
    let normal = DVec3::Z * random.power(-3.0, 3.0);
    let mut shapes = [
        spun(at(place[0], place[1]), normal, LATTICE * size, 0.0),
        spun(
            at(place[0] + other[0], place[1] + other[1]),
            normal,
            LATTICE * size,
            180.0,
        ),
    ];
    shapes.rotate_left(random.below(2) as usize);
    let half = f64::from(SIZE) / 2.0;
    input(along(DVec3::ZERO, DVec3::NEG_Z), &shapes).at(move |random| {
        let [x, y] = random.pick(points);
        [half + place[0] + x, half - place[1] - y].map(|pixel| match random.below(3) {
            0 => (
                pixel as u32,
                -0.5 + random.pick(&[1.0, 2.0, 1e4]) * f64::EPSILON / 4.0,
            ),
            _ => (pixel as u32, -0.5),
        })
    })
}

fn needles(random: &mut CaseRng) -> CaseScene {
    let width = random.power(-12.0, -3.0);
    let normal = random.unit();
    let eye = (normal + random.unit() * 0.3) * 3.0;
    let mut camera = camera(eye, DVec3::ZERO);
    let (sides, height) = match random.below(3) {
        0 => (dvec3(1.0, 1.0, 2.0 - width), libm::sqrt(width)),
        _ => (dvec3(1.0, 1.0, width), width),
    };
    camera.lens = Lens::Distance(3.0 / height);
    let shape = spun(DVec3::ZERO, normal, sides, random.within(0.0, 360.0));
    input(camera, &[shape])
}

fn normals(random: &mut CaseRng) -> CaseScene {
    let tilt = random.pick(&[0.0, 1.0, 1.0]) * random.power(-300.0, -1.0);
    let nearly_vertical = dvec3(tilt * random.within(-1.0, 1.0), random.sign(), tilt);
    let exponent = random.pick(&[1.0, -1.0]) * random.within(150.0, 307.0);
    let normal = match random.below(2) {
        0 => nearly_vertical,
        _ => random.unit() * random.power(exponent, exponent),
    };
    let centroid = random.vector(2.0);
    let eye = centroid + random.between([-2.0, 3.0, -2.0], [2.0, 3.0, 2.0]);
    let shape = spun(centroid, normal, SIDES, random.within(0.0, 360.0));
    input(camera(eye, centroid), &[shape])
}

fn displaced(random: &mut CaseRng) -> CaseScene {
    let distance = random.power(6.0, 15.0);
    let centroid = random.unit() * distance;
    let size = (distance * 1e-14).max(1.0);
    let normal = random.unit();
    let eye = centroid + (normal + random.unit() * 0.4) * (4.0 * size);
    let shape = triangle(centroid, normal, SIDES * size);
    input(camera(eye, centroid), &[shape])
}

fn around(random: &mut CaseRng) -> CaseScene {
    let (centroid, normal) = (random.vector(2.0), random.unit());
    let aside = normal.cross(random.unit()).normalize();
    let eye = centroid + aside * random.within(0.0, 9.0) + normal * random.power(-6.0, 0.5);
    let ahead = normal.cross(random.unit()) - normal * random.within(-0.1, 0.3);
    let mut camera = along(eye, ahead);
    camera.up = normal;
    let sides = dvec3(70.0, 60.0, random.within(15.0, 90.0));
    let shape = spun(centroid, normal, sides, random.within(0.0, 360.0));
    input(camera, &[shape])
}
