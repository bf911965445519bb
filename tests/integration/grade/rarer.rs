//! The mistakes of which the corpus has none: each in a scene in which it shows.

use glam::{DVec3, dvec3};
use image::imageops;

use super::{
    corpus::Case,
    mistakes::{Mistake, change, each, figure, row, shift, street},
    textbook::{Behind, Program, Shape, Squares, Visible},
};

/// Makes the right program.
type Right = fn() -> Program;

const MISTAKES: &[(Right, Mistake)] = &[
    (
        square,
        row("transposed", |p| {
            p.afterwards = Some(|picture| imageops::flip_horizontal(&imageops::rotate90(picture)));
        }),
    ),
    (figure, row("squeezed", |p| p.is_squeezed = true)),
    (street, row("half_pixel", |p| p.offset = -0.5)),
    (
        figure,
        row("channels", |p| {
            p.afterwards = Some(|picture| each(picture, |[r, g, b]| [r, b, g]))
        }),
    ),
    (
        figure,
        row("channels", |p| {
            p.afterwards = Some(|picture| each(picture, |[r, g, b]| [g, r, b]))
        }),
    ),
    (
        figure,
        row("channels", |p| {
            p.afterwards = Some(|picture| each(picture, |[r, g, b]| [g, b, r]))
        }),
    ),
    (
        figure,
        row("channels", |p| {
            p.afterwards = Some(|picture| each(picture, |[r, g, b]| [b, r, g]))
        }),
    ),
    (
        figure,
        row("gray", |p| {
            p.afterwards = Some(|picture| each(picture, |color| gray(color, [1.0; 3])))
        }),
    ),
    (
        street,
        row("gray", |p| {
            p.afterwards =
                Some(|picture| each(picture, |color| gray(color, [0.2126, 0.7152, 0.0722])))
        }),
    ),
    (
        backwards,
        row("depth_ignored", |p| p.visible = Visible::First),
    ),
    (
        street,
        row("depth_ignored", |p| p.visible = Visible::Farthest),
    ),
    (figure, row("behind_seen", |p| p.behind = Behind::First)),
    (
        figure,
        row("board_remainder", |p| p.squares = Squares::Remainder),
    ),
    (
        street,
        row("board_remainder", |p| p.squares = Squares::Remainders),
    ),
    (street, row("up_negated|turned_180", |p| p.up = -p.up)),
    (street, row("up_ignored", |p| p.up = DVec3::Y)),
    (figure, row("fov_halved", |p| p.distance *= 2.0)),
    (street, row("fov_doubled", |p| p.distance *= 0.5)),
    (
        figure,
        row("looks_back", |p| p.lookat = 2.0 * p.eye - p.lookat),
    ),
    (clipped, row("near_ignored", |p| p.near = 0.0)),
    (street, row("far_ignored", |p| p.far = f64::INFINITY)),
    (low, row("view_height_ignored", |p| p.view_height = 2.0)),
    (
        figure,
        row("box_corner Crate", |p| moved(p, dvec3(-0.5, -0.5, -0.5))),
    ),
    (
        figure,
        row("box_base Crate", |p| moved(p, dvec3(0.0, 0.5, 0.0))),
    ),
    (
        street,
        row("box_doubled Crate", |p| {
            change(p, "Crate", |shape| {
                if let Shape::Box(least, greatest) = shape {
                    let half = (*greatest - *least) / 2.0;
                    (*least, *greatest) = (*least - half, *greatest + half);
                }
            });
        }),
    ),
];

/// A picture of each, of 16 samples a pixel.
pub fn cases() -> impl Iterator<Item = Case> {
    MISTAKES.iter().map(|(right, mistake)| {
        let right = right();
        let [width, height] = right.size;
        Case {
            right: Program {
                // The corpus judges larger ones.
                size: [
                    width * 96 / width.max(height),
                    height * 96 / width.max(height),
                ],
                samples: 16,
                ..right
            },
            mistakes: vec![mistake],
            title: mistake.name.to_owned(),
        }
    })
}

fn square() -> Program {
    Program {
        size: [96, 96],
        ..figure()
    }
}

/// The near plane cuts the crate off, and something of the others.
fn clipped() -> Program {
    Program {
        near: 6.5,
        ..figure()
    }
}

fn low() -> Program {
    Program {
        view_height: 1.6,
        ..figure()
    }
}

/// The floor is the first object.
fn backwards() -> Program {
    let mut program = figure();
    program.objects.reverse();
    program
}

/// Gray by encoded values.
fn gray(color: [u8; 3], weights: [f64; 3]) -> [u8; 3] {
    let sum: f64 = weights.iter().sum();
    let parts = color
        .iter()
        .zip(weights)
        .map(|(&byte, weight)| weight * f64::from(byte));
    [(parts.sum::<f64>() / sum).round() as u8; 3]
}

/// Moves the crate by so many times its size.
fn moved(program: &mut Program, by: DVec3) {
    let size = program
        .objects
        .iter()
        .find_map(|object| match object.shape {
            Shape::Box(least, greatest) if object.name == "Crate" => Some(greatest - least),
            _ => None,
        });
    shift(program, "Crate", by * size.expect("the crate"));
}
