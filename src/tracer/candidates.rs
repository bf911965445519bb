//! Conservative visibility: which objects may be seen in a part of the picture.
//!
//! In: the world, and a rectangle of its view plane. Out: the objects that may be seen in the
//! rectangle. An object is left out only if it is certainly hidden, or certainly missed by every
//! ray through the rectangle. The method is interval arithmetic. Whether a ray hits an object
//! depends on linear and quadratic forms of the ray's direction. The range of each form over the
//! rectangle is computed, and widened by the form's error bound. If every ray through the rectangle
//! hits an object, every other object that is certainly farther away is hidden.

use glam::DVec2;

use crate::area::Area;

use super::{
    curve::Crossings,
    interval::Interval,
    local_form::Patch,
    object::SurfaceKind,
    quadtree::{Nearness, Rectangle},
    sub_pixel::SubPixel,
    world::{Precision, World, depth_order},
};

/// An object that may be seen in a part of the picture.
#[derive(Clone, Copy, Debug)]
pub struct VisibilityCandidate {
    /// The object's index in the file.
    pub object: usize,
    /// Whether every ray through the considered rectangle of the picture hits the object between
    /// the near and the far plane.
    pub is_whole: bool,
    /// Interval that contains the inverse depths of all points of the object that may be visible.
    /// An inverse depth is a constant of the camera divided by the depth.
    pub(crate) inverse_depth: Interval,
    /// Which of a ray's crossings with the object may be seen: only the first one, unless the near
    /// plane may cut the object.
    pub(crate) crossings: Crossings,
    /// Bounds of the object in the view plane. Outside of them, the object is not seen.
    pub(super) bounds: Rectangle,
}

impl VisibilityCandidate {
    /// Returns whether the near plane may cut the object.
    pub(crate) fn is_cut(&self) -> bool {
        self.crossings != Crossings::First
    }
}

/// Replaces `out` by the objects in `among` that may be seen in the area `part`. Both lists are in
/// file order.
pub fn narrowed(
    world: &World,
    part: Area,
    among: &[VisibilityCandidate],
    out: &mut Vec<VisibilityCandidate>,
) {
    let patch = Patch::new(&world.geometry.fast.camera, part);
    let rectangle = world.quadtree.rectangle(&patch).unwrap_or(Rectangle::ALL);
    let near = among.iter().filter(|among| among.bounds.meets(&rectangle));
    let objects = near.map(|candidate| (candidate.object, candidate.bounds));
    visible_of(world, &patch, objects, out);
}

/// Replaces `out` by all objects that may be seen in the area `part`, in file order.
///
/// Returns `false` and leaves `out` unchanged if the quadtree finds more than four times `most`
/// list entries for the area. An object has at most four entries, so there are then more than
/// `most` objects.
///
/// Also returns `false` if `is_worth` returns `false`. With this function, the caller can reject an
/// area with too many objects. Its first argument is the number of objects found. Its second
/// argument is the number of objects whose bounds contain a ray, averaged over all rays through the
/// area.
#[must_use]
pub fn within(
    world: &World,
    part: Area,
    most: usize,
    is_worth: impl FnOnce(usize, f64) -> bool,
    out: &mut Vec<VisibilityCandidate>,
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

/// Returns the ranges of the inverse depths of the near and the far plane over the rectangle
/// `patch` of the view plane. An entry is `None` if the scene does not have this plane.
pub(super) fn clips_over(world: &World, patch: &Patch) -> [Option<Interval>; 2] {
    [&world.geometry.fast.near, &world.geometry.fast.far]
        .map(|clip| Some(clip.as_ref()?.over(patch).or_all()))
}

/// Replaces `out` by the objects in `among` that may be seen in the rectangle `patch` of the view
/// plane. Both lists are in file order.
pub(crate) fn visible_among(
    world: &World,
    patch: &Patch,
    among: impl Iterator<Item = usize>,
    out: &mut Vec<VisibilityCandidate>,
) {
    visible_of(
        world,
        patch,
        among.map(|object| (object, Rectangle::ALL)),
        out,
    );
}

/// Replaces `out` by the objects in `among` that may be seen in the rectangle `patch` of the view
/// plane. Both lists are in file order. `among` contains the index and the bounds of each object.
fn visible_of(
    world: &World,
    patch: &Patch,
    among: impl Iterator<Item = (usize, Rectangle)>,
    out: &mut Vec<VisibilityCandidate>,
) {
    out.clear();
    let [near, far] = clips_over(world, patch);
    // If every ray through the rectangle hits an object, this object hides all others whose maximum
    // inverse depth is below its minimum. `hidden` is the greatest of these minimums so far.
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

/// Determines how the object with the index `index` may be seen in the rectangle `patch` of the
/// view plane: whether it fills the rectangle, at which inverse depths, and at which crossings.
/// `near` and `far` are the ranges of the inverse depths of the near and the far plane over the
/// rectangle. Returns `None` if the object is certainly not seen in the rectangle.
pub(super) fn cover(
    world: &World,
    index: usize,
    patch: &Patch,
    near: Option<Interval>,
    far: Option<Interval>,
) -> Option<VisibilityCandidate> {
    let object = f64::object(&world.geometry, index);
    let cover = object.cover(patch)?;
    let mut candidate = VisibilityCandidate {
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
            // The object has a single surface, and the near plane removes all of it.
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

/// Removes flat objects that another flat object hides in the whole rectangle `patch`. Only one
/// object is used to hide others: the nearest flat object that every ray through the rectangle
/// hits. If several objects lie in its plane, the first in the file hides the others. An object
/// that the near plane may cut is never removed, and is not used to hide others.
///
/// The objects' planes are compared, because the ranges of two objects' inverse depths over the
/// rectangle may overlap although one object is nearer along every ray.
fn drop_covered(world: &World, patch: &Patch, candidates: &mut Vec<VisibilityCandidate>) {
    let is_flat = |candidate: &&VisibilityCandidate| {
        let object = f64::object(&world.geometry, candidate.object);
        match object.surface_kind() {
            SurfaceKind::Flat(_) => true,
            SurfaceKind::Round(_) => false,
        }
    };
    let may_cover = |candidate: &&VisibilityCandidate| candidate.is_whole && !candidate.is_cut();
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

/// Returns whether the object `front` certainly hides the object `back` in the whole rectangle
/// `patch`. Every ray through the rectangle must hit `front`. The decision compares the inverse
/// depths of the objects' planes; the result is `false` if `front` or `back` is a sphere.
pub(crate) fn covers(world: &World, front: usize, back: usize, patch: &Patch) -> bool {
    let [a, b] = [front, back].map(|object| f64::object(&world.geometry, object));
    let (a, b) = match (a.surface_kind(), b.surface_kind()) {
        (SurfaceKind::Flat(a), SurfaceKind::Flat(b)) => (a, b),
        (SurfaceKind::Round(_), _) | (SurfaceKind::Flat(_), SurfaceKind::Round(_)) => return false,
    };
    let ahead = |i: usize, j: usize| {
        let (front_face, back_face) = (&a.firsts()[i], &b.firsts()[j]);
        front_face.minus(back_face).over(patch).low > 0.0
            // The slow exact test is skipped if the planes' linear forms differ in `f64`, because
            // the planes are then certainly different.
            || front < back && front_face.equals(back_face) && {
                let parts = ((front, a.part(i)), (back, b.part(j)));
                depth_order::is_one_plane(&world.geometry, parts.0, parts.1)
            }
    };
    let fronts = 0..a.firsts().len();
    let is_behind = |j: usize| {
        if a.is_inside() {
            fronts.clone().any(|i| ahead(i, j))
        } else {
            fronts.clone().all(|i| ahead(i, j))
        }
    };
    let mut backs = 0..b.firsts().len();
    if b.is_inside() {
        return backs.all(is_behind);
    }
    backs.any(is_behind)
}

/// Returns which of the candidates is seen at the point `at` of a sub-pixel (`None` for the
/// background), and whether the answer is certain. An uncertain answer was decided in the highest
/// precision, where inverse depths that cannot be distinguished are treated as equal.
pub fn object_at<'a>(
    world: &World,
    sub_pixel: SubPixel,
    at: DVec2,
    candidates: impl Iterator<Item = &'a VisibilityCandidate> + Clone,
) -> (Option<usize>, bool) {
    let offset = sub_pixel.offset(at);
    let camera = &world.geometry.fast.camera;
    let point = camera.sample_point(sub_pixel.x, sub_pixel.y, offset);
    world.object_among(&point, candidates.map(|candidate| candidate.object))
}
