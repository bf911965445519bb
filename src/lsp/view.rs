//! Reads the parameter `view` of requests about the picture. It describes an observer, i.e. a
//! second camera that sees the scene from outside. Also converts the drawing of the scene's own
//! camera in the observer's picture to JSON.

use glam::{DVec2, DVec3};
use serde::Deserialize;
use serde_json::{Value, json};

use super::params::{Refusal, optional};
use crate::{
    editor::viewport::{CameraOverlay, Observer, USUAL_FOV},
    scene::Scene,
};

/// The parameter `view`. If `eye` and `lookat` are missing, the server chooses them.
#[derive(Deserialize)]
struct ViewParams {
    eye: Option<[f64; 3]>,
    lookat: Option<[f64; 3]>,
    from: Option<[f64; 3]>,
    up: Option<[f64; 3]>,
    fov: Option<f64>,
    size: [u32; 2],
}

/// Returns the observer that the parameter `view` of a request describes; `None` if there is no
/// such parameter.
///
/// # Errors
///
/// Returns an error if no camera of the language can have these values.
pub fn observer(params: &Value, scene: &Scene) -> Result<Option<Observer>, Refusal> {
    let Some(view) = optional::<ViewParams>(params, "view")? else {
        return Ok(None);
    };
    let up = view.up.map_or(DVec3::Y, DVec3::from);
    let fov = view.fov.unwrap_or(USUAL_FOV);
    let size = view.size;
    let given = |eye, lookat| Observer {
        eye,
        lookat,
        up,
        fov,
        size,
    };
    // The choice of `eye` and `lookat` depends on the other values, so the other values are checked
    // first.
    let is_possible = given(DVec3::ZERO, DVec3::NEG_Z).is_possible();
    let observer = match (view.eye, view.lookat) {
        _ if !is_possible => None,
        (Some(eye), Some(lookat)) => Some(given(eye.into(), lookat.into())),
        (None, None) => {
            let from = view.from.map(DVec3::from);
            Some(Observer::around(scene, from, up, fov, size))
        }
        _ => {
            let message = "`view` has both `eye` and `lookat`, or neither";
            return Err(Refusal::invalid(message));
        }
    };
    let observer = observer.filter(Observer::is_possible);
    let impossible = || {
        Refusal::invalid(
            "`view` is a camera: its `eye` is not its `lookat`, `up` is not 0, `fov` is between 0 and 180, and a side of `size` is from 1 to 2^20",
        )
    };
    observer.map(Some).ok_or_else(impossible)
}

/// Writes an observer as the parameter `view` of further requests.
pub fn written_view(observer: &Observer) -> Value {
    json!({
        "eye": observer.eye.to_array(),
        "lookat": observer.lookat.to_array(),
        "up": observer.up.to_array(),
        "fov": observer.fov,
        "size": observer.size,
    })
}

/// Converts the drawing of the scene's camera to JSON. The functions `point` and `lines` convert
/// its points and lines.
pub fn written_camera(
    overlay: &CameraOverlay,
    point: impl Fn(DVec2) -> Value,
    lines: impl Fn(&[Vec<DVec2>]) -> Value,
) -> Value {
    let named = overlay.lines.iter();
    let named = named.map(|(name, its)| ((*name).to_owned(), lines(its)));
    let handles = overlay
        .handles
        .iter()
        .map(|it| json!({ "handle": it.name, "at": it.at.map(&point), "label": it.label }));
    json!({
        "lines": named.collect::<serde_json::Map<_, _>>(),
        "handles": handles.collect::<Vec<_>>(),
        "met": overlay.met.iter().map(|at| point(*at)).collect::<Vec<_>>(),
    })
}
