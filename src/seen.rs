//! What is seen of each object of a scene.
//!
//! In: a scene. Out: for each object its rectangle in the picture and how many pixels show it; of
//! those that are not seen, why. A pixel counts where its middle shows the object.

use std::{cell::OnceCell, collections::BTreeMap};

use glam::DVec2;
use rayon::prelude::*;

use crate::{
    projection::Projection,
    scene::{Place, Scene, Sight, sphere_around},
    threads,
    tracer::{World, ray},
};

/// Maximum number of rays. A larger picture is looked at in every second row and column, or every
/// third, and so on: the answer is then right to as many pixels.
const MOST_RAYS: u64 = 1 << 20;

/// What is seen of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// Left, top, width and height in pixels of the part that is seen, and how many pixels show it.
    Part([u32; 4], u64),
    /// It lies wholly outside of the picture.
    Outside(Place),
    /// Another object, by its index in the file, stands before its middle.
    HiddenBy(usize),
    /// No middle of a pixel shows it.
    Nothing,
}

/// Says what is seen of each object.
pub fn seen(scene: &Scene) -> Vec<Seen> {
    let world = World::new(scene);
    let [width, height] = [scene.image.width, scene.image.height];
    let mut step = 1;
    while u64::from(width.div_ceil(step)) * u64::from(height.div_ceil(step)) > MOST_RAYS {
        step += 1;
    }
    let counted = |mut parts: Parts, y: u32| {
        let row = (0..width.div_ceil(step)).map(|x| x * step);
        let row: Vec<_> = row.map(|x| (x, world.object_at(x, y))).collect();
        for run in row.chunk_by(|one, other| one.1 == other.1) {
            if let (&[(left, Some(object)), ..], &[.., (right, _)]) = (run, run) {
                add(&mut parts, object, ([left, y, right, y], run.len() as u64));
            }
        }
        parts
    };
    let together = |mut one: Parts, other: Parts| {
        for (object, part) in other {
            add(&mut one, object, part);
        }
        one
    };
    let rows = (0..height.div_ceil(step)).into_par_iter();
    let rows = rows.map(|row| row * step);
    let look = || {
        let parts = rows.fold(Parts::new, counted);
        parts.reduce(Parts::new, together)
    };
    // Without a thread nothing is known.
    let parts = threads::install(None, look).unwrap_or_default();
    let asked = OnceCell::new();
    let sight = Sight::new(&scene.camera, &scene.image);
    let seen = |index: usize| match parts.get(&index) {
        Some(&([left, top, right, bottom], count)) => {
            let size = [right - left + step, bottom - top + step];
            let [w, h] = [size[0].min(width - left), size[1].min(height - top)];
            Seen::Part([left, top, w, h], count * u64::from(step) * u64::from(step))
        }
        // Why an object is not seen is told of those that are listed.
        None if index >= LISTED => Seen::Nothing,
        None => {
            let shape = &scene.objects[index].shape;
            match sight.as_ref().and_then(|sight| sight.outside(shape)) {
                Some(place) => Seen::Outside(place),
                None => hidden_by(scene, &asked, index).map_or(Seen::Nothing, Seen::HiddenBy),
            }
        }
    };
    (0..scene.objects.len()).map(seen).collect()
}

/// Number of objects of which `inspect` says each what is seen.
pub const LISTED: usize = 100;

/// The least and the greatest x and y of what is seen of an object, as x, y, x, y, and how many
/// rays found it.
type Part = ([u32; 4], u64);

/// What is seen, by the indices of the objects.
type Parts = BTreeMap<usize, Part>;

fn add(parts: &mut Parts, object: usize, (b, more): Part) {
    let (a, count) = parts.entry(object).or_insert((b, 0));
    *a = [
        a[0].min(b[0]),
        a[1].min(b[1]),
        a[2].max(b[2]),
        a[3].max(b[3]),
    ];
    *count += more;
}

/// The object that is seen where the middle of one would be, if that is another one.
fn hidden_by(scene: &Scene, world: &OnceCell<World>, index: usize) -> Option<usize> {
    let (middle, _) = sphere_around(&scene.objects[index].shape)?;
    let projection = Projection::new(&scene.camera, &scene.image);
    let at = projection.point(middle)?;
    let is_inside = at.cmpge(DVec2::ZERO).all() && at.cmple(projection.size).all();
    if !is_inside {
        return None;
    }
    let world = world.get_or_init(|| World::reaching(scene, projection.size / 2.0));
    let (_, hits) = ray(world, at);
    let seen = hits.into_iter().find(|hit| hit.visible)?;
    (seen.object != index).then_some(seen.object)
}
