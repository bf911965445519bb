//! A world is made: its objects prepared, block by block, and put into the hierarchy.

use std::sync::atomic::AtomicBool;

use glam::DVec2;
use rayon::prelude::*;

use super::{
    World,
    colors::Colors,
    kept::Kept,
    level::{Frame, Numbers},
};
use crate::{
    cancel::{self, Cancelled},
    scene::{self, Scene},
    threads::Threads,
    tracer::{
        camera::Basis,
        hierarchy::{Grid, Hierarchy, Item},
        object::Object,
    },
};

/// With fewer objects it takes no longer to prepare them than to start threads for it.
const OBJECTS_WORTH_THREADS: usize = 1 << 10;

/// So many are prepared before anybody is asked whether that is still wanted: a few milliseconds.
const BLOCK: usize = 1 << 13;

impl World {
    /// Prepares a scene for the sample points of its picture.
    pub fn new(scene: &Scene) -> Self {
        Self::reaching(scene, reach(scene))
    }

    /// The same, given up soon after the flag is set.
    ///
    /// # Errors
    ///
    /// The flag is set.
    pub fn new_unless(scene: &Scene, cancel: &AtomicBool) -> Result<Self, Cancelled> {
        let world = Self::as_far(scene, reach(scene), cancel);
        cancel::unless_set(cancel, world)
    }

    /// Prepares a scene for the points of its picture plane at most `reach` pixels from the picture's centre.
    pub fn reaching(scene: &Scene, reach: DVec2) -> Self {
        Self::as_far(scene, reach, &cancel::NEVER)
    }

    /// The same or, cancelled, something of no use.
    fn as_far(scene: &Scene, reach: DVec2, cancel: &AtomicBool) -> Self {
        let basis = Basis::new(&scene.camera, &scene.image);
        let count = scene.objects.len();
        let double = Frame::new(&basis, scene, reach, Kept::new(count));
        let fast = Frame::new(&basis, scene, reach, Kept::None);
        let grid = Grid::new(&fast.camera.window);
        let prepare = |index: usize, object: &scene::Object| {
            let (object, extent) = Object::with_extent(&double.camera, &fast.camera, &object.shape);
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
        let hierarchy = Hierarchy::new(grid, items, threads.as_ref(), cancel);
        let rest = match cancel::is_set(cancel) {
            false => &scene.objects[..],
            true => &[],
        };
        Self {
            big: Frame::new(&basis, scene, reach, Kept::new(count)),
            basis,
            numbers: rest.iter().map(Numbers::new).collect(),
            objects,
            hierarchy,
            fast,
            double,
            colors: Colors::new(rest, scene.image.background),
        }
    }
}

/// From the picture's centre to its edges, in pixels.
fn reach(scene: &Scene) -> DVec2 {
    DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height)) / 2.0
}

/// Threads to prepare so many objects; none if they are few, or if the system starts none.
fn threads_for(objects: usize) -> Option<Threads> {
    (objects >= OBJECTS_WORTH_THREADS)
        .then(|| Threads::new(None).ok())
        .flatten()
}
