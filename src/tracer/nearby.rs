//! The objects near a small part of the picture, by their bounds alone.
//!
//! In: a part with too many objects to tell all of them apart. Out: the objects that rays through
//! it may meet, the nearest first, and from these the objects that rays through one pixel may meet.
//! Finding them once takes less time than the way of each ray down the quadtree.

use super::{
    candidates,
    local_form::Patch,
    quadtree::{BoundedObject, Nearness},
    world::World,
};
use crate::area::Area;

/// Returns the objects that rays through a part of the picture may meet, the nearest first. Returns
/// `None` if they are so many that the quadtree finds a ray's objects sooner.
pub fn nearby(world: &World, part: Area) -> Option<Vec<BoundedObject>> {
    let patch = Patch::new(&world.geometry.fast.camera, part);
    world.quadtree.nearby(&patch)
}

/// Narrows the objects near an area to those that rays through a part of that area may meet, in the
/// same order. Returns a palette slot if that colour is certainly seen all over the part.
pub fn in_part(
    world: &World,
    part: Area,
    nearby: &[BoundedObject],
    out: &mut Vec<BoundedObject>,
) -> Option<usize> {
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
