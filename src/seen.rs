//! What is seen of each object of a scene.
//!
//! In: a scene. Out: for each object its rectangle in the picture and the area that shows it; of
//! those that are not seen, why. Areas are those of `exact` pictures. Where they would take too
//! much work, the middles of pixels count instead, and the answer says so.

use std::{cell::OnceCell, collections::BTreeMap};

use crate::{
    area::Area,
    exact::Integrator,
    projection::Projection,
    scene::{Place, Scene, Sight, sphere_around},
    threads::{self, prelude::*},
    tracer::{GRID, World, ray},
};
use glam::DVec2;

/// Maximum work on a whole picture, in units of some 50 ns. Where a tile's part of it is spent,
/// what the middle of a pixel shows counts for the pixel.
const MOST_WORK: u64 = 100_000_000;

/// The least area that counts as seen, in pixels: areas are told to as much.
pub const LEAST: f64 = 1e-6;

/// What is seen of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// The rectangle of the pixels that show something of it, and the area that is seen, in pixels.
    Part(Area, f64),
    /// It lies wholly outside of the picture.
    Outside(Place),
    /// Another object, by its index in the file, stands before its middle.
    HiddenBy(usize),
    /// It is hidden by several others, or too thin to be seen; or it lies outside of the picture,
    /// and a box around it does not.
    Nothing,
}

/// Says what is seen of each object, and whether all areas are exact.
pub fn seen(scene: &Scene) -> (Vec<Seen>, bool) {
    let world = World::by_object(scene);
    let tiles: Vec<Area> = world.picture().tiles(2 * GRID).collect();
    let most_work = MOST_WORK / tiles.len().max(1) as u64;
    let look = |tile: &Area| {
        let mut areas = SeenAreas::new();
        let integrator = Integrator::of(&world, |_| []).within(most_work);
        let is_exact = integrator.shares(*tile, |area, shares| {
            for &(object, share) in shares {
                // Less may be a rounding.
                if share > 1e-9 && object != world.background() {
                    add(&mut areas, object, (area, area.pixels() as f64 * share));
                }
            }
        });
        (areas, is_exact)
    };
    let look = || tiles.par_iter().map(look).collect::<Vec<_>>();
    // Without a thread nothing is known.
    let found = threads::install(None, look).unwrap_or_default();
    let mut areas = SeenAreas::new();
    let is_exact = found.iter().all(|(_, is_exact)| *is_exact);
    // Always in the same order, so that sums are rounded alike.
    for (object, area) in found.into_iter().flat_map(|(areas, _)| areas) {
        add(&mut areas, object, area);
    }
    let asked = OnceCell::new();
    let sight = Sight::new(&scene.camera, &scene.image);
    let seen = |index: usize| match areas.get(&index) {
        Some(&(around, area)) if area >= LEAST => Seen::Part(around, area),
        _ => {
            let shape = &scene.objects[index].shape;
            match sight.as_ref().and_then(|sight| sight.outside(shape)) {
                Some(place) => Seen::Outside(place),
                // What hides an object is told of those that are listed.
                None if index >= LISTED => Seen::Nothing,
                None => hidden_by(scene, &asked, index).map_or(Seen::Nothing, Seen::HiddenBy),
            }
        }
    };
    ((0..scene.objects.len()).map(seen).collect(), is_exact)
}

/// Number of objects that `inspect` lists for people, and of which it says what hides one.
pub const LISTED: usize = 100;

/// What is seen, by the indices of the objects.
type SeenAreas = BTreeMap<usize, (Area, f64)>;

fn add(areas: &mut SeenAreas, object: usize, (pixels, area): (Area, f64)) {
    let (around, sum) = areas.entry(object).or_insert((pixels, 0.0));
    *around = around.with(pixels);
    *sum += area;
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
