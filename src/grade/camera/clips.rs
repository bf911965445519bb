//! Mistakes of the near and the far plane.

use super::{changed, direction, idea};
use crate::{
    grade::{Idea, level::axes, search::Change},
    numbers::{found, short},
    scene::Scene,
};

const HELP: &str = "what counts is the depth along the view direction, (p − eye) · (−w): more than near and less than far";

/// Planes that were not minded.
pub fn ideas(scene: &Scene) -> Vec<Idea> {
    let (near, far) = (scene.camera.near, scene.camera.far);
    let ignored = |mistake, message: &str, near, far| {
        idea(
            mistake,
            message.to_owned(),
            HELP,
            changed(scene, |scene| {
                (scene.camera.near, scene.camera.far) = (near, far)
            }),
        )
    };
    let mut ideas = Vec::new();
    if near > 0.0 {
        ideas.push(ignored(
            "near_ignored",
            "the near plane was not minded",
            0.0,
            far,
        ));
    }
    if far.is_some() {
        ideas.push(ignored(
            "far_ignored",
            "the far plane was not minded",
            near,
            None,
        ));
    }
    if near > 0.0 && far.is_some() {
        let message = "the near and the far plane were not minded";
        ideas.push(ignored("not_clipped", message, 0.0, None));
    }
    ideas
}

/// Planes at another depth, also where the scene has none.
pub fn changes(scene: &Scene) -> Vec<Change> {
    vec![near(scene), far(scene)]
}

/// Depths from a sixteenth of the way to where the camera looks to, to 256 times as far.
fn depths(scene: &Scene) -> impl Iterator<Item = f64> {
    let reach = direction(scene).length();
    (-8..=16).map(move |k| reach * libm::exp2(f64::from(k) / 2.0))
}

/// What half a pixel is at a distance of 1.
fn half_a_pixel(scene: &Scene) -> f64 {
    let (_, pitch) = axes(scene);
    0.5 * pitch
}

fn near(scene: &Scene) -> Change {
    let near = scene.camera.near;
    Change {
        numbers: Vec::new(),
        mistake: "near",
        help: HELP,
        with: Box::new(move |scene, at| {
            let other = near + at[0];
            let is_before_far = scene.camera.far.is_none_or(|far| other < far);
            (other >= 0.0 && is_before_far)
                .then(|| changed(scene, |scene| scene.camera.near = other))
        }),
        message: Box::new(move |_, other| {
            let is = found(other.camera.near, near);
            match near > 0.0 {
                true => format!(
                    "the near plane is at a wrong depth: as if near were {is} instead of {}",
                    short(near)
                ),
                false => format!(
                    "the picture begins at a near plane, which the scene does not have: as if near were {is}"
                ),
            }
        }),
        starts: depths(scene).map(|depth| vec![depth - near]).collect(),
        // Of a floor as far below, there.
        widths: vec![half_a_pixel(scene) * direction(scene).length()],
    }
}

/// Its depth's inverse: what it cuts of a floor is as high in the picture.
fn far(scene: &Scene) -> Change {
    let inverse = scene.camera.far.map_or(0.0, |far| 1.0 / far);
    Change {
        numbers: Vec::new(),
        mistake: "far",
        help: HELP,
        with: Box::new(move |scene, at| {
            let other = inverse + at[0];
            (other > 0.0 && other * scene.camera.near < 1.0)
                .then(|| changed(scene, |scene| scene.camera.far = Some(1.0 / other)))
        }),
        message: Box::new(|scene, other| {
            let is = other.camera.far.unwrap_or(f64::INFINITY);
            match scene.camera.far {
                Some(far) => format!(
                    "the far plane is at a wrong depth: as if far were {} instead of {}",
                    found(is, far),
                    short(far)
                ),
                None => format!(
                    "the picture ends at a far plane, which the scene does not have: as if far were {}",
                    found(is, 0.0)
                ),
            }
        }),
        starts: depths(scene)
            .map(|depth| vec![1.0 / depth - inverse])
            .collect(),
        widths: vec![half_a_pixel(scene) / direction(scene).length()],
    }
}
