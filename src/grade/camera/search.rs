//! A camera's distance, roll, eye or lookat that is some other.

use glam::DVec3;

use super::{changed, direction, idea, in_degrees};
use crate::{
    film::rmse,
    grade::{
        Case, Idea, Make,
        fit::fit,
        level::{axes, distance, with_distance},
    },
    math::{Angle, trig},
    numbers::short,
    render::RenderError,
    scene::{Scene, View},
};

/// Another distance or roll, or one coordinate of the eye or of the point looked at, whichever it is.
///
/// Each is tried at some values by pictures of samples, which cost little, and those by which one came nearest are fitted.
pub fn search(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let scene: &Scene = &case.full.scene;
    let mut starts = Vec::new();
    for (at, change) in changes(case).into_iter().enumerate() {
        let (left, value) = start(case, &change)?;
        starts.push((left, at, value, change));
    }
    starts.sort_by(|p, q| (p.0.total_cmp(&q.0)).then(p.1.cmp(&q.1)));
    let mut ideas = Vec::new();
    for (.., value, change) in starts.into_iter().take(case.most(FITTED)) {
        let make = |p: &[f64]| Some(Make::Scene(Box::new((change.with)(scene, p[0])?)));
        let widths = [change.width];
        let Some(found) = fit(&case.small, &case.control, &[value], &widths, &make)? else {
            continue;
        };
        if let Some(other) = (change.with)(scene, found[0]) {
            let message = (change.message)(scene, &other);
            ideas.push(idea(change.mistake, message, change.help, other));
        }
    }
    Ok(ideas)
}

/// So many changes are fitted, those that came nearest when they were tried.
const FITTED: usize = 3;

/// The pixels' samples of a picture for trying.
const TRIED: u64 = 4;

type With = dyn Fn(&Scene, f64) -> Option<Scene>;
type Message = dyn Fn(&Scene, &Scene) -> String;

/// A number of the camera's that may be wrong, as how far it is off.
struct Change {
    mistake: &'static str,
    help: &'static str,
    /// The scene with it, if that is one.
    with: Box<With>,
    /// Of the right scene and the other one.
    message: Box<Message>,
    /// Where to try, and how much closer around the best of them.
    points: Vec<f64>,
    closer: Box<dyn Fn(f64) -> Vec<Vec<f64>>>,
    /// A step that moves the picture by a part of a pixel.
    width: f64,
}

fn changes(case: &Case) -> Vec<Change> {
    let scene: &Scene = &case.full.scene;
    let mut changes = vec![distance_change(), roll_change()];
    // Seen where the camera looks to, a part of a pixel.
    let (_, pitch) = axes(scene);
    let width = 0.5 * f64::from(case.small.factor) * pitch * direction(scene).length();
    let axes = [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")];
    for (axis, letter) in axes {
        changes.push(place_change(scene, EYE, axis, letter, width));
    }
    if let View::Lookat(_) = scene.camera.view {
        for (axis, letter) in axes {
            changes.push(place_change(scene, LOOKAT, axis, letter, width));
        }
    }
    changes
}

fn distance_change() -> Change {
    Change {
        mistake: "distance",
        help: "look at d, view_height and fov: d = view_height/(2 tan(fov/2)), s = view_height/height",
        with: Box::new(|scene, octaves| {
            Some(with_distance(scene, distance(scene) * libm::exp2(octaves)))
        }),
        message: Box::new(|scene, other| {
            let fov = |scene: &Scene| {
                let half = trig::atan(scene.camera.view_height / (2.0 * distance(scene)));
                short((2000.0 * in_degrees(half)).round() / 1000.0)
            };
            format!(
                "the view plane is at the wrong distance: as if d were {} instead of {} (a field of view of {} degrees instead of {})",
                rounded(distance(other)),
                short(distance(scene)),
                fov(other),
                fov(scene)
            )
        }),
        points: (-8..=8).map(|k| f64::from(k) / 4.0).collect(),
        closer: Box::new(|_| halves(0.25)),
        width: 0.01,
    }
}

fn roll_change() -> Change {
    Change {
        mistake: "roll",
        help: "u' = cos ψ u − sin ψ v and v' = sin ψ u + cos ψ v, with u and v made from up",
        with: Box::new(|scene, degrees| {
            Some(changed(scene, |scene| {
                scene.camera.roll = scene.camera.roll + Angle::from_degrees(degrees);
            }))
        }),
        message: Box::new(|scene, other| {
            format!(
                "the camera is rolled wrongly: as if roll were {} degrees instead of {}",
                rounded(in_degrees(other.camera.roll)),
                short(in_degrees(scene.camera.roll))
            )
        }),
        points: (-17..=18).map(|k| 10.0 * f64::from(k)).collect(),
        closer: Box::new(|_| halves(10.0)),
        width: 0.5,
    }
}

/// Half a step to both sides, and then a quarter.
fn halves(step: f64) -> Vec<Vec<f64>> {
    [2.0, 4.0]
        .map(|part| vec![-step / part, step / part])
        .to_vec()
}

/// A point of the camera's.
#[derive(Clone, Copy)]
struct Point {
    name: &'static str,
    help: &'static str,
    get: fn(&Scene) -> DVec3,
    set: fn(&mut Scene, DVec3),
}

const EYE: Point = Point {
    name: "eye",
    help: "the eye is the pinhole itself, in metres; y points up, and the camera looks from there to lookat",
    get: |scene| scene.camera.eye,
    set: |scene, eye| scene.camera.eye = eye,
};

const LOOKAT: Point = Point {
    name: "lookat",
    help: "lookat is the point in the middle of the picture, in metres; y points up",
    get: |scene| scene.camera.eye + direction(scene),
    set: |scene, lookat| scene.camera.view = View::Lookat(lookat),
};

/// One of its coordinates.
fn place_change(
    scene: &Scene,
    point: Point,
    axis: DVec3,
    letter: &'static str,
    width: f64,
) -> Change {
    let here = (point.get)(scene).dot(axis);
    // Of all sizes; and with the other sign, or 0.
    let reach = direction(scene).length();
    let sizes = (0..=6).map(|k| reach * libm::exp2(f64::from(-k)));
    let mut points: Vec<f64> = sizes.flat_map(|size| [size, -size]).collect();
    points.extend([0.0, -2.0 * here, -here]);
    Change {
        mistake: point.name,
        help: point.help,
        with: Box::new(move |scene, by| {
            let other = changed(scene, |scene| {
                (point.set)(scene, (point.get)(scene) + axis * by);
            });
            is_seen(&other).then_some(other)
        }),
        message: Box::new(move |scene, other| {
            let at = |scene: &Scene| (point.get)(scene).dot(axis);
            format!(
                "{} is in a wrong place: as if its {letter} were {} instead of {}",
                point.name,
                rounded(at(other)),
                short(at(scene))
            )
        }),
        points,
        closer: Box::new(|at| {
            [0.25, 0.125]
                .map(|part| vec![-part * at, part * at])
                .to_vec()
        }),
        width,
    }
}

/// The nearest of a few, and then of some closer around it, from which on the way is downhill; and what it leaves.
fn start(case: &Case, change: &Change) -> Result<(f64, f64), RenderError> {
    let mut best = nearest(case, change, &change.points, (f64::INFINITY, 0.0))?;
    for steps in (change.closer)(best.1) {
        let around: Vec<f64> = steps.into_iter().map(|step| best.1 + step).collect();
        best = nearest(case, change, &around, best)?;
    }
    // What is off by little is lost in those samples' noise, but not in the slope of exact pictures.
    let (small, control) = (&case.small, &case.control);
    let made = |at: f64| match (change.with)(&case.full.scene, at) {
        Some(scene) => small.made(&Make::Scene(Box::new(scene)), control).map(Some),
        None => Ok(None),
    };
    let Some(beside) = made(change.width)? else {
        return Ok(best);
    };
    let little = change.width * case.small_errors.towards(&small.exact, &beside, None).times;
    if let Some(there) = made(little)? {
        let left = rmse(&small.a, &there);
        if left < best.0 {
            best = (left, little);
        }
    }
    Ok(best)
}

/// What is left and by which point, the least of some and of another.
fn nearest(
    case: &Case,
    change: &Change,
    points: &[f64],
    mut best: (f64, f64),
) -> Result<(f64, f64), RenderError> {
    let level = &case.small;
    for &point in points {
        let Some(scene) = (change.with)(&case.full.scene, point) else {
            continue;
        };
        let left = rmse(&level.a, &level.tried(&scene, TRIED, &case.control)?);
        if left < best.0 {
            best = (left, point);
        }
    }
    Ok(best)
}

/// The sine of the least angle between the view direction and the up vector that somebody may mean.
const ALONG_UP: f64 = 1e-6;

/// Whether a camera looks anywhere: not from where it looks to, nor along up.
pub(super) fn is_seen(scene: &Scene) -> bool {
    let forward = direction(scene);
    let sine = forward
        .normalize_or_zero()
        .cross(scene.camera.up.normalize_or_zero());
    sine.length() > ALONG_UP
}

/// What was found by a search has few right digits.
fn rounded(x: f64) -> String {
    short(format!("{x:.2e}").parse().unwrap_or(x))
}
