//! Computes the silhouette of a sphere as seen from the eye.

use std::{array, sync::LazyLock};

use glam::{DVec2, DVec3};

use crate::{
    math::{Angle, trig, unit},
    projection::Projection,
    scene::Sphere,
};

/// Maximum number of sides of the polygon that is drawn as a sphere's silhouette. Chosen by
/// judgment: fewer sides would look angular on large spheres, more would only lengthen the answer
/// to the editor.
const SIDES: usize = 64;

/// Largest distance, in pixels, between the silhouette of a small sphere and the polygon that is
/// drawn. It is too small to be seen. With it, a sphere with a radius of 10 pixels has 32 sides
/// instead of 64, and the answer for a thousand spheres is shorter.
const FLATNESS: f64 = 0.1;

/// Cosines and sines of the corners of a regular polygon with [`SIDES`] sides, and of the first
/// corner once more.
static CORNERS: LazyLock<[DVec2; SIDES + 1]> = LazyLock::new(|| {
    array::from_fn(|side| {
        let angle = Angle::from_degrees(360.0 * side as f64 / SIDES as f64);
        DVec2::new(trig::cos(angle), trig::sin(angle))
    })
});

/// Returns points along the whole silhouette of the sphere as seen from the eye. The points are
/// `None` if the eye is inside the sphere.
pub(super) fn circle(
    projection: &Projection,
    sphere: &Sphere,
) -> impl Iterator<Item = Option<DVec3>> {
    let axis = (sphere.center - projection.eye).normalize_or(projection.ahead);
    let (first, second) = axis.any_orthonormal_pair();
    let corners = CORNERS.iter().step_by(SIDES / sides(projection, sphere));
    corners.map(move |at| {
        let towards = first * at.x + second * at.y;
        point(sphere, projection.eye, towards)
    })
}

/// Returns the number of sides of the polygon that is drawn as a sphere's silhouette: a power of
/// two from 8 to [`SIDES`].
///
/// A polygon with n sides differs from a circle of radius r by r·(1 − cos(π/n)), which is less than
/// 5·r/n². The image of a sphere in front of the eye is an ellipse. For a sphere of radius R at the
/// depth z and at the distance d from the eye, its longer half axis at depth 1 is
///
///   R·√(d² − R²)/(z² − R²).
fn sides(projection: &Projection, sphere: &Sphere) -> usize {
    let depth = projection.depth(sphere.center);
    let square = sphere.radius * sphere.radius;
    let across = sphere.center.distance_squared(projection.eye) - square;
    let half_axis = sphere.radius * across.sqrt() / (depth * depth - square);
    let error = |sides: usize| 5.0 * half_axis / projection.pitch / (sides * sides) as f64;
    let is_enough = |sides: &usize| depth > sphere.radius && error(*sides) <= FLATNESS;
    [8, 16, 32].into_iter().find(is_enough).unwrap_or(SIDES)
}

/// Returns the silhouette point of a sphere in the direction `towards`, i.e. a point where a ray
/// from the eye is tangent to the sphere. Returns `None` if the eye is inside the sphere.
///
/// Let r be the radius, c the vector from the eye to the centre, k = r/|c|, and t the unit vector
/// in the direction of `towards` perpendicular to c. Relative to the eye, the point is
///
///   (1 − k²)·c + r·√(1 − k²)·t.
pub(super) fn point(sphere: &Sphere, eye: DVec3, towards: DVec3) -> Option<DVec3> {
    let (axis, distance) = unit(sphere.center - eye);
    let across = towards - axis * towards.dot(axis);
    let k = sphere.radius / distance;
    let rest = (1.0 - k) * (1.0 + k);
    let side = unit(across).0 * (sphere.radius * rest.sqrt());
    let at = eye + axis * (distance * rest) + side;
    (k < 1.0 && at.is_finite()).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;

    /// Compares the polygons of spheres in the middle and near the edges of a picture with
    /// silhouettes of 4096 points.
    #[test]
    fn a_small_sphere_has_an_outline_with_few_sides_that_nobody_sees() {
        let projection = Projection {
            eye: DVec3::ZERO,
            right: DVec3::X,
            top: DVec3::Y,
            ahead: DVec3::NEG_Z,
            pitch: 1.0 / 300.0,
            size: DVec2::new(1280.0, 720.0),
        };
        let radii = [0.002, 0.01, 0.05, 0.2, 0.9];
        for (x, sides) in [
            (0.0, [8, 16, 32, 64, 64]),
            (0.7, [8, 16, 32, 64, 64]),
            (-2.0, [16, 32, 64, 64, 64]),
        ] {
            for (radius, sides) in radii.into_iter().zip(sides) {
                let center = DVec3::new(x, 0.3, -1.0);
                let color = Color::BLACK;
                let sphere = Sphere {
                    center,
                    radius,
                    color,
                };
                let points: Option<Vec<_>> = circle(&projection, &sphere).collect();
                let drawn = projection.line(&points.expect("points")).remove(0);
                assert_eq!(drawn.len() - 1, sides, "{sphere:?}");
                let (first, second) = center.normalize().any_orthonormal_pair();
                let error = (0..4096).map(|at| {
                    let angle = f64::from(at) * std::f64::consts::TAU / 4096.0;
                    let towards = first * libm::cos(angle) + second * libm::sin(angle);
                    let at = point(&sphere, projection.eye, towards);
                    let at = projection.projected(at.expect("a point"));
                    let distance = |ends: &[DVec2]| {
                        let along = ends[1] - ends[0];
                        let part = (at - ends[0]).dot(along) / along.length_squared();
                        at.distance(ends[0] + along * part.clamp(0.0, 1.0))
                    };
                    drawn.windows(2).map(distance).fold(f64::INFINITY, f64::min)
                });
                let error = error.fold(0.0, f64::max);
                assert!(sides == SIDES || error <= FLATNESS, "{error}: {sphere:?}");
            }
        }
    }
}
