//! Finds which object each cell of a picture shows.

use super::judge::Judge;
use crate::{
    grading::{
        hypotheses::{Candidate, Layout},
        scoring::{Grid, work},
    },
    tracer::World,
};

/// Returns the index of the object that is seen in the middle of each cell of a grid. A correct
/// program renders the hypothesis's scene, and its pixels are arranged by `layout`. `None` stands
/// for the background. If it is cancelled, all are `None`.
pub fn labels(
    judge: &Judge,
    candidate: &Candidate,
    layout: Layout,
    grid: &Grid,
) -> Vec<Option<usize>> {
    let is_drawn = &candidate.is_drawn;
    let scene = candidate.drawn_correctly().drawn(grid);
    let Ok(world) = World::new_unless(&scene, judge.work.cancel) else {
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
