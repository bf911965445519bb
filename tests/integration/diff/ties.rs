//! Right pictures of a program that computes with ordinary numbers, with samples on pixels' sides, of scenes whose edges run along these: what it
//! sees there depends on how it rounds, in some rows so and in others not.

use std::fmt::Write;

use glam::{DVec2, DVec3};
use pinhole::{
    film::Film,
    scene::{Scene, Shape},
};

use super::right::Subject;
use crate::exact::read;

/// All of it vanishes in the picture's middle.
const LEVEL: &str = "camera { eye (0.5, 1.6, 7) lookat (0.5, 1.6, 0) d 2.2 }
box { min (-2.05, 0, -1) max (-1.15, 1.5, 1) color orange }
box { min (-0.35, 0, -2.5) max (0.55, 1.5, -0.5) color teal }
box { min (1.75, 0, -1.5) max (2.65, 1.5, 0.5) color olive }
checkerboard {}
";

/// The board's lines run along pixels' sides, and one along the picture's lower edge.
const DOWN: &str = "camera { eye (0, 8, 0) lookat (0, 0, 0) up (0, 0, -1) d 2 }
box { min (2.25, 0, -1) max (2.75, 1.5, 1) color orange }
sphere { center (0, 1, -2) color olive }
checkerboard {}
";

const SIZE: [u32; 2] = [160, 90];

/// A view through a window that is two metres high, at a distance.
struct Program<'a> {
    scene: &'a Scene,
    /// To the right, up and back.
    axes: [DVec3; 3],
    distance: f64,
}

impl<'a> Program<'a> {
    fn new(scene: &'a Scene, lookat: DVec3, distance: f64) -> Self {
        let w = (scene.camera.eye - lookat).normalize();
        let u = scene.camera.up.cross(w).normalize();
        Self {
            scene,
            axes: [u, w.cross(u), w],
            distance,
        }
    }

    /// The light at a place in the picture.
    fn light(&self, place: DVec2) -> [f64; 3] {
        let [width, height] = SIZE.map(f64::from);
        let at = 2.0 / height * DVec2::new(place.x - width / 2.0, height / 2.0 - place.y);
        let [u, v, w] = self.axes;
        let way = at.x * u + at.y * v - self.distance * w;
        let eye = self.scene.camera.eye;
        let (mut nearest, mut seen) = (f64::INFINITY, self.scene.image.background);
        for object in &self.scene.objects {
            let (t, color) = match object.shape {
                Shape::Box(cuboid) => {
                    let (p, q) = ((cuboid.min - eye) / way, (cuboid.max - eye) / way);
                    let (enter, leave) = (p.min(q).max_element(), p.max(q).min_element());
                    let is_hit = enter <= leave && enter > 0.0;
                    (if is_hit { enter } else { f64::NAN }, cuboid.color)
                }
                Shape::Sphere(sphere) => {
                    let from = eye - sphere.center;
                    let (a, b) = (way.length_squared(), way.dot(from));
                    let c = from.length_squared() - sphere.radius * sphere.radius;
                    ((-b - (b * b - a * c).sqrt()) / a, sphere.color)
                }
                Shape::Checkerboard(board) => {
                    let t = (board.y - eye.y) / way.y;
                    let square = ((eye + t * way) / board.square).floor();
                    let is_odd = (square.x + square.z).rem_euclid(2.0) == 1.0;
                    (t, board.colors[usize::from(is_odd)])
                }
                Shape::Triangle(_) => unreachable!("it draws none"),
            };
            if t > 0.0 && t < nearest {
                (nearest, seen) = (t, color);
            }
        }
        seen.to_linear()
    }

    fn picture(&self, samples: &[DVec2]) -> Film {
        let [width, height] = SIZE;
        let picture = Film::from_fn(width, height, |x, y| {
            let corner = DVec2::new(f64::from(x), f64::from(y));
            let lights = samples.iter().map(|sample| self.light(corner + *sample));
            let sum = lights.map(DVec3::from).sum::<DVec3>();
            (sum / samples.len() as f64).to_array()
        });
        picture.unwrap()
    }
}

/// Hammersley's points, the first of them at a corner.
fn hammersley(samples: u32) -> Vec<DVec2> {
    let bits = samples.trailing_zeros();
    let turned = |i: u32| i.reverse_bits() >> (u32::BITS - bits);
    let point = |i| DVec2::new(f64::from(i), f64::from(turned(i))) / f64::from(samples);
    (0..samples).map(point).collect()
}

/// A grid from corner to corner.
fn grid(side: u32) -> Vec<DVec2> {
    let point = |i| DVec2::new(f64::from(i % side), f64::from(i / side)) / f64::from(side - 1);
    (0..side * side).map(point).collect()
}

/// A grid at a corner of its cells, so many cells to the right of the left ones and below the upper ones.
fn corners(side: u32, [right, lower]: [u32; 2]) -> Vec<DVec2> {
    let point = |i| DVec2::new(f64::from(i % side + right), f64::from(i / side + lower));
    (0..side * side)
        .map(|i| point(i) / f64::from(side))
        .collect()
}

#[test]
#[ignore = "exhaustive"]
fn nobody_alone_is_blamed_for_how_samples_on_pixels_sides_are_rounded() {
    let sets = [
        ("hammersley 4", hammersley(4)),
        ("hammersley 16", hammersley(16)),
        ("grid of 25", grid(5)),
        ("grid of 9", grid(3)),
        ("upper left corners of 4", corners(2, [0, 0])),
        ("lower left corners of 4", corners(2, [0, 1])),
        ("upper right corners of 4", corners(2, [1, 0])),
        ("lower right corners of 4", corners(2, [1, 1])),
    ];
    let mut blamed = String::new();
    for (name, text, lookat, distance) in [
        ("level", LEVEL, DVec3::new(0.5, 1.6, 0.0), 2.2),
        ("down", DOWN, DVec3::ZERO, 2.0),
    ] {
        let subject = Subject::new(&read(text), SIZE);
        let program = Program::new(subject.scene(), lookat, distance);
        for (set, samples) in &sets {
            let found = subject.graded(&program.picture(samples)).unwrap();
            let may_be_noise =
                found.may_be_noise || (found.likely.iter()).any(|likely| likely.mistake == "noise");
            if may_be_noise {
                continue;
            }
            let words = match found.likely.first() {
                Some(first) => &first.message,
                None => "no simple mistake explains it",
            };
            writeln!(blamed, "{name}, {set}: {words}").unwrap();
        }
    }
    assert!(blamed.is_empty(), "{blamed}");
}

/// What a sample on a side sees excuses no more than that.
#[test]
#[ignore = "exhaustive"]
fn mistakes_along_pixels_sides_are_named() {
    let right = read(DOWN);
    let subject = Subject::new(&right, SIZE);
    let mut wrong = right.clone();
    for object in &mut wrong.objects {
        if let Shape::Box(cuboid) = &mut object.shape {
            cuboid.min.x -= 0.05;
            cuboid.max.x -= 0.05;
        }
    }
    let exact = |scene: &Scene| Subject::new(scene, SIZE).exact().clone();
    let mistake = |picture: &Film| {
        let found = subject.graded(picture).unwrap();
        found.likely.first().map(|first| first.mistake)
    };
    assert_eq!(mistake(&exact(&wrong)), Some("object_place"));
    // All lines are along pixels' sides, or in the middle or a quarter of a pixel, where samples on edges may be seen on either side.
    let mut wrong = right.clone();
    wrong.camera.eye.y = 7.95;
    assert!(mistake(&exact(&wrong)).is_some_and(|mistake| mistake == "eye"));
}

/// Boxes that all begin and end at pixels' sides.
const FLAT: &str = "image { background skyblue }
camera { eye (0, 0, 4.5) lookat (0, 0, 0) d 2 }
box A { min (-3, -1, -0.1) max (-1.5, 1, 0) color red }
box B { min (-0.5, -1.5, -0.1) max (0.5, 1.5, 0) color gold }
box C { min (1.5, -1, -0.1) max (3, 0.5, 0) color navy }
box D { min (-1.25, -1.75, -0.1) max (-1.15, 1.75, 0) color white }
";

/// Whether samples are said to be all that is wrong with the exact picture of a scene some of whose boxes are changed.
fn is_excused(change: impl Fn(&mut [&mut pinhole::scene::Cuboid])) -> bool {
    let right = read(FLAT);
    let mut wrong = right.clone();
    let boxes = wrong
        .objects
        .iter_mut()
        .map(|object| match &mut object.shape {
            Shape::Box(cuboid) => cuboid,
            _ => unreachable!("there are boxes only"),
        });
    change(&mut boxes.collect::<Vec<_>>());
    let found = Subject::new(&right, SIZE)
        .graded(Subject::new(&wrong, SIZE).exact())
        .unwrap();
    let is_noise = |likely: &pinhole::grade::Verdict| likely.mistake == "noise";
    !found.likely.is_empty() && found.likely.iter().all(is_noise)
}

#[test]
#[ignore = "exhaustive"]
fn what_no_samples_can_see_is_not_excused_by_them() {
    // A twentieth of a metre is a pixel. Three fifths of the samples would be on left sides, and as many on right ones.
    assert!(!is_excused(|boxes| {
        boxes[0].min.x += 0.03;
        boxes[1].max.x += 0.03;
        boxes[2].max.y -= 0.03;
        boxes[3].min.x -= 0.03;
    }));
    // One edge of sixteen is off.
    assert!(!is_excused(|boxes| boxes[1].max.x += 0.03));
    assert!(!is_excused(|boxes| boxes[2].min.y -= 0.02));
}
