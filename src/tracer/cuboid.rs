//! The box: six faces, each perpendicular to an axis of the world.
//!
//! In: the box's corners and the camera. Out: a [`Convex`] object, and its corners. A point of a
//! ray is λr relative to the eye, where r is the ray's direction. With μ = 1/λ, the point lies
//! between the planes x = lo and x = hi (also relative to the eye) if lo·μ ≤ r_x ≤ hi·μ. Depending
//! on the side of the planes on which the eye lies, each inequality bounds μ from above or from
//! below. Each bound is a linear form, without a division by r_x, which may be zero.

use std::{array, cmp::Ordering};

use super::{
    camera::Camera,
    convex::Convex,
    form::{Form, axis_vector, inverse_depth},
};
use crate::{
    math::{Ball3, Real},
    scene,
};

/// Prepares a box, or only its face `only` as a flat object. The number of a face is twice the
/// number of the axis to which it is perpendicular, plus one if it is the face at the greater
/// coordinate.
pub fn prepare<T: Real>(camera: &Camera<T>, shape: &scene::Cuboid, only: Option<u8>) -> Convex<T> {
    let (mut fronts, mut backs, mut edges) = (Vec::new(), Vec::new(), Vec::new());
    for plane in 0..6_u8 {
        let (axis, is_upper) = (usize::from(plane / 2), plane % 2 == 1);
        let normal = axis_vector::<T>(axis);
        let corner = if is_upper { shape.max } else { shape.min };
        let (eye, at) = (camera.eye[axis], corner[axis]);
        let order = eye.total_cmp(&at);
        let outside = if is_upper { order } else { order.reverse() };
        let faces = match outside {
            _ if eye == at => {
                // A face whose plane contains the eye is seen edge-on and gives no depth. Its form
                // becomes an edge: a ray on the outer side of the plane misses the box.
                let inward = if is_upper { -1.0 } else { 1.0 };
                let normal = normal.map(|x| x.times_power(inward));
                edges.push(Form::new(camera, &camera.turned(&normal)));
                continue;
            }
            Ordering::Greater => &mut fronts,
            _ => &mut backs,
        };
        let height = camera.relative_coordinate(axis, at);
        faces.push((plane, inverse_depth(camera, &normal, &height)));
    }
    for (i, front) in &fronts {
        // An edge of the box's silhouette lies between a front face and a back face that are not
        // parallel. If only one face is prepared, only the silhouette edges of this face are added.
        let is_bound = |j: &u8| i / 2 != j / 2 && only.is_none_or(|only| [*i, *j].contains(&only));
        let bounding = backs.iter().filter(|(j, _)| is_bound(j));
        edges.extend(bounding.map(|(_, back)| front.minus(back)));
    }
    let Some(only) = only else {
        return Convex::new(edges, fronts, backs);
    };
    // A ray enters the box through the farthest of the front planes, and leaves it through the
    // nearest of the back planes. It therefore meets a front face only where the face's plane is
    // farther than the other front planes, and a back face only where the plane is nearer than the
    // other back planes. Each of these comparisons becomes an edge of the face.
    for (mut faces, is_nearest) in [(fronts, false), (backs, true)] {
        let Some(at) = faces.iter().position(|(number, _)| *number == only) else {
            continue;
        };
        let (_, own) = faces.swap_remove(at);
        edges.extend(faces.iter().map(|(_, other)| {
            if is_nearest {
                own.minus(other)
            } else {
                other.minus(&own)
            }
        }));
        return Convex::new(edges, vec![(only, own)], Vec::new());
    }
    Convex::nothing()
}

/// Returns the eight corners of a box relative to the eye, in the camera's axes.
pub fn corners<T: Real>(camera: &Camera<T>, shape: &scene::Cuboid) -> [Ball3<T>; 8] {
    let (min, max) = (camera.relative(shape.min), camera.relative(shape.max));
    array::from_fn(|corner| {
        camera.turned(&[0, 1, 2].map(|axis| {
            let side = if corner >> axis & 1 == 0 { &min } else { &max };
            side[axis].clone()
        }))
    })
}
