//! Draws the scene's camera as a second camera, the observer, sees it, and moves the scene's camera
//! when a handle in this drawing is dragged.
//!
//! In: the scene's camera, and the projection of the observer. Out: lines and handles in the
//! observer's picture; the camera after a handle was dragged. The handle in the middle of the
//! window moves the window along the view axis and keeps its size. This changes `d`, or the angle
//! of a camera that has `fov` or `hfov`. The handle at the window's edge changes `view_height`, or
//! the angle of such a camera.

use glam::{DVec2, DVec3};

use super::{
    Along,
    handles::{TOO_FAR, appears_at, moved_point, on_line, turned_vector},
    lines::Polyline,
};
use crate::{
    inspect::inspect_camera,
    math::{Angle, trig, unit},
    numbers::short,
    projection::Projection,
    scene::{Camera, FieldOwner, Image, Lens, View},
    schema::CAMERA,
};

/// Length with which an infinite line is drawn, as a multiple of the distance from the eye to the
/// window or to the point that the camera looks at, whichever is greater. It is long enough that
/// parallel lines seem to meet at their ends.
const ENDLESS: f64 = 1e4;

/// Length of the drawn up vector, as a fraction of the distance from the eye to the point that the
/// camera looks at. The up vector's own length is ignored, because it might not fit the drawing.
/// Chosen by eye.
const UP: f64 = 0.12;

/// Minimum of a length or angle after a drag, as a fraction of its value before the drag. It keeps
/// the value above zero. A handle that is dragged farther stops at the minimum, as a slider does at
/// its end.
const SMALLEST: f64 = 0.01;

/// Maximum angle of view after a drag, in degrees. At 180 degrees the view plane would pass through
/// the eye.
const WIDEST: f64 = 179.0;

/// The scene's camera, in an observer's picture.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraOverlay {
    /// Lines of the drawing, each with its name.
    pub lines: Vec<(&'static str, Vec<Polyline>)>,
    /// Handles of the camera.
    pub handles: Vec<CameraHandle>,
    /// Up to two points on the ray at which the user points: where the ray passes through the
    /// window, and where it ends. A point that the observer cannot see is left out.
    pub met: Vec<DVec2>,
}

/// Handle of the camera in an observer's picture.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraHandle {
    /// Name of the field that the handle changes.
    pub name: &'static str,
    /// Position in the observer's picture; `None` if the observer cannot see the handle.
    pub at: Option<DVec2>,
    /// Text for the user: what the handle changes and, if it is a number, its current value.
    pub label: String,
}

/// Ray of the scene's camera at which the user points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointedRay {
    /// Point of the scene's own picture.
    pub pixel: DVec2,
    /// Point in space where the ray ends; `None` if it meets nothing.
    pub end: Option<DVec3>,
}

/// Pyramid from the eye through the window, from which the camera's drawing and handles are
/// computed.
struct Frustum {
    own: Projection,
    /// Distance from the eye to the window.
    d: f64,
    /// Half the window's width and height at depth 1.
    slope: DVec2,
    /// Length with which the up vector is drawn.
    up: f64,
    /// Length with which an infinite line is drawn.
    endless: f64,
}

impl Frustum {
    fn new(camera: &Camera, image: &Image) -> Self {
        let own = Projection::new(camera, image);
        let d = camera.view_height / (own.pitch * own.size.y);
        let distance = match camera.view {
            View::Lookat(point) => unit(point - camera.eye).1,
            View::Direction(_) => 2.0 * d,
        };
        Self {
            own,
            d,
            slope: own.size * (own.pitch / 2.0),
            up: UP * distance,
            endless: ENDLESS * distance.max(d),
        }
    }

    /// Returns the vector from the eye to a point of the plane at depth 1. `across` is the position
    /// of the point, from the view axis to the right and to the top, in halves of the window's
    /// width and height.
    fn towards(&self, across: DVec2) -> DVec3 {
        let DVec2 { x, y } = across * self.slope;
        self.own.ahead + self.own.right * x + self.own.top * y
    }

    fn at(&self, across: DVec2, depth: f64) -> DVec3 {
        self.own.eye + self.towards(across) * depth
    }

    /// Returns the cross-section of the pyramid at a depth, as a closed line.
    fn rectangle(&self, depth: f64) -> [DVec3; 5] {
        [CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[3], CORNERS[0]]
            .map(|corner| self.at(corner, depth))
    }
}

/// Corners of the window, in halves of its width and height.
const CORNERS: [DVec2; 4] = [
    DVec2::new(-1.0, -1.0),
    DVec2::new(1.0, -1.0),
    DVec2::new(1.0, 1.0),
    DVec2::new(-1.0, 1.0),
];

/// Position of the handles of the near and the far plane: the middle of the plane's lower edge, in
/// halves of the window's width and height. On the view axis, these handles would cover those of
/// the eye and the window.
const LOWER: DVec2 = DVec2::new(0.0, -1.0);

/// Name of the handle in the middle of the window.
const WINDOW: &str = CAMERA.d.name;

/// Returns the name of the handle at the window's edge, and its position in halves of the window's
/// width and height.
fn edge_handle(lens: Lens) -> (&'static str, DVec2) {
    match lens {
        Lens::Distance(_) => (CAMERA.view_height.name, DVec2::Y),
        Lens::Fov(_) => (CAMERA.fov.name, DVec2::Y),
        Lens::HorizontalFov(_) => (CAMERA.hfov.name, DVec2::X),
    }
}

/// Returns the names of the camera's handles, with their positions in space.
pub fn camera_handles(camera: &Camera, image: &Image) -> Vec<(&'static str, DVec3)> {
    let frustum = Frustum::new(camera, image);
    let eye = camera.eye;
    let view = match camera.view {
        View::Lookat(point) => (CAMERA.lookat.name, point),
        View::Direction(direction) => (CAMERA.direction.name, eye + direction),
    };
    let mut handles = vec![(CAMERA.eye.name, eye), view];
    for (name, across) in [(WINDOW, DVec2::ZERO), edge_handle(camera.lens)] {
        handles.push((name, frustum.at(across, frustum.d)));
    }
    handles.push((CAMERA.up.name, eye + unit(camera.up).0 * frustum.up));
    handles.push((CAMERA.near.name, frustum.at(LOWER, camera.near)));
    handles.extend(
        camera
            .far
            .map(|far| (CAMERA.far.name, frustum.at(LOWER, far))),
    );
    handles
}

/// Returns the drawing of the scene's camera in the picture of an observer with the projection
/// `seen`.
pub fn camera_overlay(
    camera: &Camera,
    image: &Image,
    seen: &Projection,
    pointed: Option<PointedRay>,
) -> CameraOverlay {
    let frustum = Frustum::new(camera, image);
    let (eye, d) = (camera.eye, frustum.d);
    let corners = |from: f64, to: f64| {
        let edges = CORNERS.map(|corner| [from, to].map(|depth| frustum.at(corner, depth)));
        edges.iter().flat_map(|edge| seen.line(edge)).collect()
    };
    let end = camera.far.unwrap_or(frustum.endless);
    let plane = |depth: Option<f64>| {
        let depth = depth.filter(|depth| *depth > 0.0);
        depth.map_or_else(Vec::new, |depth| seen.line(&frustum.rectangle(depth)))
    };
    let aim = match camera.view {
        View::Lookat(point) => point,
        View::Direction(_) => frustum.at(DVec2::ZERO, end),
    };
    let ray = pointed.map(|PointedRay { pixel, end }| {
        let endless = || frustum.own.at_depth(pixel, frustum.endless);
        [eye, end.unwrap_or_else(endless)]
    });
    let met = pointed.map(|it| [Some(frustum.own.at_depth(it.pixel, d)), it.end]);
    let (facts, _) = inspect_camera(camera, image);
    let angle = |degrees: f64| format!("{degrees:.1}°");
    let label = |name: &'static str| match (name, camera.lens) {
        ("d", _) => format!("window, d {}", short(d)),
        ("view_height", _) => {
            let high = short(camera.view_height);
            format!("{name} {high}, angle {}", angle(facts.fov_deg))
        }
        ("fov", _) => format!("{name} {}", angle(facts.fov_deg)),
        ("hfov", _) => format!("{name} {}", angle(facts.hfov_deg)),
        ("near", _) => format!("{name} {}", short(camera.near)),
        ("far", _) => format!("{name} {}", camera.far.map_or_else(String::new, short)),
        _ => name.to_owned(),
    };
    let handles = camera_handles(camera, image).into_iter();
    let handles = handles.map(|(name, at)| CameraHandle {
        name,
        at: seen.point(at),
        label: label(name),
    });
    CameraOverlay {
        lines: vec![
            ("frustum", corners(d.min(end), end)),
            ("rays", corners(0.0, d)),
            ("axis", seen.line(&[eye, aim])),
            ("window", seen.line(&frustum.rectangle(d))),
            ("near", plane(Some(camera.near))),
            ("far", plane(camera.far)),
            (
                "up",
                seen.line(&[eye, eye + unit(camera.up).0 * frustum.up]),
            ),
            ("ray", ray.map_or_else(Vec::new, |ray| seen.line(&ray))),
        ],
        handles: handles.collect(),
        met: met
            .into_iter()
            .flatten()
            .flatten()
            .filter_map(|at| seen.point(at))
            .collect(),
    }
}

/// Returns the camera after the handle `handle` was dragged to the point `to` of an observer's
/// picture, or as near to it as possible. `seen` is the observer's projection.
///
/// # Errors
///
/// Returns a sentence that says why the handle cannot be moved there.
pub fn moved_camera(
    camera: &Camera,
    image: &Image,
    handle: &str,
    to: DVec2,
    along: Option<Along>,
    seen: &Projection,
) -> Result<Camera, String> {
    let mut handles = camera_handles(camera, image).into_iter();
    let found = handles.find(|(name, _)| *name == handle);
    let (_, at) = found.ok_or_else(|| format!("this camera has no handle `{handle}`"))?;
    let frustum = Frustum::new(camera, image);
    let Frustum { own, slope, .. } = frustum;
    let (eye, mut moved) = (camera.eye, *camera);
    // Moves the handle parallel to `towards` to where it appears nearest to the pointer. Returns
    // its signed distance from `from` in this direction, in units of the length of `towards`. Fails
    // if the new position is behind the observer's eye, or inaccurate because of rounding errors.
    let along_line = |from: DVec3, towards: DVec3| {
        let (direction, length) = unit(towards);
        let (point, across) = on_line(at, direction, to, seen);
        if appears_at(point, across, to, seen) {
            Ok((point - from).dot(direction) / length)
        } else {
            Err(format!(
                "the way of `{handle}` is not seen there: turn the view"
            ))
        }
    };
    let angle = |before: Angle, axis: DVec3, normal: DVec3| {
        let edge = seen.on_plane(to, eye, normal).map(|point| point - eye);
        let half = edge.map(|edge| trig::atan2(edge.dot(axis), edge.dot(own.ahead)));
        let half = half.ok_or("the angle is not seen there: turn the view")?;
        let degrees = (2.0 * half.in_degrees()).clamp(SMALLEST * before.in_degrees(), WIDEST);
        Ok::<_, String>(Angle::from_degrees(degrees))
    };
    match (handle, camera.lens) {
        ("eye", _) => moved.eye = moved_point(at, to, along, seen)?,
        ("lookat", _) => moved.view = View::Lookat(moved_point(at, to, along, seen)?),
        ("direction", _) => {
            moved.view = View::Direction(moved_point(at, to, along, seen)? - eye);
        }
        ("up", _) => moved.up = turned_vector(eye, camera.up, frustum.up, to, seen),
        ("d", lens) => {
            let depth = along_line(eye, own.ahead)?.max(SMALLEST * frustum.d);
            let opened = |slope: f64| {
                let half = trig::atan2(slope * frustum.d, depth);
                Angle::from_degrees(2.0 * half.in_degrees())
            };
            moved.lens = match lens {
                Lens::Distance(_) => Lens::Distance(depth),
                Lens::Fov(_) => Lens::Fov(opened(slope.y)),
                Lens::HorizontalFov(_) => Lens::HorizontalFov(opened(slope.x)),
            };
        }
        ("view_height", _) => {
            let half = along_line(frustum.at(DVec2::ZERO, frustum.d), own.top)?;
            moved.view_height = (2.0 * half).max(SMALLEST * camera.view_height);
        }
        ("fov", Lens::Fov(before)) => moved.lens = Lens::Fov(angle(before, own.top, own.right)?),
        ("hfov", Lens::HorizontalFov(before)) => {
            moved.lens = Lens::HorizontalFov(angle(before, own.right, own.top)?);
        }
        // At least the fraction `SMALLEST` of the distance between the two planes remains.
        ("near", _) => {
            let most = camera.far.map(|far| far - SMALLEST * (far - camera.near));
            let near = along_line(eye, frustum.towards(LOWER))?.max(0.0);
            moved.near = near.min(most.unwrap_or(f64::INFINITY));
        }
        _ => {
            let before = camera.far.unwrap_or(camera.near);
            let least = camera.near + SMALLEST * (before - camera.near);
            moved.far = Some(along_line(eye, frustum.towards(LOWER))?.max(least));
        }
    }
    if FieldOwner::Camera(moved).is_possible() {
        Ok(moved)
    } else {
        Err(TOO_FAR.to_owned())
    }
}
