//! The mistakes that a class makes, as changes of a right program, and the two scenes that they are made in.

use glam::{DVec3, dvec3};
use image::{Rgb, RgbImage, imageops};

use super::textbook::{Behind, Encoding, Object, Program, Sampling, Shape, Squares, Visible};

/// A mistake.
pub struct Mistake {
    /// What `diff` is to say, one of these between bars: a mistake's id, with the object's name behind it, or what it is to `--set`.
    pub name: &'static str,
    /// Makes it.
    pub make: fn(&mut Program),
}

pub const fn row(name: &'static str, make: fn(&mut Program)) -> Mistake {
    Mistake { name, make }
}

/// Of the whole picture.
pub const OF_THE_PICTURE: &[Mistake] = &[
    row("mirrored", |p| {
        p.afterwards = Some(imageops::flip_horizontal)
    }),
    row("upside_down", |p| {
        p.afterwards = Some(imageops::flip_vertical)
    }),
    row("turned_180|up_negated", |p| {
        p.afterwards = Some(imageops::rotate180)
    }),
    row("channels", |p| {
        p.afterwards = Some(|picture| each(picture, |[r, g, b]| [b, g, r]));
    }),
    row("gray", |p| {
        p.afterwards = Some(|picture| {
            each(picture, |[r, g, b]| {
                let [r, g, b] = [r, g, b].map(f64::from);
                [(0.299 * r + 0.587 * g + 0.114 * b).round() as u8; 3]
            })
        });
    }),
    row("not_encoded", |p| p.encoding = Encoding::None),
    row("encoded_twice", |p| p.encoding = Encoding::Twice),
    row("gamma_22", |p| {
        p.afterwards = Some(|picture| each(picture, |color| color.map(|byte| power(byte, 2.2))));
    }),
    row("gamma_2", |p| {
        p.afterwards = Some(|picture| each(picture, |color| color.map(|byte| power(byte, 2.0))));
    }),
    row("gamma_22_averaged", |p| p.encoding = Encoding::Power(2.2)),
    row("averaged_encoded", |p| p.averages_encoded = true),
    row("cut_off", |p| p.cuts_bytes = true),
    row("half_pixel", |p| p.offset = 0.5),
];

/// Of the camera.
pub const OF_THE_CAMERA: &[Mistake] = &[
    row("roll_sign|camera.roll", |p| p.roll = -p.roll),
    row("roll_unit|camera.roll", |p| {
        p.roll = p.roll.to_degrees().round()
    }),
    row("roll_ignored|camera.roll", |p| p.roll = 0.0),
    row("fov_of_width|camera.d|camera.fov", |p| p.is_wide = true),
    row("up_ignored|camera.up", |p| p.up = DVec3::Z),
    row("behind_seen", |p| p.behind = Behind::ByDistance),
    row("camera.d|camera.fov", |p| p.distance *= 0.8),
    row("camera.eye", |p| p.eye += dvec3(0.4, -0.3, 0.5)),
    row("camera.lookat", |p| p.lookat += dvec3(0.3, 0.2, -0.1)),
];

/// Of the board.
pub const OF_THE_BOARD: &[Mistake] = &[
    row("board_swapped", |p| p.parity = 1),
    row("board_truncated", |p| p.squares = Squares::Truncated),
    row("Floor.square", |p| board(p, |_, square, _| *square *= 2.0)),
    row("Floor.y", |p| board(p, |y, _, _| *y -= 0.3)),
    row("Floor.colors", |p| {
        board(p, |_, _, color| *color = [192, 192, 160])
    }),
];

/// Of the other objects.
pub const OF_THE_OBJECTS: &[Mistake] = &[
    row("object_missing Ball", |p| {
        p.objects.retain(|object| object.name != "Ball")
    }),
    row("object_missing Sail", |p| {
        p.objects.retain(|object| object.name != "Sail")
    }),
    row("object_missing Crate", |p| {
        p.objects.retain(|object| object.name != "Crate")
    }),
    row("object_extra", |p| {
        let shape = Shape::Sphere(dvec3(0.6, 0.5, 2.0), 0.5);
        let color = [200, 30, 60];
        p.objects.push(Object {
            name: "",
            shape,
            color,
        });
    }),
    row("depth_ignored", |p| p.visible = Visible::Last),
    row("box_corner|Crate.center", |p| {
        change(p, "Crate", |shape| {
            if let Shape::Box(least, greatest) = shape {
                let half = (*greatest - *least) / 2.0;
                *least += half;
                *greatest += half;
            }
        });
    }),
    row("Ball.color", |p| color(p, "Ball", [128, 0, 0])),
    row("Sail.color", |p| color(p, "Sail", [0, 64, 255])),
    row("Crate.color", |p| color(p, "Crate", [255, 200, 40])),
    row("Ball.center", |p| shift(p, "Ball", dvec3(0.2, 0.3, -0.3))),
    row("Crate.center", |p| shift(p, "Crate", dvec3(-0.3, 0.1, 0.2))),
    row("Sail.centroid", |p| shift(p, "Sail", dvec3(-0.2, 0.3, 0.1))),
    row("Ball.radius", |p| {
        change(p, "Ball", |shape| {
            if let Shape::Sphere(_, radius) = shape {
                *radius *= 1.2;
            }
        });
    }),
    row("Crate.size", |p| {
        change(p, "Crate", |shape| {
            if let Shape::Box(_, greatest) = shape {
                greatest.y += 0.4;
            }
        });
    }),
    row("Sail.spin", |p| {
        change(p, "Sail", |shape| {
            if let Shape::Triangle(corners) = shape {
                let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
                *corners = corners.map(|corner| 2.0 * middle - corner);
            }
        });
    }),
    row("Sail.normal", |p| {
        change(p, "Sail", |shape| {
            if let Shape::Triangle(corners) = shape {
                let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
                *corners = corners.map(|corner| {
                    let DVec3 { x, y, z } = corner - middle;
                    middle + dvec3(0.8 * x + 0.6 * z, y, 0.8 * z - 0.6 * x)
                });
            }
        });
    }),
];

/// The picture of the assignment, turned a little.
pub fn figure() -> Program {
    // The sail of the assignment, whose corners are given: the base's ends and the apex.
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
        seed: 1,
        is_wide: false,
        is_squeezed: false,
        offset: 0.0,
        behind: Behind::Unseen,
        visible: Visible::Nearest,
        squares: Squares::Floored,
        parity: 0,
        encoding: Encoding::Srgb,
        averages_encoded: false,
        cuts_bytes: false,
        afterwards: None,
    }
}

/// Another scene with the same names: seen from closer by, with a far plane, and more objects.
pub fn street() -> Program {
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

pub fn each(picture: &RgbImage, change: impl Fn([u8; 3]) -> [u8; 3]) -> RgbImage {
    let mut changed = picture.clone();
    changed
        .pixels_mut()
        .for_each(|Rgb(color)| *color = change(*color));
    changed
}

/// A byte of sRGB as a plain power would have encoded its light.
fn power(byte: u8, power: f64) -> u8 {
    let part = f64::from(byte) / 255.0;
    let light = match part <= 0.04045 {
        true => part / 12.92,
        false => libm::pow((part + 0.055) / 1.055, 2.4),
    };
    (255.0 * libm::pow(light, 1.0 / power)).round() as u8
}

fn board(program: &mut Program, change: impl Fn(&mut f64, &mut f64, &mut [u8; 3])) {
    for object in &mut program.objects {
        if let Shape::Board(y, square, second) = &mut object.shape {
            change(y, square, second);
        }
    }
}

pub fn change(program: &mut Program, name: &str, change: impl Fn(&mut Shape)) {
    for object in program
        .objects
        .iter_mut()
        .filter(|object| object.name == name)
    {
        change(&mut object.shape);
    }
}

pub fn shift(program: &mut Program, name: &str, by: DVec3) {
    change(program, name, |shape| match shape {
        Shape::Sphere(center, _) => *center += by,
        Shape::Triangle(corners) => corners.iter_mut().for_each(|corner| *corner += by),
        Shape::Box(least, greatest) => {
            *least += by;
            *greatest += by;
        }
        Shape::Board(y, ..) => *y += by.y,
    });
}

fn color(program: &mut Program, name: &str, color: [u8; 3]) {
    for object in program
        .objects
        .iter_mut()
        .filter(|object| object.name == name)
    {
        object.color = color;
    }
}
