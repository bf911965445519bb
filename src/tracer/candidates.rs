//! What may be seen in a part of the picture.
//!
//! In: the world, and a rectangle of its view plane. Out: the objects that are not certain to be
//! missed or hidden there. The method is interval arithmetic: the range of each object's forms over
//! the rectangle, widened by the errors of its decisions. An object that every ray of the rectangle
//! meets hides all whose greatest inverse depth is below its least one.

use glam::DVec2;

use crate::area::Area;

use super::{
    curve::Crossings,
    interval::Range,
    local_form::Patch,
    quadtree::{Nearness, Rectangle},
    sub_pixel::SubPixel,
    world::{Precision, World, depth_order},
};

/// An object that may be seen in a part of the picture.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Its index in the file.
    pub object: usize,
    /// Whether every ray through the part meets it, between the near and the far plane.
    pub is_whole: bool,
    /// Holds the inverse depths of what may be seen of it.
    pub(crate) inverse_depth: Range,
    /// Where it may be seen: not only where rays meet it first if the near plane may cut it there.
    pub(crate) crossings: Crossings,
    /// Bounds of the object in the view plane: a patch beside them need not ask for more.
    pub(super) bounds: Rectangle,
}

impl Candidate {
    /// Whether the near plane may cut it.
    pub(crate) fn is_cut(&self) -> bool {
        self.crossings != Crossings::First
    }
}

/// Of some candidates, in file order, those that may be seen in a part of the picture.
pub fn narrowed(world: &World, part: Area, among: &[Candidate], out: &mut Vec<Candidate>) {
    let patch = Patch::new(&world.geometry.fast.camera, part);
    let rectangle = world.quadtree.rectangle(&patch).unwrap_or(Rectangle::ALL);
    let near = among.iter().filter(|among| among.bounds.meets(&rectangle));
    let objects = near.map(|candidate| (candidate.object, candidate.bounds));
    visible_of(world, &patch, objects, out);
}

/// All that may be seen in a part of the picture; whether that is so. It is not known of more than
/// `most`, nor of those that are not worth it: of so many objects, and so many whose bounds a ray
/// meets there, on average.
#[must_use]
pub fn within(
    world: &World,
    part: Area,
    most: usize,
    is_worth: impl FnOnce(usize, f64) -> bool,
    out: &mut Vec<Candidate>,
) -> bool {
    let patch = Patch::new(&world.geometry.fast.camera, part);
    let [near, far] = clips_over(world, &patch);
    let behind = |object: u32| match cover(world, object as usize, &patch, near, far) {
        Some(candidate) if candidate.is_whole => Nearness::below(candidate.inverse_depth.low),
        _ => Nearness::NONE,
    };
    let Some(objects) = world.quadtree.within(&patch, most, behind) else {
        return false;
    };
    let rectangle = world.quadtree.rectangle(&patch).unwrap_or(Rectangle::ALL);
    let shares = objects.iter().map(|item| item.bounds.share_of(&rectangle));
    if !is_worth(objects.len(), shares.sum()) {
        return false;
    }
    let objects = objects
        .iter()
        .map(|item| (item.object as usize, item.bounds));
    visible_of(world, &patch, objects, out);
    true
}

/// The inverse depths of the near and the far plane over a patch, where there are any.
pub(super) fn clips_over(world: &World, patch: &Patch) -> [Option<Range>; 2] {
    [&world.geometry.fast.near, &world.geometry.fast.far]
        .map(|clip| Some(clip.as_ref()?.over(patch).or_all()))
}

/// Of some objects, in file order, those that may be seen in a patch.
pub(crate) fn visible_among(
    world: &World,
    patch: &Patch,
    among: impl Iterator<Item = usize>,
    out: &mut Vec<Candidate>,
) {
    visible_of(
        world,
        patch,
        among.map(|object| (object, Rectangle::ALL)),
        out,
    );
}

/// The same of objects whose bounds are known.
fn visible_of(
    world: &World,
    patch: &Patch,
    among: impl Iterator<Item = (usize, Rectangle)>,
    out: &mut Vec<Candidate>,
) {
    out.clear();
    let [near, far] = clips_over(world, patch);
    // The nearest of what is met everywhere hides what is farther.
    let mut hidden = f64::NEG_INFINITY;
    for (object, bounds) in among {
        let Some(mut candidate) = cover(world, object, patch, near, far) else {
            continue;
        };
        candidate.bounds = bounds;
        if candidate.inverse_depth.high < hidden {
            continue;
        }
        if candidate.is_whole {
            hidden = hidden.max(candidate.inverse_depth.low);
        }
        out.push(candidate);
    }
    out.retain(|candidate| candidate.inverse_depth.high >= hidden);
    if out.len() > 1 {
        drop_covered(world, patch, out);
    }
}

/// The object in a part of the picture, if it may be seen there.
pub(super) fn cover(
    world: &World,
    index: usize,
    patch: &Patch,
    near: Option<Range>,
    far: Option<Range>,
) -> Option<Candidate> {
    let object = f64::object(&world.geometry, index);
    let cover = object.cover(patch)?;
    let mut candidate = Candidate {
        object: index,
        is_whole: cover.is_whole,
        inverse_depth: cover.inverse_depth.or_all(),
        crossings: Crossings::First,
        bounds: Rectangle::ALL,
    };
    if let Some(near) = near
        && candidate.inverse_depth.high >= near.low
    {
        let behind = match object.behind(patch) {
            Some(behind) => behind.or_all(),
            // It has but one surface, which the near plane takes away as a whole or in part.
            None if candidate.inverse_depth.low > near.high => return None,
            None => candidate.inverse_depth,
        };
        if behind.low > near.high {
            return None;
        }
        if candidate.inverse_depth.low > near.high {
            candidate.crossings = Crossings::Second;
            candidate.inverse_depth = behind;
            candidate.is_whole &= behind.high < near.low;
        } else {
            candidate.crossings = Crossings::Both;
            candidate.inverse_depth.low = candidate.inverse_depth.low.min(behind.low);
            candidate.is_whole = false;
        }
    }
    if let Some(far) = far {
        if candidate.inverse_depth.high < far.low {
            return None;
        }
        candidate.is_whole &= candidate.inverse_depth.low > far.high;
    }
    Some(candidate)
}

/// Removes flat objects that lie behind the nearest one all over the patch, though their depths
/// there overlap, or in the same plane as one that comes before them in the file. Of layers the
/// nearest one hides all others; of those in one plane it is the first.
fn drop_covered(world: &World, patch: &Patch, candidates: &mut Vec<Candidate>) {
    let is_flat = |candidate: &&Candidate| {
        let object = f64::object(&world.geometry, candidate.object);
        object.convex().is_ok()
    };
    let may_cover = |candidate: &&Candidate| candidate.is_whole && !candidate.is_cut();
    let fronts = candidates.iter().filter(may_cover).filter(is_flat);
    let nearest = fronts.max_by(|a, b| {
        let nearer = a.inverse_depth.low.total_cmp(&b.inverse_depth.low);
        nearer.then(b.object.cmp(&a.object))
    });
    if let Some(front) = nearest.map(|candidate| candidate.object) {
        candidates.retain(|back| {
            back.object == front || back.is_cut() || !covers(world, front, back.object, patch)
        });
    }
}

/// Whether an object that every ray through a patch meets hides another there by the forms of their
/// planes.
pub(crate) fn covers(world: &World, front: usize, back: usize, patch: &Patch) -> bool {
    let [a, b] = [front, back].map(|object| f64::object(&world.geometry, object));
    let (Ok(a), Ok(b)) = (a.convex(), b.convex()) else {
        return false;
    };
    let ahead = |i: usize, j: usize| {
        let (front_face, back_face) = (&a.firsts()[i], &b.firsts()[j]);
        front_face.minus(back_face).over(patch).low > 0.0
            // Only planes that are equal in `f64` can be one.
            || front < back && front_face.equals(back_face) && {
                let parts = ((front, a.part(i)), (back, b.part(j)));
                depth_order::is_one_plane(&world.geometry, parts.0, parts.1)
            }
    };
    let fronts = 0..a.firsts().len();
    let is_behind = |j: usize| match a.is_inside() {
        true => fronts.clone().any(|i| ahead(i, j)),
        false => fronts.clone().all(|i| ahead(i, j)),
    };
    let mut backs = 0..b.firsts().len();
    match b.is_inside() {
        true => backs.all(is_behind),
        false => backs.any(is_behind),
    }
}

/// The object that is seen at a point of a sub-pixel, of some that may be; and whether the last
/// precision was not asked, in which what it does not tell apart counts as equal.
pub fn object_at<'a>(
    world: &World,
    sub_pixel: SubPixel,
    at: DVec2,
    candidates: impl Iterator<Item = &'a Candidate> + Clone,
) -> (Option<usize>, bool) {
    let offset = sub_pixel.offset(at);
    let camera = &world.geometry.fast.camera;
    let point = camera.sample_point(sub_pixel.x, sub_pixel.y, offset);
    world.object_among(&point, candidates.map(|candidate| candidate.object))
}
