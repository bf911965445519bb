//! The preparation of a scene.
//!
//! In: a scene. Out: its geometry, prepared block by block by all threads, and the quadtree over
//! its objects' bounds.

use std::sync::atomic::AtomicBool;

use super::precision::{Frame, Geometry, Numbers};
use crate::{
    cancel,
    scene::{self, Scene},
    threads::{Threads, prelude::*},
    tracer::{
        camera::Basis,
        object::Object,
        pieces::Pieces,
        quadtree::{Grid, Item, Quadtree},
    },
};
use glam::DVec2;

/// With fewer objects no threads are started: at 0.7 µs an object (benches/README.md) they take
/// less than a millisecond.
const OBJECTS_WORTH_THREADS: usize = 1 << 10;

/// So many objects are prepared before anybody is asked whether that is still wanted: 6 ms at most.
const BLOCK: usize = 1 << 13;

/// The geometry of a scene for the points of its picture plane at most `reach` pixels from the
/// picture's centre, and where its objects are; cancelled, something of no use.
pub fn prepare(
    scene: &Scene,
    pieces: &Pieces,
    basis: &Basis,
    reach: DVec2,
    cancel: &AtomicBool,
) -> (Geometry, Quadtree) {
    let count = scene.objects.len();
    let double = Frame::new(basis, scene, reach, count);
    let fast = Frame::new(basis, scene, reach, 0);
    let grid = Grid::new(&fast.camera.window);
    let prepare = |index: usize, object: &scene::Object| {
        let (object, extent) = Object::with_extent(
            &double.camera,
            &fast.camera,
            &object.shape,
            pieces.face(index),
        );
        (object, extent.and_then(|extent| grid.item(index, &extent)))
    };
    let threads = threads_for(count);
    let mut objects = Vec::with_capacity(count);
    let mut items: Vec<Item> = Vec::with_capacity(count);
    let (mut more, mut seen) = (Vec::new(), Vec::new());
    for (first, block) in (0..).step_by(BLOCK).zip(scene.objects.chunks(BLOCK)) {
        if cancel::is_set(cancel) {
            break;
        }
        let prepare = |(index, object)| prepare(first + index, object);
        match &threads {
            Some(threads) => threads.install(|| {
                let prepared = block.par_iter().enumerate().map(prepare);
                prepared.unzip_into_vecs(&mut more, &mut seen);
            }),
            None => (more, seen) = block.iter().enumerate().map(prepare).unzip(),
        }
        objects.append(&mut more);
        items.extend(seen.drain(..).flatten());
    }
    // Before the rest, which finds room where this had lists that are gone.
    let quadtree = Quadtree::new(grid, items, cancel);
    let rest = match cancel::is_set(cancel) {
        false => &scene.objects[..],
        true => &[],
    };
    let geometry = Geometry {
        numbers: (rest.iter().enumerate())
            .map(|(index, object)| Numbers::new(object, pieces.face(index)))
            .collect(),
        objects,
        fast,
        double,
        big: Frame::new(basis, scene, reach, count),
    };
    (geometry, quadtree)
}

/// Threads to prepare so many objects; none if they are few, or if the system starts none.
fn threads_for(objects: usize) -> Option<Threads> {
    (objects >= OBJECTS_WORTH_THREADS)
        .then(|| Threads::new(None).ok())
        .flatten()
}
