//! Finds how much of each object of a scene is visible: the bounding rectangle and the area of its
//! visible part in the picture. For an object of which nothing is visible, finds the reason.
//!
//! The areas are computed by exact integration. If this would take too much work, only the object
//! at the centre of each pixel is determined, the whole pixel is added to this object's area, and
//! the areas are reported as inexact.

use std::{cell::OnceCell, collections::BTreeMap};

use crate::{
    area::Area,
    exact::Integrator,
    projection::Projection,
    scene::{Outside, Scene, Sight},
    threads::{self, prelude::*},
    tracer::{GRID, World, ray},
};
use glam::DVec2;

/// Maximum work for a whole picture, in units of about 50 ns, i.e. about 5 s in all. Each tile of
/// the picture may use an equal part of this work. When a tile has used up its part, each of its
/// remaining pixels is attributed to the object at the pixel's centre. With a larger maximum, the
/// areas would be exact for more scenes, but the answer could take longer.
const MAX_WORK: u64 = 100_000_000;

/// Minimum visible area, in pixels, for which an object is reported as seen. Areas are printed to
/// this precision, so a smaller area could be printed as 0.
pub const MIN_AREA: f64 = 1e-6;

/// How much of an object is seen in the picture, or why nothing of it is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Visibility {
    /// The object is seen. The variant holds the bounding rectangle of the pixels that show the
    /// object, and the object's visible area in pixels.
    Part(Area, f64),
    /// The object lies wholly outside of the picture.
    Outside(Outside),
    /// Another object is seen at the projection of this object's centre. The variant holds the
    /// index of the other object in the file.
    HiddenBy(usize),
    /// Nothing of the object is seen for another reason. For instance, several objects together
    /// hide it, or it is too thin, or it is outside of the picture although its bounding sphere is
    /// not.
    Nothing,
}

/// Determines the visibility of each object. Returns the results in the order of the objects in the
/// file, and whether all areas are exact.
///
/// # Panics
///
/// Panics if the scene was made in code rather than read from a text, and breaks a condition of the
/// language. [`Scene::check`] finds such scenes.
pub fn seen(scene: &Scene) -> (Vec<Visibility>, bool) {
    let world = World::by_object(scene);
    let tiles: Vec<Area> = world.picture().tiles(2 * GRID).collect();
    let most_work = MAX_WORK / tiles.len().max(1) as u64;
    let look = |tile: &Area| {
        let mut areas = SeenAreas::new();
        let integrator = Integrator::for_values(&world, |_| []).with_work_limit(most_work);
        let is_exact = integrator.shares(*tile, |area, shares| {
            for &(object, share) in shares {
                // A fraction of at most 1e-9 of `area` may be a rounding error, so it is ignored.
                if share > 1e-9 && object != world.background() {
                    add(&mut areas, object, (area, area.pixels() as f64 * share));
                }
            }
        });
        (areas, is_exact)
    };
    let look = || tiles.par_iter().map(look).collect::<Vec<_>>();
    // If no thread can be started, the result contains no areas.
    let found = threads::install(None, look).unwrap_or_default();
    let mut areas = SeenAreas::new();
    let is_exact = found.iter().all(|(_, is_exact)| *is_exact);
    // The areas are added in a fixed order, so that the rounding of the sums is always the same.
    for (object, area) in found.into_iter().flat_map(|(areas, _)| areas) {
        add(&mut areas, object, area);
    }
    let asked = OnceCell::new();
    let sight = Sight::new(&scene.camera, &scene.image);
    let seen = |index: usize| match areas.get(&index) {
        Some(&(around, area)) if area >= MIN_AREA => Visibility::Part(around, area),
        _ => {
            let shape = &scene.objects[index].shape;
            match sight.as_ref().and_then(|sight| sight.outside(shape)) {
                Some(place) => Visibility::Outside(place),
                // The search for the object in front takes time, so it is made only for objects
                // that the readable output lists.
                None if index >= LISTED => Visibility::Nothing,
                None => hidden_by(scene, &asked, index)
                    .map_or(Visibility::Nothing, Visibility::HiddenBy),
            }
        }
    };
    ((0..scene.objects.len()).map(seen).collect(), is_exact)
}

/// Maximum number of objects that the readable output of `inspect` lists. For each listed object
/// that is hidden, the output also names the object in front. Hardly anybody would read a much
/// longer list; the JSON output contains all objects.
pub const LISTED: usize = 100;

/// Map from an object's index to the bounding rectangle of the pixels that show the object, and to
/// its visible area in pixels.
type SeenAreas = BTreeMap<usize, (Area, f64)>;

fn add(areas: &mut SeenAreas, object: usize, (pixels, area): (Area, f64)) {
    let (around, sum) = areas.entry(object).or_insert((pixels, 0.0));
    *around = around.with(pixels);
    *sum += area;
}

/// Returns the object that is seen at the projection of an object's centre. Returns `None` if this
/// is the object itself or the background, if the centre is not in the picture, or if the object is
/// a checkerboard, which has no centre.
fn hidden_by(scene: &Scene, world: &OnceCell<World>, index: usize) -> Option<usize> {
    let middle = scene.objects[index].shape.center()?;
    let projection = Projection::new(&scene.camera, &scene.image);
    let at = projection.point(middle)?;
    let is_inside = at.cmpge(DVec2::ZERO).all() && at.cmple(projection.size).all();
    if !is_inside {
        return None;
    }
    let world = world.get_or_init(|| World::for_rays(scene, projection.size / 2.0));
    let (_, hits) = ray(world, at);
    let seen = hits.into_iter().find(|hit| hit.visible)?;
    (seen.object != index).then_some(seen.object)
}
