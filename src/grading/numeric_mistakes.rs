//! Finds which numbers of a scene, changed, explain a picture best.
//!
//! A start on the tiny grid leads to a fit there, and that to one on the coarse grid.

use super::{
    candidate::{Candidate, Mistake},
    judge::{Judge, Judged},
    level::Level,
    levenberg_marquardt::absolute,
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
const STARTED: usize = 20;

/// What leaves so many times as much as the best on the tiny grid is not fitted on the coarse one.
const FAR: f64 = 2.0;

/// So many parameters of objects and so many others are fitted on the coarse grid.
const FITTED: usize = 4;

/// Some numbers of the scene, each with what comes nearest on the coarse grid: those that leave
/// least on the tiny one.
pub fn numeric_mistakes(judge: &Judge, from: &Judged, suspects: &[usize]) -> Vec<(f64, Candidate)> {
    let candidate = from.candidate();
    let Some(tiny) = judge.tiny(candidate) else {
        return Vec::new();
    };
    let is_suspect = |parameter: &Parameter| match parameter.owner {
        Owner::Object(object) => suspects.iter().any(|&suspect| {
            let [own, other] = [object, suspect].map(|index| &candidate.scene.objects[index]);
            object == suspect || own.is_beside(other)
        }),
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
            Some((absolute(&judge.differences(&started, &tiny)?), started))
        });
        let mut tried: Vec<_> = tried.collect();
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        tried.truncate(STARTS);
        Some((tried.first()?.0, (parameter, tried)))
    });
    let fit = |parameter: &Parameter, start: &Candidate, level: &Level, rounds| {
        // Colours are read, but where something is done to them.
        let is_read = parameter.is_color() && candidate.looks.is_empty();
        let free = parameter.numbers(&candidate.scene).len();
        let rounds = if is_read { [0, 0] } else { rounds };
        let (candidate, fitted) = judge.fit(start, free, level, 0.5, rounds)?;
        Some((fitted.left, candidate))
    };
    // Those first that start best: work may end before all are fitted.
    let on_tiny = least_first(started)
        .take(STARTED)
        .filter_map(|(parameter, tried)| {
            let fitted = tried.iter();
            let fitted = fitted.filter_map(|one| fit(&parameter, &one.1, &tiny, [4, 0]));
            let (left, best) = fitted.min_by(|one, other| one.0.total_cmp(&other.0))?;
            Some((left, (parameter, best)))
        });
    let (local, others): (Vec<_>, Vec<_>) =
        on_tiny.partition(|(_, (parameter, _))| parameter.is_local(&candidate.scene));
    let on_coarse = [local, others].into_iter().flat_map(|mut fitted| {
        fitted.sort_by(|one, other| one.0.total_cmp(&other.0));
        fitted.truncate(FITTED);
        let most = FAR * fitted.first().map_or(0.0, |best| best.0);
        fitted.retain(|one| one.0 <= most);
        fitted
    });
    least_first(on_coarse)
        .filter_map(|(parameter, start)| fit(&parameter, &start, &judge.coarse, [2, 1]))
        .collect()
}

/// Those first of which least is left.
fn least_first<T>(all: impl Iterator<Item = (f64, T)>) -> impl Iterator<Item = T> {
    let mut all: Vec<(f64, T)> = all.collect();
    all.sort_by(|one, other| one.0.total_cmp(&other.0));
    all.into_iter().map(|(_, one)| one)
}

/// The colours that a picture has where these colours alone should be seen: the medians of their
/// channels.
fn colors(numbers: &[f64], shown: &Prediction) -> Vec<f64> {
    let color = |own: &[f64]| {
        let light = Color {
            srgb: [own[0], own[1], own[2]],
        }
        .to_linear();
        let moments = &shown.moments;
        let is_alone = |at: &usize| moments.mean[*at] == light && moments.variance[*at] == [0.0; 3];
        let seen = (0..shown.seen.len())
            .filter(is_alone)
            .map(|at| shown.seen[at]);
        let mut seen: Vec<[f64; 3]> = seen.filter(|seen| !seen[0].is_nan()).collect();
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
        with(&|other| other[i] = -other[i]);
        with(&|other| other[i] = 0.0);
        with(&|other| other[i] *= 2.0);
        with(&|other| other[i] *= 0.5);
        with(&|other| other.swap(i, (i + 1) % numbers.len()));
        for by in 1..=far {
            with(&|other| other[i] += 3.0 * f64::from(by) * steps[i]);
            with(&|other| other[i] -= 3.0 * f64::from(by) * steps[i]);
        }
    }
    starts
}
