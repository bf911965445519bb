//! Which of two crossings is nearer, and where they are in one surface, that none is.
//!
//! In: two crossings of one ray. Out: the order of their inverse depths, or doubt. Computed depths
//! of one surface are in doubt at every sample point, and forms take long to prepare. So where
//! depths are in doubt, objects' planes are compared by the numbers of the scene, without rounding
//! (the near and the far plane, which are no numbers of the scene, by their forms).

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

/// Compares the inverse depths of two crossings. Those of one surface are equal, whatever their
/// computed values.
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

/// Compares the inverse depth of a crossing with that of the near or the far plane.
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
    // A surface that lies in one of the two planes and is in doubt about the other would need them
    // to be equal.
    let at = (index, crossing.part);
    // Planes that are hundreds of bits apart need to be asked for more; to prepare them for it
    // takes time.
    if is_in_clip::<Double>(geometry, at) && is_in_clip::<Big>(geometry, at) {
        return Ok(Ordering::Equal);
    }
    order
}

/// Whether two parts of objects are one surface: parts of one plane, or the same side of equal
/// spheres.
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

/// Whether two flat parts of objects lie in one plane, by the numbers of the scene and without
/// rounding: forms need not be prepared for it, and where surfaces lie in one plane it is asked at
/// every sample point.
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

/// Whether a flat part of an object lies in the near or in the far plane.
#[cold]
fn is_in_clip<T: Precision>(geometry: &Geometry, (index, part): (usize, SurfacePart)) -> bool {
    let frame = T::frame(geometry);
    let object = T::object(geometry, index);
    let clips = [&frame.near, &frame.far];
    object
        .plane(part)
        .is_some_and(|plane| clips.into_iter().flatten().any(|clip| plane.equals(clip)))
}
