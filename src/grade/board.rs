//! Mistakes of the checkerboard.

use super::{Idea, Make};
use crate::{
    numbers::short,
    scene::{Checkerboard, Scene, Shape},
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
