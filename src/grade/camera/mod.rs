//! Mistakes of the camera.

mod changes;
mod clips;

use glam::DVec3;

pub use self::{
    changes::{any, several, several_near, single},
    clips::changes as clips,
};
use super::{
    Idea, Make,
    level::{distance, with_distance},
};
use crate::{
    math::{Angle, trig},
    numbers::short,
    scene::{Lens, Scene, View},
};

fn idea(mistake: &'static str, message: String, help: &str, scene: Scene) -> Idea {
    Idea {
        mistake,
        message,
        help: help.to_owned(),
        make: Make::Scene(Box::new(scene)),
    }
}

fn changed(scene: &Scene, change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = scene.clone();
    change(&mut scene);
    scene
}

/// The view direction, of any length.
pub fn direction(scene: &Scene) -> DVec3 {
    match scene.camera.view {
        View::Lookat(lookat) => lookat - scene.camera.eye,
        View::Direction(direction) => direction,
    }
}

fn in_degrees(angle: Angle) -> f64 {
    angle.degrees + angle.radians.to_degrees()
}

/// Those that can be named at once.
pub fn ideas(scene: &Scene) -> Vec<Idea> {
    let mut ideas = rolls(scene);
    ideas.extend(views(scene));
    ideas.extend(distances(scene));
    ideas.extend(clips::ideas(scene));
    ideas
}

fn rolls(scene: &Scene) -> Vec<Idea> {
    let roll = scene.camera.roll;
    let degrees = in_degrees(roll);
    if degrees == 0.0 {
        return Vec::new();
    }
    let rolled = |roll| changed(scene, |scene| scene.camera.roll = roll);
    let help = "u' = cos ψ u − sin ψ v and v' = sin ψ u + cos ψ v: a positive roll dips the camera's right side";
    vec![
        idea(
            "roll_sign",
            format!(
                "the roll has the wrong sign: {} degrees instead of {}",
                short(-degrees),
                short(degrees)
            ),
            help,
            rolled(-roll),
        ),
        idea(
            "roll_ignored",
            format!("the roll of {} degrees was not minded", short(degrees)),
            help,
            rolled(Angle::default()),
        ),
        idea(
            "roll_unit",
            "the roll's degrees were taken as radians".to_owned(),
            "sine and cosine take radians: multiply degrees by π/180",
            rolled(Angle::from_radians(degrees)),
        ),
        idea(
            "roll_unit",
            "the roll's radians were taken as degrees".to_owned(),
            "sine and cosine take radians: multiply degrees by π/180 once",
            rolled(Angle::from_degrees(degrees.to_radians())),
        ),
    ]
}

fn views(scene: &Scene) -> Vec<Idea> {
    let forward = direction(scene);
    let looking = |view| changed(scene, |scene| scene.camera.view = view);
    let mut ideas = vec![
        idea(
            "up_negated",
            "the up vector has the wrong sign".to_owned(),
            "u = (up × w)/|up × w| and v = w × u, so that v is on the side of up",
            changed(scene, |scene| scene.camera.up = -scene.camera.up),
        ),
        idea(
            "looks_back",
            "the camera looks the other way".to_owned(),
            "w = −f/|f| points against the view direction f = lookat − eye, and rays go along −d w",
            looking(View::Direction(-forward)),
        ),
    ];
    let eye = scene.camera.eye;
    for (other, letters) in [
        (DVec3::new(eye.z, eye.y, eye.x), "x and z"),
        (DVec3::new(eye.x, eye.z, eye.y), "y and z"),
        (DVec3::new(eye.y, eye.x, eye.z), "x and y"),
    ] {
        let moved = changes::seen(changed(scene, |scene| scene.camera.eye = other));
        if other != eye
            && let Some(moved) = moved
        {
            ideas.push(idea(
                "eye_swapped",
                format!("the eye's coordinates {letters} are exchanged"),
                "y points up; x to the right and z towards the viewer, as seen along −z",
                moved,
            ));
        }
    }
    let (ignored, message, default) = match scene.camera.view {
        View::Lookat(_) => (
            View::Lookat(DVec3::ZERO),
            "lookat was not minded: the camera looks at (0, 0, 0)",
            "lookat is the point in the middle of the picture, in metres: the direction is lookat − eye",
        ),
        View::Direction(_) => (
            View::Direction(-DVec3::Z),
            "the direction was not minded: the camera looks along (0, 0, -1)",
            "the direction is that of the ray through the middle of the picture: w = −f/|f|",
        ),
    };
    if ignored != scene.camera.view
        && let Some(scene) = changes::seen(looking(ignored))
    {
        ideas.push(idea("view_ignored", message.to_owned(), default, scene));
    }
    match scene.camera.view {
        View::Lookat(lookat) if lookat != DVec3::ZERO => ideas.push(idea(
            "lookat_as_direction",
            "lookat was taken as the direction of view".to_owned(),
            "lookat is a point: the direction is lookat − eye",
            looking(View::Direction(lookat)),
        )),
        View::Direction(direction) if direction != scene.camera.eye => ideas.push(idea(
            "direction_as_lookat",
            "the direction was taken as a point to look at".to_owned(),
            "direction is a vector: nothing is subtracted from it",
            looking(View::Lookat(direction)),
        )),
        _ => {}
    }
    if scene.camera.up != DVec3::Y {
        ideas.push(idea(
            "up_ignored",
            "the up vector was not minded: (0, 1, 0) was taken".to_owned(),
            "u = (up × w)/|up × w| and v = w × u",
            changed(scene, |scene| scene.camera.up = DVec3::Y),
        ));
    }
    ideas
}

fn distances(scene: &Scene) -> Vec<Idea> {
    let d = distance(scene);
    let camera = &scene.camera;
    let aspect = f64::from(scene.image.width) / f64::from(scene.image.height);
    let mut wrong = vec![
        (
            d * aspect,
            "field_of_view",
            "the window's height was taken for its width (a vertical field of view for a horizontal one)",
            "view_height and fov are of the window's height; its width is view_height · width/height",
        ),
        (
            2.0 * d,
            "field_of_view",
            "the window is half as high and wide as it should be, or d twice as large",
            "y_v goes from −view_height/2 to view_height/2",
        ),
        (
            d / 2.0,
            "field_of_view",
            "the window is twice as high and wide as it should be, or d half as large",
            "y_v goes from −view_height/2 to view_height/2, not from −view_height to view_height",
        ),
        (
            // The window's height is to the distance as 2 is to d.
            d * camera.view_height / 2.0,
            "view_height_ignored",
            "view_height was not minded: 2 was taken",
            "s = view_height/height is the side of a pixel in the view plane",
        ),
        (
            1.0,
            "distance_ignored",
            "the distance was not minded: 1 was taken",
            "a ray goes along x_v u + y_v v − d w",
        ),
    ];
    if let Lens::Fov(fov) = camera.lens {
        let degrees = in_degrees(fov);
        let by = |half: Angle| camera.view_height / (2.0 * trig::tan(half));
        wrong.extend([
            (
                by(Angle::from_degrees(degrees)),
                "field_of_view",
                "the field of view was not halved",
                "d = view_height/(2 tan(fov/2))",
            ),
            (
                by(Angle::from_radians(degrees / 2.0)),
                "field_of_view",
                "the field of view's degrees were taken as radians",
                "the tangent takes radians: multiply degrees by π/180",
            ),
        ]);
    }
    let is_new = |other: f64| other.is_finite() && other > 0.0 && (other / d - 1.0).abs() > 1e-3;
    wrong
        .into_iter()
        .filter(|(other, ..)| is_new(*other))
        .map(|(other, mistake, message, help)| {
            let message = format!(
                "{message}: as if d were {} instead of {}",
                short(other),
                short(d)
            );
            idea(mistake, message, help, with_distance(scene, other))
        })
        .collect()
}
