//! All crossings of one ray, for the output of `probe`.
//!
//! In: the world, and a point of the picture. Out: the ray's direction and its crossings, the
//! nearest first. They are computed in big numbers, so that each printed number is the correctly
//! rounded exact value.

use std::cmp::Ordering;

use glam::{DVec2, DVec3};

use super::{
    crossing::Crossing,
    world::{Geometry, Precision, World, depth_order},
};
use crate::{
    color::Color,
    math::{Ball, Ball3, Big, Real},
};

/// A crossing of a ray with a surface, as `probe` prints it. Each number is the correctly rounded
/// exact value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hit {
    /// The object's index in the file.
    pub object: usize,
    /// Distance from the eye, in metres.
    pub t: f64,
    /// Distance along the view direction, in metres.
    pub depth: f64,
    /// The crossing's position in world coordinates.
    pub point: DVec3,
    /// The colour at the point.
    pub color: Color,
    /// Whether the picture shows this crossing.
    pub visible: bool,
}

/// Traces the ray through the point `pixels` of the picture plane, given in pixels from the
/// picture's top left corner. Returns the ray's direction, of length 1, and all crossings in front
/// of the eye, the nearest first. Crossings at the same depth are in file order. The point must not
/// be farther from the picture's centre than the `reach` with which [`World::for_rays`] has
/// prepared `world`.
pub fn ray(world: &World, pixels: DVec2) -> (DVec3, Vec<Hit>) {
    let camera = &world.geometry.big.camera;
    let point = camera.picture_point(pixels);
    let r = camera.direction(&point);
    let candidates = world.candidates(&point);
    let mut crossings = Vec::new();
    for &index in &candidates {
        let object = Big::object(&world.geometry, index);
        let first = object.first(&r).unwrap_or_default();
        let second = first.as_ref().and_then(|_| object.second(&r));
        crossings.extend(first.map(|crossing| (index, false, crossing)));
        crossings.extend(second.map(|crossing| (index, true, crossing)));
    }
    sort(&world.geometry, &mut crossings);

    let among = candidates.iter().copied();
    let seen = world.seen(&r, among).unwrap_or_default();
    let along = [&r.x, &r.y, &r.z].map(rounded);
    let turned: Ball3<Big> = [0, 1, 2].map(|i| {
        let part = |j: usize| &camera.axes[j][i] * &along[j];
        part(0) + part(1) + part(2)
    });
    let length = rounded(&r.square).sqrt();
    let direction = turned.each_ref().map(|x| settled(&(x / &length))).into();
    let hit = |(index, second, crossing): (usize, bool, Crossing<Big>)| {
        let lambda = Ball::exact(1.0) / &crossing.inverse_depth;
        let lambda = lambda.scaled(-camera.exponent);
        let coordinate = |i: usize| settled(&(Ball::exact(camera.eye[i]) + &lambda * &turned[i]));
        let odd = Big::object(&world.geometry, index)
            .is_odd(&r)
            .unwrap_or_default();
        Hit {
            object: world.owner(index),
            t: settled(&(&lambda * &length)),
            depth: settled(&(&lambda * &along[2])),
            point: [0, 1, 2].map(coordinate).into(),
            color: world.palette()[world.color_indices(index)[usize::from(odd)]],
            visible: seen.is_some_and(|seen| seen.object == index && seen.second == second),
        }
    };
    (direction, crossings.into_iter().map(hit).collect())
}

/// Sorts crossings by depth, the nearest first. Crossings whose depths cannot be distinguished are
/// in file order.
fn sort(geometry: &Geometry, crossings: &mut [(usize, bool, Crossing<Big>)]) {
    // First, crossings are sorted by their computed depths, which have a total order. Then
    // neighbours that the tracer cannot distinguish by depth are put into file order.
    crossings.sort_by(|(.., a), (.., b)| {
        let difference = b.inverse_depth.mid.minus(&a.inverse_depth.mid);
        difference.to_f64().total_cmp(&0.0)
    });
    for end in 1..crossings.len() {
        let mut at = end;
        while at > 0 {
            let ((i, _, a), (j, _, b)) = (&crossings[at - 1], &crossings[at]);
            if i <= j || depth_order::order(geometry, (*i, a), (*j, b)) != Ok(Ordering::Equal) {
                break;
            }
            crossings.swap(at - 1, at);
            at -= 1;
        }
    }
}

/// Returns a coordinate of a ray's direction, or its squared length, with an error bound for up to
/// 32 roundings.
fn rounded(x: &Big) -> Ball<Big> {
    Ball {
        rad: x.magnitude() * (32.0 * Big::UNIT),
        mid: x.clone(),
    }
}

/// Returns the nearest `f64`, or 0 if the number cannot be distinguished from 0. Without this, a
/// point in the plane y = 0 might be printed with a height of 1e-97.
fn settled(x: &Ball<Big>) -> f64 {
    match x.sign() {
        Ok(Ordering::Equal) => 0.0,
        _ => x.mid.to_finite(),
    }
}
