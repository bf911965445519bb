//! Scenes for the test pictures, each as a program of a student and as text in Pinhole's language.

use glam::{DQuat, DVec3, dvec3};

use super::textbook::{
    Axes, Behind, Encoding, Object, Program, Roots, Sampling, Shape, Squares, Visible,
};

/// Returns the scene `name`, as a correct program and as text. `figure` is figure 9.9 of the
/// textbook, with a roll of 10°. `street` has a closer camera, a far plane and more objects;
/// objects that are also in `figure` have the same names. Each other scene is a variant of `figure`
/// with a property that some mistakes need, for example a near plane that clips objects.
pub fn scene(name: &str) -> (Program, String) {
    let (mut program, mut text) = match name {
        "street" => (street(), STREET.to_owned()),
        _ => (figure(), FIGURE.to_owned()),
    };
    match name {
        "clipped" => {
            program.near = 6.5;
            text = text.replace("d 2.75", "d 2.75  near 6.5");
        }
        "cut" => {
            program.near = 9.0;
            text = text.replace("d 2.75", "d 2.75  near 9");
        }
        "lens" => {
            program.distance = 1.0 / libm::tan(20_f64.to_radians());
            text = text.replace("d 2.75", "fov 40deg");
        }
        "low" => {
            program.view_height = 1.6;
            text = text.replace("d 2.75", "d 2.75  view_height 1.6");
        }
        "painted" => {
            program.faces = Some([[210, 180, 140], [245, 222, 179], [205, 133, 63]]);
            text = text.replace("-0.5) }", "-0.5)  colors (tan, wheat, peru) }");
        }
        "sunk" => {
            shift(&mut program, "Ball", dvec3(0.0, -0.6, 0.0));
            text = text.replace("(-1.6, 1, 0)", "(-1.6, 0.4, 0)");
        }
        "level" => {
            program.roll = 0.0;
            text = text.replace("  roll 10deg", "");
        }
        "leaning" => {
            // The triangle is turned in its plane, whose normal is (0.3, 0, 1).
            let normal = dvec3(0.3, 0.0, 1.0).normalize();
            let spin = DQuat::from_axis_angle(normal, 25_f64.to_radians());
            turn(&mut program, |corner| spin * corner);
            text = text.replace("sides (2, 2, 1)", "sides (2, 2, 1)  spin 25deg");
        }
        "backwards" => {
            program.objects.reverse();
            text = text.lines().rev().map(|line| format!("{line}\n")).collect();
        }
        _ => {}
    }
    (program, text)
}

const FIGURE: &str = "image { width WIDTH  height HEIGHT }
camera { eye (3, 3.5, 8)  lookat (0.2, 0.8, 0)  roll 10deg  d 2.75 }
sphere Ball { center (-1.6, 1, 0) }
triangle Sail { centroid (0.2, 1, 0.6)  normal (0.3, 0, 1)  sides (2, 2, 1) }
box Crate { center (2, 0.75, -0.5) }
checkerboard Floor { colors (gray, white) }
";

const STREET: &str = "image { width WIDTH  height HEIGHT  background midnightblue }
camera { eye (-2.5, 2, 6)  lookat (0.4, 0.7, 0)  up (0.3, 1, 0.1)  roll -20deg  d 2  far 30 }
sphere Ball { center (-0.9, 0.8, 0.5)  radius 0.8 }
triangle Sail { centroid (0.2, 1, 0.6)  normal (0.3, 0, 1)  sides (2, 2, 1) }
box Crate { center (2, 0.75, -0.5) }
checkerboard Floor { square 0.8  colors (gray, #f0e6c8) }
sphere Moon { center (2.2, 2.4, -3)  radius 0.6  color #dcdcdc }
box House { center (-2.25, 1, -3)  size (1.5, 2, 2)  color #8b4513 }
";

fn figure() -> Program {
    // The triangle of figure 9.9, given by the two ends of its base and its apex.
    let (base, height) = (1.0, 15_f64.sqrt() / 2.0);
    let normal = dvec3(0.3, 0.0, 1.0).normalize();
    let right = DVec3::Y.cross(normal);
    let middle = dvec3(0.2, 1.0, 0.6);
    let foot = middle - DVec3::Y * (height / 3.0);
    let corners = [
        foot - right * (base / 2.0),
        foot + right * (base / 2.0),
        foot + DVec3::Y * height,
    ];
    Program {
        size: [320, 180],
        background: [0, 0, 0],
        eye: dvec3(3.0, 3.5, 8.0),
        lookat: dvec3(0.2, 0.8, 0.0),
        up: DVec3::Y,
        roll: 10_f64.to_radians(),
        distance: 2.75,
        view_height: 2.0,
        near: 0.0,
        far: f64::INFINITY,
        objects: vec![
            Object {
                name: "Ball",
                shape: Shape::Sphere(dvec3(-1.6, 1.0, 0.0), 1.0),
                color: [128, 128, 0],
            },
            Object {
                name: "Sail",
                shape: Shape::Triangle(corners),
                color: [0, 128, 128],
            },
            Object {
                name: "Crate",
                shape: Shape::Box(dvec3(1.75, 0.0, -1.5), dvec3(2.25, 1.5, 0.5)),
                color: [255, 165, 0],
            },
            Object {
                name: "Floor",
                shape: Shape::Board(0.0, 1.0, [255, 255, 255]),
                color: [128, 128, 128],
            },
        ],
        sampling: Sampling::Regular,
        samples: 1,
        is_wide: false,
        is_squeezed: false,
        reaches_borders: false,
        aspect: 1.0,
        axes: Axes::Right,
        gain: 1.0,
        clips_distances: false,
        misses_edge: false,
        is_parallelogram: false,
        roots: Roots::Both,
        misses_axis: false,
        reach: f64::INFINITY,
        is_upright: false,
        shade: |_, _| 1.0,
        faces: None,
        pixel: 1.0,
        offset: 0.0,
        behind: Behind::Unseen,
        visible: Visible::Nearest,
        squares: Squares::Floored,
        parity: 0,
        encoding: Encoding::Srgb,
        averages_encoded: false,
        cuts_bytes: false,
        change: |bytes| bytes,
        afterwards: None,
    }
}

fn street() -> Program {
    let mut street = figure();
    street.background = [25, 25, 112];
    street.eye = dvec3(-2.5, 2.0, 6.0);
    street.lookat = dvec3(0.4, 0.7, 0.0);
    street.up = dvec3(0.3, 1.0, 0.1);
    street.roll = -20_f64.to_radians();
    street.distance = 2.0;
    street.far = 30.0;
    street.objects[0].shape = Shape::Sphere(dvec3(-0.9, 0.8, 0.5), 0.8);
    street.objects[3].shape = Shape::Board(0.0, 0.8, [240, 230, 200]);
    street.objects.extend([
        Object {
            name: "Moon",
            shape: Shape::Sphere(dvec3(2.2, 2.4, -3.0), 0.6),
            color: [220, 220, 220],
        },
        Object {
            name: "House",
            shape: Shape::Box(dvec3(-3.0, 0.0, -4.0), dvec3(-1.5, 2.0, -2.0)),
            color: [139, 69, 19],
        },
    ]);
    street
}

/// Turns the triangle about its centroid. `turned` gets the vector from the centroid to a corner,
/// and returns the turned vector.
pub fn turn(program: &mut Program, turned: impl Fn(DVec3) -> DVec3) {
    if let Some(Shape::Triangle(corners)) = program.shape("Sail") {
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        *corners = corners.map(|corner| middle + turned(corner - middle));
    }
}

/// Moves an object of the scene. Does nothing if the scene lacks the object.
pub fn shift(program: &mut Program, name: &str, by: DVec3) {
    match program.shape(name) {
        Some(Shape::Sphere(center, _)) => *center += by,
        Some(Shape::Triangle(corners)) => corners.iter_mut().for_each(|corner| *corner += by),
        Some(Shape::Box(least, greatest)) => (*least, *greatest) = (*least + by, *greatest + by),
        Some(Shape::Board(y, ..)) => *y += by.y,
        None => {}
    }
}
