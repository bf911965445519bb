//! Which objects of a scene a picture shows as they should be.

use glam::{DVec2, DVec3};

use super::{
    candidate::Candidate, grid::Grid, judge::Judge, layout::Layout, parameters::Owner,
    strays::Strays, work,
};
use crate::{
    projection::Projection,
    reference::formulas::{corners, vertices},
    scene::{Checkerboard, Scene, Shape},
    tracer::World,
};

/// A move of less than this, in pixels, is none.
const HALF_PIXEL: f64 = 0.5;

/// So far from an object that is wrong, in pixels, what else is wrong is its own.
const BESIDE: usize = 2;

/// An object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectVerdict {
    /// Its place in the file.
    pub index: usize,
    /// Its name.
    pub name: Option<String>,
    /// What it is called.
    pub title: String,
    /// Whether it is right.
    pub is_right: bool,
    /// By how many pixels it is off.
    pub off: f64,
}

/// All of them, where all are right.
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

/// All of them, and whether the background is right, in a picture with these mistakes.
///
/// An object is right if it has its own numbers in the candidate's scene, and if where a right
/// program would show it in that scene the picture shows nothing else.
pub fn judged(judge: &Judge, candidate: &Candidate) -> (Vec<ObjectVerdict>, bool) {
    let scene = judge.scene;
    let is_drawn = &candidate.is_drawn;
    let mut objects = right(scene);
    for (index, one) in objects.iter_mut().enumerate() {
        let shapes = [scene, &candidate.scene].map(|scene| &scene.objects[index].shape);
        one.off = match is_drawn[index] {
            true => off(scene, &candidate.scene, index),
            false => 0.0,
        };
        one.is_right = is_drawn[index] && shapes[0] == shapes[1] && one.off < HALF_PIXEL;
    }
    let right = judge.predicted(&candidate.shown_rightly(), &judge.fine);
    let strays = right.map_or_else(Strays::default, |right| right.strays());
    let grid = &judge.fine.grid;
    let labels = labels(judge, candidate, Layout::default(), grid);
    let is_moved: Vec<bool> = objects.iter().map(|one| !one.is_right).collect();
    let is_of_another = |at: usize| {
        let mut near = grid.around(at, BESIDE).filter_map(|near| labels[near]);
        near.any(|object| is_moved[object])
    };
    // The background counts as one behind all objects.
    let group =
        |at: usize| (!is_of_another(at)).then_some(labels[at].unwrap_or(scene.objects.len()));
    let are_right = strays.are_empty(scene.objects.len() + 1, group);
    for (one, is_right) in objects.iter_mut().zip(&are_right) {
        one.is_right &= is_right;
    }
    let backgrounds = [scene, &candidate.scene].map(|scene| scene.image.background);
    let is_background_right = backgrounds[0] == backgrounds[1] && are_right[scene.objects.len()];
    (objects, is_background_right)
}

/// The object that a program without other mistakes than a layout shows of a candidate's scene in
/// the middle of each cell of a grid; none if it is cancelled.
pub fn labels(
    judge: &Judge,
    candidate: &Candidate,
    layout: Layout,
    grid: &Grid,
) -> Vec<Option<usize>> {
    let is_drawn = &candidate.is_drawn;
    let scene = candidate.shown_rightly().drawn(grid);
    let Ok(world) = World::new_unless(&scene, judge.cancel) else {
        return vec![None; grid.count()];
    };
    let work = work::of_exact(0, is_drawn.len(), grid.count());
    judge.work.spend(work);
    let drawn: Vec<usize> = (0..is_drawn.len()).filter(|&i| is_drawn[i]).collect();
    let label = |cell| {
        let (x, y) = layout.source(cell, grid.size());
        world.object_at(x, y).map(|object| drawn[object])
    };
    grid.cells.iter().map(label).collect()
}

/// How far an object is moved in the picture from one scene to another, in pixels: the farthest of
/// some points of it.
fn off(from: &Scene, to: &Scene, object: usize) -> f64 {
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
        // What is not before the eye any more is far off.
        let off = after.map_or(size.length(), |after| before.distance(after));
        is_near.then(|| off.min(size.length()))
    });
    moved.fold(0.0, f64::max)
}

/// Points that are fixed to a shape; those of a board are told by their squares.
fn points(shape: &Shape, squares: &[DVec3]) -> Vec<DVec3> {
    match shape {
        Shape::Sphere(sphere) => {
            let ways = [DVec3::X, DVec3::Y, DVec3::Z].into_iter();
            let ways = ways.flat_map(|way| [way, -way]);
            ways.map(|way| sphere.center + sphere.radius * way)
                .collect()
        }
        Shape::Triangle(triangle) => vertices(&triangle.outline).to_vec(),
        Shape::Box(cuboid) => corners(cuboid.min, cuboid.max).to_vec(),
        Shape::Checkerboard(board) => {
            let points = squares.iter();
            points
                .map(|at| DVec3::new(at.x * board.square, board.y, at.z * board.square))
                .collect()
        }
    }
}

/// What a board shows in a few places of the picture, in squares.
fn squares(board: &Checkerboard, projection: &Projection) -> Vec<DVec3> {
    let place = |at: i32| DVec2::new(f64::from(at % 5), f64::from(at / 5)) / 4.0;
    let crossing = |at| {
        let plane = DVec3::Y * board.y;
        let point = projection.on_plane(projection.size * place(at), plane, DVec3::Y)?;
        // Beyond some hundred squares nothing of them is seen.
        let is_seen = projection.depth(point) < 100.0 * board.square;
        is_seen.then_some(point / board.square)
    };
    (0..25).filter_map(crossing).collect()
}
