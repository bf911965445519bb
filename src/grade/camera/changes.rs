//! A camera's numbers that are some others: its distance, its roll, its eye, where it looks, or several of them.

use glam::{DVec2, DVec3};

use super::{changed, direction, in_degrees};
use crate::{
    grade::{
        Case, Idea, LEFT,
        extent::pixels,
        fit::Fit,
        level::{axes, distance, with_distance},
        search::Change,
    },
    math::{Angle, trig},
    numbers::{self, found, found_near, found_vector, short, short_vector},
    render::RenderError,
    scene::{Scene, View},
};

/// All numbers of a camera's, as how far they are off: the eye's coordinates; how far to the right and up it looks, in metres where it looks
/// to; its roll in degrees; and its distance in octaves.
const NUMBERS: usize = 7;

/// Those that are one field of the scene.
const FIELDS: [&[usize]; 4] = [EYE, LOOK, ROLL, DISTANCE];
const EYE: &[usize] = &[0, 1, 2];
const LOOK: &[usize] = &[3, 4];
const ROLL: &[usize] = &[5];
const DISTANCE: &[usize] = &[6];

const OF_EYE: &str = "the eye is the pinhole itself, in metres; y points up, and the camera looks from there to lookat";
const OF_LOOKAT: &str = "lookat is the point in the middle of the picture, in metres; y points up";
const OF_ROLL: &str =
    "u' = cos ψ u − sin ψ v and v' = sin ψ u + cos ψ v, with u and v made from up";
const OF_DISTANCE: &str =
    "look at d, view_height and fov: d = view_height/(2 tan(fov/2)), s = view_height/height";

/// One number: the distance, the roll, one coordinate of the eye or of the point looked at.
pub fn single(scene: &Scene) -> Vec<Change> {
    let mut changes = vec![distance_change(scene), roll_change(scene)];
    let axes = [(DVec3::X, "x"), (DVec3::Y, "y"), (DVec3::Z, "z")];
    for (number, (axis, letter)) in axes.into_iter().enumerate() {
        changes.push(Change {
            message: Box::new(move |scene, other| {
                let at = |scene: &Scene| scene.camera.eye.dot(axis);
                one_coordinate("eye", letter, at(scene), at(other))
            }),
            starts: places(scene, scene.camera.eye.dot(axis)),
            ..of(scene, "eye", OF_EYE, &[number])
        });
    }
    if let View::Lookat(lookat) = scene.camera.view {
        for (axis, letter) in axes {
            changes.push(Change {
                // They are two numbers, in the picture.
                numbers: Vec::new(),
                mistake: "lookat",
                help: OF_LOOKAT,
                with: Box::new(move |scene, at| {
                    let view = View::Lookat(lookat + axis * at[0]);
                    seen(changed(scene, |scene| scene.camera.view = view))
                }),
                message: Box::new(move |scene, other| {
                    let at = |scene: &Scene| (scene.camera.eye + direction(scene)).dot(axis);
                    one_coordinate("lookat", letter, at(scene), at(other))
                }),
                starts: places(scene, lookat.dot(axis)),
                widths: vec![widths(scene)[0]],
            });
        }
    }
    changes
}

/// Several coordinates of the eye, or of where it looks.
pub fn several(scene: &Scene) -> Vec<Change> {
    let [eye, look] = [scene.camera.eye, direction(scene)];
    let mut places: Vec<Vec<f64>> = Vec::new();
    for sixth in -12..=12 {
        let factor = libm::exp2(f64::from(sixth) / 6.0);
        // Nearer to the origin, or to where it looks to.
        for far in [eye, -look] {
            places.push((far * (factor - 1.0)).to_array().to_vec());
        }
    }
    for size in sizes(scene).take(4) {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            places.extend([size, -size].map(|by| (axis * by).to_array().to_vec()));
        }
    }
    // Eighths of the window, where it looks to.
    let eighth = look.length() * scene.camera.view_height / (8.0 * distance(scene));
    let steps = || (-4..=4).map(|k| f64::from(k) * eighth);
    let looks = steps().flat_map(|x| steps().map(move |y| vec![x, y]));
    let (what, help) = look_field(scene);
    vec![
        Change {
            starts: places,
            ..of(scene, "eye", OF_EYE, EYE)
        },
        Change {
            starts: looks.collect(),
            ..of(scene, what, help, LOOK)
        },
    ]
}

/// The same, near to what was found of one number each.
pub fn several_near(scene: &Scene, single: &[(Vec<usize>, Fit)]) -> Vec<Change> {
    let of_eye = single
        .iter()
        .filter(|(numbers, _)| EYE.contains(&numbers[0]));
    let eyes = of_eye.map(|(numbers, fit)| spread(numbers, &fit.at)[..EYE.len()].to_vec());
    let (what, help) = look_field(scene);
    vec![
        Change {
            starts: eyes.collect(),
            ..of(scene, "eye", OF_EYE, EYE)
        },
        of(scene, what, help, LOOK),
    ]
}

/// Several fields of the camera, as few of them as explain the picture; from what was found of one field, or of a part of one.
pub fn any(case: &Case, starts: &[(Vec<usize>, Fit)]) -> Result<Option<Idea>, RenderError> {
    if case.full.is_heavy {
        // It takes some hundreds of pictures.
        return Ok(None);
    }
    let Some(all) = all_fields(case, starts)? else {
        return Ok(None);
    };
    if all.left > case.hopeful() * case.small_difference {
        return Ok(None);
    }
    let (fields, at) = fewest_fields(case, all)?;
    let scene: &Scene = &case.full.scene;
    let (what, help) = match fields.as_slice() {
        [one] if *one == EYE => ("eye", OF_EYE),
        [one] if *one == LOOK => look_field(scene),
        [one] if *one == ROLL => ("roll", OF_ROLL),
        [one] if *one == DISTANCE => ("distance", OF_DISTANCE),
        _ => (
            "camera",
            "several fields of the camera seem to be off at once, or one that all of them follow from",
        ),
    };
    let numbers = fields.concat();
    let mut found: Vec<f64> = numbers.iter().map(|number| at[*number]).collect();
    let change = of(scene, what, help, &numbers);
    if case.small.is_heavy
        && let Some(fit) = change.refined(case, &found)?
    {
        found = fit.at;
    }
    Ok(change.idea(scene, &found))
}

/// All numbers that come nearest to the small picture, from the best two of some starts: each start is the best of its kind, and what
/// two of them have in common the fit finds from either.
fn all_fields(case: &Case, starts: &[(Vec<usize>, Fit)]) -> Result<Option<Fit>, RenderError> {
    let all = of_fields(&case.full.scene, &FIELDS);
    let is_field = |(numbers, _): &&(Vec<usize>, Fit)| FIELDS.contains(&numbers.as_slice());
    let mut starts: Vec<_> = starts.iter().filter(is_field).collect();
    starts.sort_by(|p, q| p.1.left.total_cmp(&q.1.left));
    let mut near: Option<Fit> = None;
    for (numbers, start) in starts.into_iter().take(2) {
        if let Some(fit) = all.fit(case, &case.tiny, &spread(numbers, &start.at))?
            && near.as_ref().is_none_or(|near| fit.left < near.left)
        {
            near = Some(fit);
        }
    }
    match near {
        Some(near) => all.fit(case, &case.small, &near.at),
        None => Ok(None),
    }
}

/// As few fields as come as near, and all numbers then.
fn fewest_fields(
    case: &Case,
    Fit { mut at, left }: Fit,
) -> Result<(Vec<&'static [usize]>, Vec<f64>), RenderError> {
    let mut fields = FIELDS.to_vec();
    // A field that explains less than a tenth of what has to be explained is right, and so is one without which a twentieth more is left:
    // that is what a number brings that is fitted to noise in a few hundred pixels.
    let enough = (1.05 * left).max(0.1 * LEFT * case.small_difference);
    while fields.len() > 1 {
        let mut without: Option<(Fit, Vec<&[usize]>)> = None;
        for one in &fields {
            let mut rest = fields.clone();
            rest.retain(|field| field != one);
            let start: Vec<f64> = rest.concat().into_iter().map(|number| at[number]).collect();
            if let Some(found) =
                of_fields(&case.full.scene, &rest).fit(case, &case.small, &start)?
                && found.left < without.as_ref().map_or(enough, |(fit, _)| fit.left)
            {
                without = Some((found, rest));
            }
        }
        let Some((found, rest)) = without else { break };
        at = spread(&rest.concat(), &found.at);
        fields = rest;
    }
    Ok((fields, at))
}

fn of_fields(scene: &Scene, fields: &[&[usize]]) -> Change {
    of(scene, "camera", OF_EYE, &fields.concat())
}

/// A change of some of the numbers.
fn of(scene: &Scene, mistake: &'static str, help: &'static str, numbers: &[usize]) -> Change {
    let numbers = numbers.to_vec();
    let all = widths(scene);
    Change {
        mistake,
        help,
        widths: numbers.iter().map(|number| all[*number]).collect(),
        numbers: numbers.clone(),
        with: Box::new(move |scene, at| posed(scene, &spread(&numbers, at))),
        message: Box::new(message),
        starts: Vec::new(),
    }
}

/// All numbers, some of them not 0.
fn spread(numbers: &[usize], at: &[f64]) -> Vec<f64> {
    let mut all = vec![0.0; NUMBERS];
    for (number, at) in numbers.iter().zip(at) {
        all[*number] = *at;
    }
    all
}

/// A scene whose camera is off by so much.
fn posed(scene: &Scene, by: &[f64]) -> Option<Scene> {
    let mut other = scene.clone();
    let camera = &mut other.camera;
    camera.eye += DVec3::from_slice(by);
    if by[3] != 0.0 || by[4] != 0.0 {
        let ([u, v, _], _) = axes(scene);
        let aside = u * by[3] + v * by[4];
        camera.view = match camera.view {
            View::Lookat(lookat) => View::Lookat(lookat + aside),
            View::Direction(direction) => View::Direction(direction + aside),
        };
    }
    camera.roll = camera.roll + Angle::from_degrees(by[5]);
    if by[6] != 0.0 {
        other = with_distance(&other, distance(scene) * libm::exp2(by[6]));
    }
    seen(other)
}

/// Steps of all numbers that move the picture by half a pixel: where the camera looks to, or in the corners.
fn widths(scene: &Scene) -> [f64; NUMBERS] {
    let (_, pitch) = axes(scene);
    let place = 0.5 * pitch * direction(scene).length();
    let size = DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height));
    let angle = 0.5 / (0.5 * size.length());
    let octaves = angle / std::f64::consts::LN_2;
    [
        place,
        place,
        place,
        place,
        place,
        angle.to_degrees(),
        octaves,
    ]
}

/// How far something of the camera's may be off, in metres.
fn sizes(scene: &Scene) -> impl Iterator<Item = f64> {
    let reach = direction(scene).length();
    (0..=6).map(move |k| reach * libm::exp2(f64::from(-k)))
}

/// Where a coordinate may be: off by any size, of the other sign, or 0.
fn places(scene: &Scene, here: f64) -> Vec<Vec<f64>> {
    let sizes = sizes(scene).flat_map(|size| [size, -size]);
    let all = sizes.chain([-2.0 * here, -here]);
    all.map(|by| vec![by]).collect()
}

fn distance_change(scene: &Scene) -> Change {
    Change {
        message: Box::new(|scene, other| {
            let fov = |scene: &Scene| {
                let half = trig::atan(scene.camera.view_height / (2.0 * distance(scene)));
                2.0 * in_degrees(half)
            };
            let rounded = |degrees: f64| short((1000.0 * degrees).round() / 1000.0);
            let (is, should) = (fov(other), fov(scene));
            let shown = match rounded(is) == rounded(should) {
                true => found(is, should),
                false => rounded(is),
            };
            format!(
                "the view plane is at the wrong distance: as if d were {} instead of {} (a field of view of {shown} degrees instead of {})",
                found(distance(other), distance(scene)),
                short(distance(scene)),
                rounded(should)
            )
        }),
        starts: (-8..=8).map(|k| vec![f64::from(k) / 4.0]).collect(),
        ..of(scene, "distance", OF_DISTANCE, DISTANCE)
    }
}

fn roll_change(scene: &Scene) -> Change {
    Change {
        message: Box::new(|scene, other| {
            format!(
                "the camera is rolled wrongly: as if roll were {} degrees instead of {}",
                found_near(in_degrees(other.camera.roll), in_degrees(scene.camera.roll)),
                short(in_degrees(scene.camera.roll))
            )
        }),
        starts: (-17..=18).map(|k| vec![10.0 * f64::from(k)]).collect(),
        ..of(scene, "roll", OF_ROLL, ROLL)
    }
}

fn one_coordinate(what: &str, letter: &str, should: f64, is: f64) -> String {
    format!(
        "{what} is in a wrong place: as if its {letter} were {} instead of {}",
        found_near(is, should),
        short(should)
    )
}

/// The field that says where it looks.
fn look_field(scene: &Scene) -> (&'static str, &'static str) {
    match scene.camera.view {
        View::Lookat(_) => ("lookat", OF_LOOKAT),
        View::Direction(_) => (
            "direction",
            "the direction is that of the ray through the middle of the picture; y points up",
        ),
    }
}

/// What differs between a scene's camera and another one.
fn message(scene: &Scene, other: &Scene) -> String {
    let reach = direction(scene).length();
    let mut found = Vec::new();
    let (eye, there) = (scene.camera.eye, other.camera.eye);
    if eye != there {
        let lookat = eye + direction(scene);
        let mut text = wrong("eye", eye, there, reach);
        // With lookat it is where it looks to that stays.
        let stays = (other.camera.eye + direction(other) - lookat).length() < FINE * reach;
        if let Some(times) = times(eye, there) {
            text += &format!(", {times} times as large");
        } else if let Some(times) = times(eye - lookat, there - lookat)
            && stays
        {
            text += &format!(", {times} times as far from lookat");
        }
        found.push(text);
    }
    let seen_off = |by: DVec3| pixels(by.length() / (2.0 * widths(scene)[0]));
    match (scene.camera.view, other.camera.view) {
        (View::Lookat(p), View::Lookat(q)) if p != q => {
            found.push(format!(
                "{} or any point that is seen there, about {} from where it should be",
                wrong("lookat", p, q, reach),
                seen_off(q - p)
            ));
        }
        (View::Direction(p), View::Direction(q)) if p != q => {
            found.push(format!(
                "{}, about {} away",
                wrong("direction", p, q, reach),
                seen_off(q - p)
            ));
        }
        _ => {}
    }
    let [roll, other_roll] = [scene, other].map(|scene| in_degrees(scene.camera.roll));
    if roll != other_roll {
        let (is, should) = (found_near(other_roll, roll), short(roll));
        found.push(format!("roll were {is} degrees instead of {should}"));
    }
    let [d, other_d] = [scene, other].map(distance);
    if d != other_d {
        found.push(format!(
            "d were {} instead of {}",
            numbers::found(other_d, d),
            short(d)
        ));
    }
    let what = match found.len() {
        1 => "the camera is off",
        _ => "several things about the camera are off",
    };
    format!("{what}: as if {}", found.join("; and as if "))
}

/// Places that are nearer than this share of the way to where the camera looks are the same: a number of times that is told has two
/// decimals, of which the last is half of it.
const FINE: f64 = 5e-3;

/// How many times as long a vector is as another one of the same direction.
fn times(should: DVec3, is: DVec3) -> Option<String> {
    let times = is.length() / should.length();
    let aside = (is - should * times).length();
    (times.is_finite() && (times - 1.0).abs() > FINE && aside < FINE * is.length())
        .then(|| short((100.0 * times).round() / 100.0))
}

/// A point or a vector in place of another one.
fn wrong(what: &str, should: DVec3, is: DVec3, reach: f64) -> String {
    format!(
        "{what} were {} instead of {}",
        found_vector(is, should, reach),
        short_vector(should)
    )
}

/// A scene whose camera looks somewhere, and not from where it looks to.
pub fn seen(scene: Scene) -> Option<Scene> {
    let forward = direction(&scene);
    let is_sound = scene.camera.eye.is_finite() && forward.is_finite() && forward != DVec3::ZERO;
    let is_far = |scene: &Scene| {
        let d = distance(scene);
        d.is_finite() && d > 0.0
    };
    (is_sound && is_far(&scene)).then_some(scene)
}
