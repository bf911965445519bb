//! Finds the numbers of a scene whose change explains a picture best.
//!
//! Many starting values are compared with the picture on the coarsest grid. Starting from the best
//! of them, the numbers are fitted on this grid.

use std::collections::BTreeSet;

use glam::DVec3;

use super::judge::{CELL_STEP, Judge, JudgedCandidate, least};
use crate::{
    color::{Color, linear_to_srgb},
    grading::{
        hypotheses::{Candidate, Mistake, Owner, Parameter, parameters},
        scoring::{Level, Prediction},
    },
    scene::View,
};

/// Number of starting values from which a field of the scene is fitted on the coarsest grid. The
/// starting values with the least difference from the picture are used. With more of them, the fit
/// takes longer, but ends less often in a wrong minimum.
const STARTS: usize = 2;

/// Number of fields of the scene that are fitted on the coarsest grid. The fields whose starting
/// values lead to the least difference from the picture are chosen. A larger number takes longer.
const STARTED: usize = 12;

/// Maximum number of objects that are suspected to be wrong. The objects with the largest errors in
/// their pixels and the pixels beside them are chosen. The work of a search grows with this number.
const MAX_SUSPECTS: usize = 12;

/// Threshold below which an object is not suspected to be wrong: the error of the object's pixels
/// and their neighbours, divided by that of the worst object. Smaller errors are mostly noise.
const SUSPECT_RATIO: f64 = 0.03;

/// Factors by which a number is multiplied by typical slips: a wrong sign, doubling, halving, and a
/// forgotten or moved decimal point.
pub const SLIPS: [f64; 5] = [-1.0, 2.0, 0.5, 10.0, 0.1];

/// Extends a hypothesis by one field of the scene with wrong numbers, which are fitted on the
/// coarsest grid, `tiny`. Returns the extended hypotheses with their differences from the picture
/// on this grid.
pub fn numeric_mistakes(
    judge: &Judge,
    from: &JudgedCandidate,
    suspects: &[usize],
    tiny: &Level,
) -> Vec<(f64, Candidate)> {
    let candidate = from.candidate();
    let all = suspected(candidate, suspects).into_iter();
    let prediction = judge.middle.predict(&from.rendering);
    let started = all.filter_map(|parameter| {
        let numbers = parameter.numbers(&candidate.scene);
        let starts = if parameter.is_color() {
            vec![colors(&numbers, &prediction)]
        } else {
            let pixels = f64::from(judge.coarse.grid.factor) / 2.0;
            let steps = parameter.steps(&candidate.scene, pixels);
            match parameter.fields[..] {
                ["near" | "far"] => planes(judge, numbers),
                _ => starts(&parameter, &numbers, &steps),
            }
        };
        let tried = starts.into_iter().filter_map(|start| {
            let started = candidate.with(Mistake::Numbers(parameter.clone(), start))?;
            judge.with_difference(started, tiny)
        });
        let tried = least(tried, STARTS);
        Some((tried.first()?.0, (parameter, tried)))
    });
    let started = least(started, STARTED).into_iter();
    let fitted = started.filter_map(|(_, (parameter, tried))| {
        let fit = |(left, start): (f64, Candidate)| {
            // A colour was read from the picture, so it is not fitted. It is fitted only if the
            // program changes light.
            if parameter.is_color() && candidate.effects.is_empty() {
                return Some((left, start));
            }
            judge.fit_last(candidate, &start, tiny, 0.5, [4, 0])
        };
        least(tried.into_iter().filter_map(fit), 1).pop()
    });
    fitted.collect()
}

/// Number of fields of the scene whose fit is continued after the first round. In the first round,
/// [`slightly_wrong`] fits every field that may be wrong. Then only the fields with the least
/// remaining difference from the picture are fitted further. A larger number takes longer.
const NEAR_OWN: usize = 3;

/// Fits each field of the camera and of checkerboards, starting from its present numbers, if the
/// field may be wrong. Colours are not fitted. Returns the few best hypotheses that are closer to
/// the picture than `candidate`.
///
/// This function is needed if a checkerboard with small squares fills most of the picture. Other
/// fits use the coarsest grid, `tiny`, with few samples per cell. They fail, because even a small
/// movement of the board changes the colours of most samples. Therefore, this function uses the
/// next finer grid, `coarse`, which is rendered exactly.
pub fn slightly_wrong(judge: &Judge, candidate: &Candidate, suspects: &[usize]) -> Vec<Candidate> {
    let level = &judge.coarse;
    let Some((difference, _)) = judge.with_difference(candidate.clone(), level) else {
        return Vec::new();
    };
    let fit = |start: &Candidate, rounds: [usize; 2]| {
        let found = judge.fit_last(candidate, start, level, CELL_STEP, rounds);
        found.filter(|found| found.0 < difference)
    };
    let mut all = suspected(candidate, suspects);
    all.retain(|parameter| match parameter.owner {
        Owner::Camera => true,
        Owner::Object(object) => is_board(candidate, object) && !parameter.is_color(),
        Owner::Image => false,
    });
    let once = all.into_iter().filter_map(|parameter| {
        let numbers = parameter.numbers(&candidate.scene);
        let start = candidate.with(Mistake::Numbers(parameter, numbers))?;
        fit(&start, [1, 0])
    });
    let best = least(once, NEAR_OWN).into_iter();
    let best = best.filter_map(|(_, one)| fit(&one, [3, 1]));
    let best = least(best, NEAR_OWN).into_iter();
    best.map(|(_, one)| one).collect()
}

/// Returns the indices of the objects that may be wrong, the one with the largest error first.
pub fn suspects(judge: &Judge, from: &JudgedCandidate) -> Vec<usize> {
    let grid = &judge.middle.grid;
    let labels = judge.labels(from.candidate(), from.candidate().layout, grid);
    let mut wrong = vec![0.0; judge.scene.objects.len()];
    for (at, off) in from.score.chi_squares.iter().enumerate() {
        // If an object is larger than the hypothesis says, it causes errors beside the cells in
        // which the hypothesis shows it. So the error of a cell is attributed to all objects near
        // the cell.
        let near: BTreeSet<usize> = grid.around(at, 2).filter_map(|at| labels[at]).collect();
        near.into_iter()
            .for_each(|object| wrong[object] += libm::log1p(*off));
    }
    let most = wrong.iter().copied().fold(0.0, f64::max);
    let wrong = (0..).zip(wrong);
    let wrong = wrong.filter(|(_, wrong)| *wrong > SUSPECT_RATIO * most);
    let suspects = least(wrong.map(|(object, wrong)| (-wrong, object)), MAX_SUSPECTS);
    suspects.into_iter().map(|(_, object)| object).collect()
}

/// Returns whether an object is a checkerboard.
fn is_board(candidate: &Candidate, object: usize) -> bool {
    candidate.scene.objects[object].shape.center().is_none()
}

/// Returns the fields of a hypothesis's scene that may be wrong, except those among its mistakes.
fn suspected(candidate: &Candidate, suspects: &[usize]) -> Vec<Parameter> {
    let is_suspect = |parameter: &Parameter| match parameter.owner {
        Owner::Object(object) => suspects.iter().any(|&suspect| {
            let [own, other] = [object, suspect].map(|index| &candidate.scene.objects[index]);
            object == suspect || own.is_beside(other)
        }),
        // A wrong camera moves all objects. So the camera is not suspected if only one of several
        // objects is suspected. There are two exceptions. If this object is a checkerboard, it may
        // fill most of the picture. And the near and far planes are always suspected, because they
        // may cut off a single object.
        Owner::Camera if !matches!(parameter.fields[0], "near" | "far") => match suspects {
            [sole] if candidate.scene.objects.len() > 1 => is_board(candidate, *sole),
            _ => true,
        },
        _ => true,
    };
    let is_named = |parameter: &Parameter| candidate.numeric().any(|(own, _)| own == parameter);
    let mut all = parameters::fittable(&candidate.scene);
    all.retain(|parameter| is_suspect(parameter) && !is_named(parameter));
    all
}

/// Returns for each given colour the colour that the picture shows instead. This is the median over
/// the pixels that should show only the given colour. If there are none, the given colour is
/// returned. `numbers` contains three channels for each given colour, from 0 to 255.
fn colors(numbers: &[f64], prediction: &Prediction) -> Vec<f64> {
    let color = |own: &[f64; 3]| {
        let light = DVec3::from(Color { srgb: *own }.to_linear());
        let moments = &prediction.moments;
        let is_alone =
            |at: &usize| moments.mean[*at] == light && moments.variance[*at] == DVec3::ZERO;
        let seen = (0..prediction.observed.len())
            .filter(is_alone)
            .map(|at| prediction.observed[at]);
        let mut seen: Vec<DVec3> = seen.filter(|seen| !seen.x.is_nan()).collect();
        let mut median = |i: usize| {
            seen.sort_by(|one, other| one[i].total_cmp(&other[i]));
            let middle = seen.get(seen.len() / 2)?;
            // Rounding to 1/1024 of an 8-bit step removes the rounding errors of the conversions,
            // so that integers are exact.
            Some((255.0 * linear_to_srgb(middle[i]) * 1024.0).round() / 1024.0)
        };
        [0, 1, 2].map(|i| median(i).unwrap_or(own[i]))
    };
    let (colors, _) = numbers.as_chunks();
    colors.iter().flat_map(color).collect()
}

/// Returns starting values for the depth of the near or far plane: its present depth, and a series
/// of depths around a reference distance. Each depth is 1.2 times the one before. The reference
/// distance is that from the eye to the point that the camera looks at. If there is no such point,
/// the distance to the origin is used, but at least 1 m.
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

/// Returns starting values for a field's numbers: the scene's own numbers, other numbers near them,
/// and the results of typical slips, such as a wrong sign or two exchanged numbers.
fn starts(parameter: &Parameter, numbers: &[f64], steps: &[f64]) -> Vec<Vec<f64>> {
    let mut starts = vec![numbers.to_vec()];
    // A single number has fewer starting values than a vector, so these may cover a wider range.
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
        // Slips are tried in single fields only, not in `eye` and `lookat` together.
        if parameter.fields.len() == 1 {
            for by in SLIPS {
                with(&|other| other[i] *= by);
            }
            with(&|other| other[i] = 0.0);
            with(&|other| other.swap(i, (i + 1) % numbers.len()));
        }
        for by in 1..=far {
            with(&|other| other[i] += 3.0 * f64::from(by) * steps[i]);
            with(&|other| other[i] -= 3.0 * f64::from(by) * steps[i]);
        }
    }
    starts
}
