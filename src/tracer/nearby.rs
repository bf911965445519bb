//! The objects near a small part of the picture, selected by their bounds alone.
//!
//! In: a part with so many objects that it would take too long to find out exactly where each is
//! seen. Out: the objects that rays through the part may hit, the nearest first. A second function
//! selects from them the objects that rays through a single pixel may hit. One search of the
//! quadtree for all rays of the part takes less time than a search for each ray.

use super::{
    candidates,
    local_form::Patch,
    quadtree::{BoundedObject, Nearness},
    world::World,
};
use crate::area::Area;

/// Returns the objects that rays through a part of the picture may hit, sorted by their nearest
/// points, the nearest first. Returns `None` if there are so many objects that searching the
/// quadtree for each ray is faster.
pub fn nearby(world: &World, part: Area) -> Option<Vec<BoundedObject>> {
    let patch = Patch::new(&world.geometry.fast.camera, part);
    world.quadtree.nearby(&patch)
}

/// Replaces `out` by the objects of `nearby` that rays through `part` may hit, in unchanged order.
/// `nearby` is the result of the function [`nearby`] for an area that contains the part. If the
/// whole part certainly shows one colour, returns the colour's index in the palette; otherwise
/// returns `None`.
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
    // `front` is an object that every ray through the part hits. If there are several, it is the
    // one whose minimum inverse depth is the greatest. `hidden` is this minimum.
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
            let [color_index, second] = world.color_indices(front as usize);
            (color_index == second).then_some(color_index)
        }
        _ => None,
    }
}
