//! Mistakes of the checkerboard.

use glam::{DVec2, DVec3};

use super::{Idea, Make, camera::direction, level::axes, objects::moved, search::Change};
use crate::{
    numbers::{found, found_near, short},
    scene::{Checkerboard, Scene, Shape, View},
};

/// The checkerboards of a scene, with their indices.
pub fn boards(scene: &Scene) -> impl Iterator<Item = (usize, Checkerboard)> {
    let objects = scene.objects.iter().enumerate();
    objects.filter_map(|(index, object)| match object.shape {
        Shape::Checkerboard(board) => Some((index, board)),
        _ => None,
    })
}

/// A scene with every checkerboard changed.
fn with_boards(scene: &Scene, change: impl Fn(&mut Checkerboard)) -> Box<Scene> {
    let mut scene = Box::new(scene.clone());
    for object in &mut scene.objects {
        if let Shape::Checkerboard(board) = &mut object.shape {
            change(board);
        }
    }
    scene
}

/// All of them.
pub fn ideas(scene: &Scene) -> Vec<Idea> {
    let Some((_, first)) = boards(scene).next() else {
        return Vec::new();
    };
    let swapped = || with_boards(scene, |board| board.colors.reverse());
    let idea = |mistake, message: &str, help: &str, make| Idea {
        mistake,
        message: message.to_owned(),
        help: help.to_owned(),
        make,
    };
    let floor = "take floor(x/square) + floor(z/square), and the first colour where that is even";
    let mut ideas = vec![
        idea(
            "board_swapped",
            "the checkerboard's two colours are exchanged",
            floor,
            Make::Scene(swapped()),
        ),
        idea(
            "board_truncated",
            "the checkerboard is wrong where x and z have different signs: numbers were cut off towards 0 instead of rounded down",
            "a conversion to an integer cuts off towards 0; take floor(x/square) + floor(z/square) first",
            Make::Floor(swapped(), |at| (at.x < 0.0) != (at.y < 0.0)),
        ),
        idea(
            "board_remainder",
            "the checkerboard's second colour is missing where floor(x/square) + floor(z/square) is negative: the remainder of a \
             negative odd number is −1 there, not 1",
            "ask whether the remainder by 2 is 0, or use one that is never negative (rem_euclid)",
            Make::Floor(
                with_boards(scene, |board| board.colors[1] = board.colors[0]),
                |at| at.x.floor() + at.y.floor() < 0.0,
            ),
        ),
        idea(
            "board_remainder",
            "the checkerboard's first colour is missing where floor(x/square) and floor(z/square) are odd and one of them is negative: \
             their remainders are −1 and 1 there, and not equal",
            "take the remainder of the sum and ask whether it is 0, or use one that is never negative (rem_euclid)",
            Make::Floor(
                with_boards(scene, |board| board.colors[0] = board.colors[1]),
                |at| {
                    let is_odd = |x: f64| x.floor().rem_euclid(2.0) == 1.0;
                    is_odd(at.x) && is_odd(at.y) && (at.x < 0.0) != (at.y < 0.0)
                },
            ),
        ),
    ];
    for factor in [2.0, 0.5] {
        ideas.push(idea(
            "board_square",
            &format!(
                "the checkerboard's squares have the side {} instead of {}",
                short(first.square * factor),
                short(first.square)
            ),
            "square is the side of one square, not of a pair of them nor half of one",
            Make::Scene(with_boards(scene, |board| board.square *= factor)),
        ));
    }
    if first.y != 0.0 {
        ideas.push(idea(
            "board_height",
            &format!(
                "the checkerboard lies at y = 0 instead of {}",
                short(first.y)
            ),
            "its plane is y = `y`",
            Make::Scene(with_boards(scene, |board| board.y = 0.0)),
        ));
    }
    ideas
}

/// Those that are other numbers: its height, the side of its squares, and where they begin.
pub fn changes(scene: &Scene) -> Vec<Change> {
    let Some((_, first)) = boards(scene).next() else {
        return Vec::new();
    };
    vec![
        height(scene, first),
        square(scene, first),
        origin(scene, first),
    ]
}

fn height(scene: &Scene, first: Checkerboard) -> Change {
    let above = scene.camera.eye.y - first.y;
    let parts = [0.0625, 0.125, 0.25, 0.5, 0.75].into_iter();
    Change {
        numbers: Vec::new(),
        mistake: "board_height",
        help: "its plane is y = `y`",
        with: Box::new(|scene, at| Some(*with_boards(scene, |board| board.y += at[0]))),
        message: Box::new(move |_, other| {
            let other = boards(other).next().map_or(first.y, |(_, board)| board.y);
            format!(
                "the checkerboard is at a wrong height: as if its y were {} instead of {}",
                found_near(other, first.y),
                short(first.y)
            )
        }),
        starts: parts
            .flat_map(|part| [vec![part * above], vec![-part * above]])
            .collect(),
        widths: vec![half_a_pixel(scene)],
    }
}

fn square(scene: &Scene, first: Checkerboard) -> Change {
    let (_, pitch) = axes(scene);
    Change {
        numbers: Vec::new(),
        mistake: "board_square",
        help: "square is the side of one square, in metres",
        with: Box::new(move |scene, at| {
            let side = first.square * libm::exp2(at[0]);
            let other = with_boards(scene, |board| board.square *= libm::exp2(at[0]));
            (side > 0.0 && side.is_finite()).then_some(*other)
        }),
        message: Box::new(move |_, other| {
            let other = boards(other).next();
            let other = other.map_or(first.square, |(_, board)| board.square);
            format!(
                "the checkerboard's squares have the side {} instead of {}",
                found(other, first.square),
                short(first.square)
            )
        }),
        starts: (-24..=24).map(|k| vec![f64::from(k) / 16.0]).collect(),
        // Of a corner as far away from the origin.
        widths: vec![0.5 * pitch / std::f64::consts::LN_2],
    }
}

/// A coordinate of less than this share of the other is 0. It is a choice: who takes a corner of squares for another one displaces it by as
/// much along both axes, or along one.
const NOTHING: f64 = 0.05;

fn origin(scene: &Scene, first: Checkerboard) -> Change {
    let quarters = (0..4).flat_map(|x| (0..8).map(move |z| [x, z]));
    let side = first.square;
    Change {
        numbers: Vec::new(),
        mistake: "board_origin",
        help: "corners of squares are where x and z are multiples of `square`: take floor(x/square) + floor(z/square), without rounding to \
               the nearest or a half of the board's size",
        with: Box::new(|scene, at| Some(with_origin(scene, DVec2::new(at[0], at[1])))),
        message: Box::new(move |scene, other| {
            // All else was moved the other way.
            let by = other.camera.eye - scene.camera.eye;
            let by = least(-DVec2::new(by.x, by.z) / side) * side;
            // What is found of one coordinate is known as well as of the other.
            let far = by.abs().max_element();
            let [x, z] = by.to_array().map(|x| match x.abs() < NOTHING * far {
                true => "0".to_owned(),
                false => found(x, 0.0),
            });
            format!(
                "the checkerboard's squares are displaced: as if they began at ({x}, {z}) instead of (0, 0)"
            )
        }),
        starts: quarters
            .map(|at| at.map(|k| 0.25 * side * f64::from(k)).to_vec())
            .collect(),
        widths: vec![half_a_pixel(scene); 2],
    }
}

/// What half a pixel is where the camera looks to, in metres.
fn half_a_pixel(scene: &Scene) -> f64 {
    let (_, pitch) = axes(scene);
    0.5 * pitch * direction(scene).length()
}

/// A scene whose squares begin elsewhere: all but the checkerboards is moved the other way.
fn with_origin(scene: &Scene, at: DVec2) -> Scene {
    let by = -DVec3::new(at.x, 0.0, at.y);
    let mut scene = scene.clone();
    scene.camera.eye += by;
    if let View::Lookat(lookat) = &mut scene.camera.view {
        *lookat += by;
    }
    for object in &mut scene.objects {
        // Which leaves checkerboards where they are.
        object.shape = moved(&object.shape, by, 1.0);
    }
    scene
}

/// The least of the displacements, in squares, that look the same: by one square along both axes, or by two along one.
fn least(by: DVec2) -> DVec2 {
    let two = |x: f64| x - 2.0 * (x / 2.0).round();
    let by = DVec2::new(two(by.x), two(by.y));
    let other = by - DVec2::new(by.x.signum(), by.y.signum());
    match other.length_squared() < by.length_squared() {
        true => other,
        false => by,
    }
}
