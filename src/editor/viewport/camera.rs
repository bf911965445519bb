//! Moves the camera while the pointer drags: orbit, pan, dolly, roll, look around, and view
//! distance.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::handles::{TOO_FAR, handles, within_half_turn};
use crate::{
    math::{Angle, trig, unit},
    probe::probe,
    projection::Projection,
    scene::{Camera, FieldOwner, Lens, Scene, View},
};

/// Minimum angle, in radians, between the view direction and the up vector or its opposite: one
/// degree. The pointer cannot tilt the camera any closer. If the view direction were parallel to
/// the up vector, the picture would have no defined top. Any small angle avoids this.
const POLE: f64 = PI / 180.0;

/// Factor by which the distance from the eye to the pivot, or to the view plane, changes while the
/// pointer moves by the height of the picture. The pivot is the point about which the camera moves.
/// Chosen by judgment: a larger factor is faster but harder to control.
const ZOOM: f64 = 4.0;

/// Returns the distance from the eye to the pivot, i.e. the point about which the camera moves. The
/// pivot is `lookat`, if the camera has one. Otherwise, it is the point in space that is visible in
/// the middle of the picture. If only the background is visible there, it is the centre of the
/// object nearest to the eye. Returns 1 if there is no such object.
pub fn distance(scene: &Scene) -> f64 {
    let camera = &scene.camera;
    let from_eye = |point: DVec3| unit(point - camera.eye).1;
    if let View::Lookat(point) = camera.view {
        return from_eye(point);
    }
    let projection = Projection::new(camera, &scene.image);
    let seen = probe(scene, projection.size / 2.0).hits.into_iter();
    let seen = seen.map(|(hit, ..)| hit).find(|hit| hit.visible);
    let nearest = || {
        let objects = scene.objects.iter();
        let handles = objects.map(|object| handles(&object.shape, &projection, projection.right));
        let middles = handles.filter_map(|handles| handles.first()?.1);
        let distances = middles.map(from_eye).filter(|distance| *distance > 0.0);
        distances.reduce(f64::min)
    };
    seen.map(|hit| hit.t).or_else(nearest).unwrap_or(1.0)
}

/// Returns the camera after the pointer has dragged the handle `handle`, such as `orbit`, from the
/// point `from` to the point `to` of the picture. `distance` is the distance from the eye to the
/// pivot, which [`distance`] returns.
///
/// # Errors
///
/// Returns a sentence that says why the camera cannot be moved in this way.
pub fn moved(
    camera: &Camera,
    projection: &Projection,
    handle: &str,
    [from, to]: [DVec2; 2],
    distance: f64,
) -> Result<Camera, String> {
    let Projection {
        right,
        top,
        ahead,
        pitch,
        size,
        ..
    } = *projection;
    let by = (to - from) / size.y;
    let middle = camera.eye + ahead * distance;
    let mut moved = *camera;
    match handle {
        "orbit" | "look" => {
            // The picture should follow the pointer. Hence, a camera that looks around turns
            // against the pointer's movement, and a camera that orbits turns with it.
            let is_orbit = handle == "orbit";
            let ahead = turned(camera, projection, if is_orbit { -by } else { by });
            if is_orbit {
                moved.eye = middle - ahead * distance;
            }
            moved.view = match camera.view {
                View::Lookat(_) => View::Lookat(moved.eye + ahead * distance),
                View::Direction(direction) => View::Direction(ahead * unit(direction).1),
            };
        }
        "pan" => {
            let shift = (top * by.y - right * by.x) * (size.y * pitch * distance);
            moved.eye += shift;
            if let View::Lookat(point) = &mut moved.view {
                *point += shift;
            }
        }
        "dolly" => moved.eye = middle - ahead * (distance * zoom(-by.y)),
        "roll" => {
            let [from, to] = [from, to].map(|point| point - size / 2.0);
            if from == DVec2::ZERO || to == DVec2::ZERO {
                return Err("the middle of the picture has no direction to roll to".to_owned());
            }
            // The angle is clockwise in the picture, because y points down. The camera must turn
            // the other way, so the sign is changed.
            let turn = trig::atan2(from.perp_dot(to), from.dot(to));
            moved.roll = within_half_turn(camera.roll, -turn.in_degrees());
        }
        "view_distance" => {
            let wider = |angle: Angle| {
                let half = trig::atan(trig::tan(angle * 0.5) * zoom(by.y));
                Angle::from_degrees(2.0 * half.in_degrees())
            };
            moved.lens = match camera.lens {
                Lens::Distance(d) => Lens::Distance(d * zoom(-by.y)),
                Lens::Fov(angle) => Lens::Fov(wider(angle)),
                Lens::HorizontalFov(angle) => Lens::HorizontalFov(wider(angle)),
            };
        }
        _ => return Err(format!("a camera has no handle `{handle}`")),
    }
    if FieldOwner::Camera(moved).is_possible() {
        Ok(moved)
    } else {
        Err(TOO_FAR.to_owned())
    }
}

/// Returns the factor by which a distance changes if the pointer moves by `heights` times the
/// height of the picture.
fn zoom(heights: f64) -> f64 {
    libm::pow(ZOOM, heights)
}

/// Returns the view direction of a camera that looks around while the pointer moves by `by`, in
/// heights of the picture. A movement by one height turns the direction by half a turn. If the
/// pointer moves to the right, the camera turns to the left, so that the picture follows the
/// pointer.
fn turned(camera: &Camera, projection: &Projection, by: DVec2) -> DVec3 {
    let (up, ahead) = (unit(camera.up).0, projection.ahead);
    // `level_top` is the direction of the picture's top without roll.
    let (sin, cos) = (trig::sin(camera.roll), trig::cos(camera.roll));
    let level_top = projection.top * cos - projection.right * sin;
    let pointer = DVec2::new(by.x * cos - by.y * sin, -by.x * sin - by.y * cos) * PI;

    let axial = ahead.dot(up);
    let radial = ahead - up * axial;
    let polar = trig::atan2(radial.length(), axial).radians;
    // If the camera looks straight up or down, no part of its direction is horizontal. The
    // direction of the picture's top or bottom is used instead.
    let level = if radial == DVec3::ZERO {
        -level_top * axial.signum()
    } else {
        unit(radial).0
    };
    let polar = match polar + pointer.y {
        turned if pointer.y != 0.0 => turned.clamp(polar.min(POLE), polar.max(PI - POLE)),
        _ => polar,
    };
    let (polar, about) = (Angle::from_radians(polar), Angle::from_radians(pointer.x));
    let level = level * trig::cos(about) + up.cross(level) * trig::sin(about);
    level * trig::sin(polar) + up * trig::cos(polar)
}
