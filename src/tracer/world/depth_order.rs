//! The depth order of two crossings. Crossings in one surface count as equal.
//!
//! In: two crossings of one ray. Out: the order of their inverse depths, or doubt if rounding
//! errors leave it uncertain.
//!
//! If two crossings lie in one surface, their computed depths leave the order uncertain at every
//! sample point. Only the highest precision would treat them as equal, but preparing objects in the
//! highest precision takes long. Whether two objects lie in one plane is therefore decided from the
//! numbers of the scene, without rounding. The near and the far plane, which are not given by
//! numbers of an object, are compared by their linear forms.

use std::cmp::Ordering;

use super::precision::{Geometry, Numbers, Precision};
use crate::{
    math::{Big, Double, Doubt, Real},
    tracer::{
        camera::Direction,
        crossing::{Crossing, SurfacePart},
        form::Form,
    },
};

/// Compares the inverse depths of two crossings. Returns `Equal` for two crossings in one surface
/// if their computed depths leave the order uncertain.
#[inline]
pub(in crate::tracer) fn order<T: Real>(
    geometry: &Geometry,
    (i, a): (usize, &Crossing<T>),
    (j, b): (usize, &Crossing<T>),
) -> Result<Ordering, Doubt> {
    let order = a.inverse_depth.compare(&b.inverse_depth);
    match order {
        Err(Doubt) if is_same_surface(geometry, (i, a.part), (j, b.part)) => Ok(Ordering::Equal),
        _ => order,
    }
}

/// Compares the inverse depth of a crossing with that of `clip`, the near or the far plane. Returns
/// `Equal` if the surface lies in the clip plane and the computed depths leave the order uncertain.
#[inline]
pub(super) fn order_to_clip<T: Real>(
    geometry: &Geometry,
    index: usize,
    crossing: &Crossing<T>,
    clip: &Form<T>,
    r: &Direction<T>,
) -> Result<Ordering, Doubt> {
    let order = crossing.inverse_depth.compare(&clip.at(r));
    if order.is_ok() {
        return order;
    }
    // The test below asks whether the surface lies in the near or in the far plane, not in which of
    // the two. This is enough: if the surface lay only in the plane that is not `clip`, the order
    // would already be certain.
    let at = (index, crossing.part);
    // The numbers of two different planes may agree in hundreds of binary digits, so that only the
    // highest precision distinguishes the planes. The highest precision is used last, because
    // preparing objects takes long with it.
    if is_in_clip::<Double>(geometry, at) && is_in_clip::<Big>(geometry, at) {
        return Ok(Ordering::Equal);
    }
    order
}

/// Returns whether two parts of objects are one surface: parts of one plane, or the same side of
/// equal spheres.
#[cold]
fn is_same_surface(
    geometry: &Geometry,
    (i, a): (usize, SurfacePart),
    (j, b): (usize, SurfacePart),
) -> bool {
    match (&geometry.numbers[i], &geometry.numbers[j]) {
        (Numbers::Sphere(center, radius), Numbers::Sphere(other_center, other_radius)) => {
            a == b && center == other_center && radius == other_radius
        }
        _ => is_one_plane(geometry, (i, a), (j, b)),
    }
}

/// Returns whether two flat parts of objects lie in one plane. The decision compares the numbers of
/// the scene, without rounding and without preparing forms. It must be fast, because every sample
/// point needs it if surfaces lie in one plane.
pub(in crate::tracer) fn is_one_plane(
    geometry: &Geometry,
    (i, a): (usize, SurfacePart),
    (j, b): (usize, SurfacePart),
) -> bool {
    match (geometry.numbers[i].plane(a), geometry.numbers[j].plane(b)) {
        (Some(a), Some(b)) => a.equals(&b),
        _ => false,
    }
}

/// Returns whether a flat part of an object lies in the near or in the far plane, according to the
/// forms in the precision `T`.
#[cold]
fn is_in_clip<T: Precision>(geometry: &Geometry, (index, part): (usize, SurfacePart)) -> bool {
    let frame = T::frame(geometry);
    let object = T::object(geometry, index);
    let clips = [&frame.near, &frame.far];
    object
        .plane(part)
        .is_some_and(|plane| clips.into_iter().flatten().any(|clip| plane.equals(clip)))
}
