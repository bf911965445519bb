//! The box: six faces along the axes.
//!
//! In: the box's corners and the camera. Out: a [`Convex`] object, and its corners. With μ = 1/λ a
//! point λr lies between the planes x = lo and x = hi (as seen from the eye) where lo·μ ≤ r_x ≤
//! hi·μ: on which side of its two planes the eye lies makes of these a greatest and a least μ, each
//! a linear form, without a division by r_x, which may be zero.

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

/// Prepares a box, or one of its faces as a flat object. The number of a face's plane is twice its
/// axis, and one more for the greater coordinate.
pub fn prepare<T: Real>(camera: &Camera<T>, shape: &scene::Cuboid, only: Option<u8>) -> Convex<T> {
    let (mut fronts, mut backs, mut edges) = (Vec::new(), Vec::new(), Vec::new());
    for plane in 0..6_u8 {
        let (axis, is_upper) = (usize::from(plane / 2), plane % 2 == 1);
        let normal = axis_vector::<T>(axis);
        let (eye, at) = match is_upper {
            true => (camera.eye[axis], shape.max[axis]),
            false => (camera.eye[axis], shape.min[axis]),
        };
        let outside = match is_upper {
            true => eye.total_cmp(&at),
            false => at.total_cmp(&eye),
        };
        let faces = match outside {
            _ if eye == at => {
                // Where the eye lies in a face's plane, that face is seen edge-on and bounds
                // nothing, but a ray must not be on the outside of it.
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
        // Between two parallel faces a ray always is for a while. What bounds the other faces
        // follows from what bounds the only one.
        let is_bound = |j: &u8| i / 2 != j / 2 && only.is_none_or(|only| [*i, *j].contains(&only));
        let others = backs.iter().filter(|(j, _)| is_bound(j));
        edges.extend(others.map(|(_, back)| front.minus(back)));
    }
    let Some(only) = only else {
        return Convex::new(edges, fronts, backs);
    };
    // A ray enters through the farthest of the planes before it, and leaves through the nearest of
    // the others.
    let of_sides = [(fronts, false), (backs, true)].into_iter();
    for (mut faces, is_nearest) in of_sides {
        let Some(at) = faces.iter().position(|(number, _)| *number == only) else {
            continue;
        };
        let (_, own) = faces.swap_remove(at);
        edges.extend(faces.iter().map(|(_, other)| match is_nearest {
            true => own.minus(other),
            false => other.minus(&own),
        }));
        return Convex::new(edges, vec![(only, own)], Vec::new());
    }
    Convex::nothing()
}

/// Its eight corners.
pub fn corners<T: Real>(camera: &Camera<T>, shape: &scene::Cuboid) -> [Ball3<T>; 8] {
    let (min, max) = (camera.relative(shape.min), camera.relative(shape.max));
    array::from_fn(|corner| {
        camera.turned(&[0, 1, 2].map(|axis| {
            let side = if corner >> axis & 1 == 0 { &min } else { &max };
            side[axis].clone()
        }))
    })
}
