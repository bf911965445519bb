//! Judges which objects of a scene a picture shows correctly.

use glam::{DVec2, DVec3};

use super::{
    hypotheses::{Candidate, Layout, Owner},
    scoring::UnexplainedErrors,
    search::Judge,
};
use crate::{
    projection::Projection,
    reference::formulas::{corners, vertices},
    scene::{Checkerboard, Scene, Shape},
};

/// Displacement in the picture, in pixels, below which an object is treated as not moved. With a
/// smaller value, objects would be reported as wrong although their errors are hardly visible.
const HALF_PIXEL: f64 = 0.5;

/// Distance from a wrong object, in pixels, within which errors are attributed to it instead of its
/// neighbours. With a smaller value, a neighbour would be reported as wrong because of the edge
/// that it shares with the wrong object. With a larger one, the neighbour's own errors would be
/// missed.
const BESIDE: usize = 2;

/// The verdict on an object.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ObjectVerdict {
    /// Index of the object in the file.
    pub index: usize,
    /// Name of the object in the scene, if it has one.
    pub name: Option<String>,
    /// Description of the object, for messages.
    pub title: String,
    /// Whether the picture shows the object correctly.
    pub is_right: bool,
    /// Displacement of the object in the picture, in pixels.
    pub off: f64,
}

/// Returns the verdicts on a scene's objects for a picture that shows the whole scene correctly.
pub fn right(scene: &Scene) -> Vec<ObjectVerdict> {
    let right = |index: usize| ObjectVerdict {
        index,
        name: scene.objects[index].name.clone(),
        title: Owner::Object(index).name(scene),
        is_right: true,
        off: 0.0,
    };
    (0..scene.objects.len()).map(right).collect()
}

/// Judges all objects and the background, given a hypothesis about the program, i.e. its mistakes.
/// The second result says whether the background is correct.
///
/// An object is correct if it fulfils two conditions. In the hypothesis, the object is drawn, is
/// not changed and does not move. And where the object is seen, the picture agrees with a correct
/// rendering of the hypothesis's scene.
pub fn judged(judge: &Judge, candidate: &Candidate) -> (Vec<ObjectVerdict>, bool) {
    let scene = judge.scene;
    let is_drawn = &candidate.is_drawn;
    let mut objects = right(scene);
    for (index, one) in objects.iter_mut().enumerate() {
        let shapes = [scene, &candidate.scene].map(|scene| &scene.objects[index].shape);
        if is_drawn[index] {
            one.off = off(scene, &candidate.scene, index);
        }
        one.is_right = is_drawn[index] && shapes[0] == shapes[1] && one.off < HALF_PIXEL;
    }
    let right = judge.predicted(&candidate.drawn_correctly(), &judge.fine);
    let unexplained_errors = right.map_or_else(UnexplainedErrors::default, |right| {
        right.unexplained_errors()
    });
    let grid = &judge.fine.grid;
    let labels = judge.labels(candidate, Layout::default(), grid);
    let is_moved: Vec<bool> = objects.iter().map(|one| !one.is_right).collect();
    let is_of_another = |at: usize| {
        let mut near = grid.around(at, BESIDE).filter_map(|near| labels[near]);
        near.any(|object| is_moved[object])
    };
    // The background is treated as one more object, whose index follows those of all others.
    let group =
        |at: usize| (!is_of_another(at)).then_some(labels[at].unwrap_or(scene.objects.len()));
    let are_right = unexplained_errors.are_empty(scene.objects.len() + 1, group);
    for (one, is_right) in objects.iter_mut().zip(&are_right) {
        one.is_right &= is_right;
    }
    let backgrounds = [scene, &candidate.scene].map(|scene| scene.image.background);
    let is_background_right = backgrounds[0] == backgrounds[1] && are_right[scene.objects.len()];
    (objects, is_background_right)
}

/// Returns how far an object moves in the picture, in pixels, if the scene `from` is replaced by
/// the scene `to`. The result is the greatest movement of some of the object's points.
pub fn off(from: &Scene, to: &Scene, object: usize) -> f64 {
    let projections = [from, to].map(|scene| Projection::quick(&scene.camera, &scene.image));
    let size = projections[0].size;
    let own = &from.objects[object].shape;
    let squares = match own {
        Shape::Checkerboard(board) => squares(board, &projections[0]),
        _ => Vec::new(),
    };
    let [before, after] = [own, &to.objects[object].shape].map(|shape| points(shape, &squares));
    let moved = before.into_iter().zip(after).filter_map(|(before, after)| {
        let (before, after) = (projections[0].point(before)?, projections[1].point(after));
        let is_near = before.cmpge(-size).all() && before.cmple(2.0 * size).all();
        // A point that is no longer ahead of the eye in the scene `to` is treated as if it moved by
        // the picture's diagonal.
        let off = after.map_or(size.length(), |after| before.distance(after));
        is_near.then(|| off.min(size.length()))
    });
    moved.fold(0.0, f64::max)
}

/// Returns the points of a shape whose movement is measured: the ends of a sphere's axes, or the
/// corners of a triangle or box. For a checkerboard, they are the points `squares`, converted from
/// units of a square's side to metres.
fn points(shape: &Shape, squares: &[DVec3]) -> Vec<DVec3> {
    match shape {
        Shape::Sphere(sphere) => {
            let ways = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
            ways.map(|way| sphere.center + sphere.radius * way)
                .collect()
        }
        Shape::Triangle(triangle) => vertices(&triangle.outline).to_vec(),
        Shape::Box(cuboid) => corners(cuboid.min, cuboid.max).to_vec(),
        Shape::Checkerboard(board) => squares
            .iter()
            .map(|at| DVec3::new(at.x * board.square, board.y, at.z * board.square))
            .collect(),
    }
}

/// Returns points of a checkerboard that are spread evenly over the picture. Their coordinates are
/// in units of a square's side.
fn squares(board: &Checkerboard, projection: &Projection) -> Vec<DVec3> {
    let place = |at: i32| DVec2::new(f64::from(at % 5), f64::from(at / 5)) / 4.0;
    let crossing = |at| {
        let plane = DVec3::Y * board.y;
        let point = projection.on_plane(projection.size * place(at), plane, DVec3::Y)?;
        // At a depth of more than 100 squares, single squares are too small to be seen, so points
        // at such depths are left out.
        let is_seen = projection.depth(point) < 100.0 * board.square;
        is_seen.then_some(point / board.square)
    };
    (0..25).filter_map(crossing).collect()
}
