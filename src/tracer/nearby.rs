//! The objects near a small part of the picture, by their bounds alone.
//!
//! In: a part in which too many objects lie for all of them to be told apart. Out: those that rays
//! through it may meet, the nearest first, and of these those that rays through a pixel may. To
//! find them once takes less time than each ray's way down the quadtree.

use super::{
    candidates,
    local_form::Patch,
    quadtree::{Item, Nearness},
    world::World,
};
use crate::area::Area;

/// The objects that rays through a part of the picture may meet, the nearest first; none if they
/// are so many that the quadtree finds a ray's objects sooner.
pub fn nearby(world: &World, part: Area) -> Option<Vec<Item>> {
    let patch = Patch::new(&world.geometry.fast.camera, part);
    world.quadtree.nearby(&patch)
}

/// Keeps of the objects near an area those that rays through a part of that area may meet, in the
/// same order. Answers the colour's slot if it is certain that one is seen in the part.
pub fn in_part(world: &World, part: Area, nearby: &[Item], out: &mut Vec<Item>) -> Option<usize> {
    out.clear();
    let patch = Patch::new(&world.geometry.fast.camera, part);
    let rectangle = world.quadtree.rectangle(&patch)?;
    let [near, far] = candidates::clips_over(world, &patch);
    // The nearest object that fills the part.
    let (mut front, mut hidden) = (None, Nearness::NONE);
    for item in nearby {
        if item.nearest <= hidden {
            break;
        }
        if !item.bounds.meets(&rectangle) {
            continue;
        }
        out.push(*item);
        if item.bounds.contains(&rectangle)
            && let Some(cover) = candidates::cover(world, item.object as usize, &patch, near, far)
            && cover.is_whole
        {
            let farthest = Nearness::below(cover.inverse_depth.low);
            if farthest > hidden {
                (front, hidden) = (Some(item.object), farthest);
            }
        }
    }
    out.retain(|item| item.nearest > hidden);
    match (out.as_slice(), front) {
        ([], None) => Some(world.background()),
        ([only], Some(front)) if only.object == front => {
            let [slot, second] = world.slots(front as usize);
            (slot == second).then_some(slot)
        }
        _ => None,
    }
}
