//! Finds which numbers of a scene, changed, explain a picture best.
//!
//! The tiny grid tells where to start, and is fitted to.

use glam::DVec3;

use super::{
    candidate::{Candidate, Mistake},
    judge::{Judge, Judged, least},
    level::Level,
    parameters::{self, Owner, Parameter},
    prediction::Prediction,
};
use crate::{
    color::{Color, linear_to_srgb},
    scene::View,
};

/// From so many starts numbers are fitted on the tiny grid.
const STARTS: usize = 2;

/// So many parameters are fitted there, those that start best.
const STARTED: usize = 12;

/// Some numbers of the scene, each with what comes nearest on the tiny grid.
pub fn numeric_mistakes(
    judge: &Judge,
    from: &Judged,
    suspects: &[usize],
    tiny: &Level,
) -> Vec<(f64, Candidate)> {
    let candidate = from.candidate();
    let is_suspect = |parameter: &Parameter| match parameter.owner {
        Owner::Object(object) => suspects.iter().any(|&suspect| {
            let [own, other] = [object, suspect].map(|index| &candidate.scene.objects[index]);
            object == suspect || own.is_beside(other)
        }),
        // A camera that stands or looks elsewhere moves all objects.
        Owner::Camera if !matches!(parameter.fields[0], "near" | "far") => {
            suspects.len() > 1 || candidate.scene.objects.len() == 1
        }
        _ => true,
    };
    let all = parameters::fitted(&candidate.scene).into_iter();
    let is_named = |parameter: &Parameter| candidate.numeric().any(|(own, _)| own == parameter);
    let all = all.filter(|parameter| is_suspect(parameter) && !is_named(parameter));
    let shown = judge.middle.predict(&from.rendering);
    let started = all.filter_map(|parameter| {
        let numbers = parameter.numbers(&candidate.scene);
        let starts = match parameter.is_color() {
            true => vec![colors(&numbers, &shown)],
            false => {
                let pixels = f64::from(judge.coarse.grid.factor) / 2.0;
                let steps = parameter.steps(&candidate.scene, pixels);
                match parameter.fields[..] {
                    ["near" | "far"] => planes(judge, numbers),
                    _ => starts(&parameter, &numbers, &steps),
                }
            }
        };
        let tried = starts.into_iter().filter_map(|start| {
            let started = candidate.with(Mistake::Numbers(parameter.clone(), start))?;
            judge.left(started, tiny)
        });
        let tried = least(tried, STARTS);
        Some((tried.first()?.0, (parameter, tried)))
    });
    let started = least(started, STARTED).into_iter();
    let fitted = started.filter_map(|(_, (parameter, tried))| {
        let fit = |(left, start): (f64, Candidate)| {
            // Colours are read, but where something is done to them.
            if parameter.is_color() && candidate.looks.is_empty() {
                return Some((left, start));
            }
            let free = candidate.numbers().len()..start.numbers().len();
            let (candidate, fitted) =
                judge.fit(&start, &Vec::from_iter(free), tiny, 0.5, [4, 0])?;
            Some((fitted.left, candidate))
        };
        least(tried.into_iter().filter_map(fit), 1).pop()
    });
    fitted.collect()
}

/// The colours that a picture has where these colours alone should be seen: the medians of their
/// channels.
fn colors(numbers: &[f64], shown: &Prediction) -> Vec<f64> {
    let color = |own: &[f64]| {
        let light = Color {
            srgb: [own[0], own[1], own[2]],
        }
        .to_linear();
        let light = DVec3::from(light);
        let moments = &shown.moments;
        let is_alone =
            |at: &usize| moments.mean[*at] == light && moments.variance[*at] == DVec3::ZERO;
        let seen = (0..shown.seen.len())
            .filter(is_alone)
            .map(|at| shown.seen[at]);
        let mut seen: Vec<DVec3> = seen.filter(|seen| !seen.x.is_nan()).collect();
        let mut median = |i: usize| {
            seen.sort_by(|one, other| one[i].total_cmp(&other[i]));
            let middle = seen.get(seen.len() / 2)?;
            // A byte, if the picture has bytes.
            Some((255.0 * linear_to_srgb(middle[i]) * 1024.0).round() / 1024.0)
        };
        [0, 1, 2].map(|i| median(i).unwrap_or(own[i]))
    };
    numbers.chunks_exact(3).flat_map(color).collect()
}

/// Where to look for a plane that clips: at depths around that of the nearest object and what is
/// looked at, each a fifth more than the one before.
fn planes(judge: &Judge, numbers: Vec<f64>) -> Vec<Vec<f64>> {
    const FROM: i32 = -12;
    const TO: i32 = 24;
    let camera = &judge.scene.camera;
    let middle = match camera.view {
        View::Lookat(point) => point.distance(camera.eye),
        View::Direction(_) => camera.eye.length().max(1.0),
    };
    let depths = (FROM..TO).map(|i| vec![middle * libm::pow(1.2, f64::from(i))]);
    std::iter::once(numbers).chain(depths).collect()
}

/// Where to look for numbers: as they are, a little off, and what a slip makes of them, a sign, two
/// exchanged, a double or a half.
fn starts(parameter: &Parameter, numbers: &[f64], steps: &[f64]) -> Vec<Vec<f64>> {
    let mut starts = vec![numbers.to_vec()];
    // A single number costs little: all within reach are tried.
    let far = match numbers.len() {
        1 => 10,
        _ => 3,
    };
    let mut with = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut other = numbers.to_vec();
        change(&mut other);
        if !starts.contains(&other) {
            starts.push(other);
        }
    };
    if let (["normal"], [x, y, z]) = (&parameter.fields[..], numbers) {
        for turn in 1..12 {
            let angle = std::f64::consts::FRAC_PI_6 * f64::from(turn);
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            with(&|other| *other = vec![cos * x + sin * z, *y, cos * z - sin * x]);
        }
    }
    if let ["roll" | "spin"] = parameter.fields[..] {
        (1..12).for_each(|i| with(&|other| other[0] += 30.0 * f64::from(i)));
    }
    for i in 0..numbers.len() {
        // A slip is made in one field.
        if parameter.fields.len() == 1 {
            with(&|other| other[i] = -other[i]);
            with(&|other| other[i] = 0.0);
            with(&|other| other[i] *= 2.0);
            with(&|other| other[i] *= 0.5);
            with(&|other| other.swap(i, (i + 1) % numbers.len()));
        }
        for by in 1..=far {
            with(&|other| other[i] += 3.0 * f64::from(by) * steps[i]);
            with(&|other| other[i] -= 3.0 * f64::from(by) * steps[i]);
        }
    }
    starts
}
