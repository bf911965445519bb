//! The preparation of a scene for one picture.
//!
//! In: a scene. Out: its geometry, prepared on all threads in blocks of objects, and the quadtree
//! over its objects' bounds.

use std::sync::atomic::AtomicBool;

use super::precision::{Geometry, Numbers, SceneFrame};
use crate::{
    cancel,
    scene::{self, Scene},
    threads::{Threads, prelude::*},
    tracer::{
        camera::Basis,
        object::Object,
        pieces::Pieces,
        quadtree::{BoundedObject, CellGrid, Quadtree},
    },
};
use glam::DVec2;

/// Minimum number of objects in a scene that are prepared on several threads. Preparing fewer
/// objects takes less than a millisecond, 0.7 µs each (benches/README.md), so that threads would
/// gain nothing.
const OBJECTS_WORTH_THREADS: usize = 1 << 10;

/// Number of objects that are prepared between two checks for cancellation. Preparing them takes at
/// most 6 ms, so that a cancelled preparation ends soon.
const BLOCK: usize = 1 << 13;

/// Prepares the geometry of a scene, and the quadtree over its objects, for rays through points of
/// the picture plane at most `reach` pixels from the picture's centre. If `cancel` is set during
/// the preparation, the result is incomplete and must not be used.
pub fn prepare(
    scene: &Scene,
    pieces: &Pieces,
    basis: &Basis,
    reach: DVec2,
    cancel: &AtomicBool,
) -> (Geometry, Quadtree) {
    let count = scene.objects.len();
    let double = SceneFrame::new(basis, scene, reach, count);
    let fast = SceneFrame::new(basis, scene, reach, 0);
    let grid = CellGrid::new(&fast.camera.window);
    let prepare = |index: usize, object: &scene::Object| {
        let (object, extent) = Object::with_extent(
            &double.camera,
            &fast.camera,
            &object.shape,
            pieces.face(index),
        );
        (object, extent.and_then(|extent| grid.item(index, &extent)))
    };
    // If the system cannot start threads, this thread prepares all objects.
    let threads = (count >= OBJECTS_WORTH_THREADS)
        .then(|| Threads::new(None).ok())
        .flatten();
    let mut objects = Vec::with_capacity(count);
    let mut items: Vec<BoundedObject> = Vec::with_capacity(count);
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
    // The quadtree is built first, because it frees large lists during the build. The rest of the
    // geometry then reuses their memory.
    let quadtree = Quadtree::new(grid, items, cancel);
    let rest = if cancel::is_set(cancel) {
        &[]
    } else {
        &scene.objects[..]
    };
    let geometry = Geometry {
        numbers: (rest.iter().enumerate())
            .map(|(index, object)| Numbers::new(object, pieces.face(index)))
            .collect(),
        objects,
        fast,
        double,
        big: SceneFrame::new(basis, scene, reach, count),
    };
    (geometry, quadtree)
}
