//! What is seen of each object of a scene.
//!
//! In: a scene. Out: for each object its rectangle in the picture and how many pixels show it; of
//! those that are not seen, why. A pixel counts where its middle shows the object.

use std::cell::OnceCell;

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
    let counted = |mut parts: Vec<Part>, y: u32| {
        for x in (0..width.div_ceil(step)).map(|x| x * step) {
            let Some(object) = world.object_at(x, y) else {
                continue;
            };
            let found = ([x, y, x, y], 1);
            parts[object] = joined(parts[object], Some(found));
        }
        parts
    };
    let nothing = || vec![None; scene.objects.len()];
    let together = |one: Vec<_>, other: Vec<_>| {
        let pairs = one.into_iter().zip(other);
        pairs.map(|(one, other)| joined(one, other)).collect()
    };
    let rows = height.div_ceil(step);
    // Of very many objects each thread would hold a list.
    let chunk = rows.div_ceil(8).max(1);
    let look = || {
        let chunks = (0..rows.div_ceil(chunk)).into_par_iter();
        let parts = chunks.map(|first| {
            let rows = first * chunk..rows.min((first + 1) * chunk);
            rows.map(|row| row * step).fold(nothing(), counted)
        });
        parts.reduce(nothing, together)
    };
    // Without a thread nothing is known.
    let parts = threads::install(None, look).unwrap_or_else(|_| nothing());
    let asked = OnceCell::new();
    let sight = Sight::new(&scene.camera, &scene.image);
    let part = |(index, part): (usize, Part)| match part {
        Some(([left, top, right, bottom], count)) => {
            let size = [right - left + step, bottom - top + step];
            let [w, h] = [size[0].min(width - left), size[1].min(height - top)];
            Seen::Part([left, top, w, h], count * u64::from(step) * u64::from(step))
        }
        None => {
            let shape = &scene.objects[index].shape;
            match sight.as_ref().and_then(|sight| sight.outside(shape)) {
                Some(place) => Seen::Outside(place),
                None => hidden_by(scene, &asked, index).map_or(Seen::Nothing, Seen::HiddenBy),
            }
        }
    };
    // Why an object is not seen is told of those that are listed.
    let (listed, rest) = parts.split_at(parts.len().min(LISTED));
    let listed = listed.iter().copied().enumerate().map(part);
    let rest = rest.iter().map(|found| match found {
        Some(_) => part((0, *found)),
        None => Seen::Nothing,
    });
    listed.chain(rest).collect()
}

/// Number of objects of which `inspect` says each what is seen.
pub const LISTED: usize = 100;

type Part = Option<([u32; 4], u64)>;

fn joined(one: Part, other: Part) -> Part {
    let (Some((a, count)), Some((b, more))) = (one, other) else {
        return one.or(other);
    };
    let corners = [
        a[0].min(b[0]),
        a[1].min(b[1]),
        a[2].max(b[2]),
        a[3].max(b[3]),
    ];
    Some((corners, count + more))
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
