//! Simplifies fitted numbers. They are replaced by the scene's own numbers, or by results of a
//! typical slip, if these explain the picture equally well. Otherwise, they are rounded to fewer
//! digits.
//!
//! Somebody who mistypes a scene usually mistypes one number of a vector, and writes a short
//! number. So among equally good fits, the one that changes the fewest numbers of the scene is
//! preferred and, among these, the one with the fewest digits.

use super::{
    judge::{CELL_STEP, Judge, price},
    numeric_mistakes::SLIPS,
};
use crate::{
    grading::hypotheses::{Candidate, Mistake, Parameter},
    numbers::rounded,
    scene::Scene,
};

/// Maximum displacement of an edge, in pixels, that rounding a number may cause in the first round.
/// Each further round allows less, so numbers get more digits. With a larger value, shorter numbers
/// are tried first, but more of them are rejected.
const TENTH: f64 = 0.1;
/// Maximum number of rounds in which rounding is tried. Each round allows a quarter of the
/// displacement of the round before. The fifth round allows 0.0004 pixels, so more rounds would
/// hardly change a picture.
const QUARTERS: i32 = 5;

/// Number of standard deviations by which rounding may change a fitted number. The value may be
/// large, because the rounded numbers are tested afterwards.
const DEVIATIONS: f64 = 8.0;

/// Maximum number of rounds in which the other numbers are fitted after one number was replaced by
/// the scene's own. More rounds take longer. With fewer, the other numbers may not reach their best
/// values.
const ROUNDS: usize = 8;

/// Returns a hypothesis with simplified numbers.
pub fn plain(judge: &Judge, candidate: &Candidate) -> Candidate {
    let found = judge.judged(candidate, judge.fitting(candidate));
    let own = found.map(|found| with_own(judge, candidate, found.cost));
    let own = own.unwrap_or_else(|| candidate.clone());
    shortened(judge, &own).unwrap_or(own)
}

/// Replaces fitted numbers by the scene's own, as long as the picture is explained equally well.
fn with_own(judge: &Judge, candidate: &Candidate, cost: f64) -> Candidate {
    let (level, scene) = (judge.fitting(candidate), judge.scene);
    let is_explained = judge.explains(candidate);
    let mut first = 0;
    for (at, mistake) in candidate.mistakes.iter().enumerate() {
        let Mistake::Numbers(parameter, numbers) = mistake else {
            continue;
        };
        for (parameter, numbers, free) in plainer(scene, parameter, numbers) {
            if !judge.work.may_go_on() {
                return candidate.clone();
            }
            // The cost contains a penalty ([`price`]) for each fitted number. Numbers that become
            // the scene's own are not fitted, so their penalties are subtracted.
            let gain = price(level, numbers.len() - free.len());
            let free: Vec<usize> = free.into_iter().map(|i| first + i).collect();
            let judged = || {
                let mut mistakes = candidate.mistakes.clone();
                mistakes[at] = Mistake::Numbers(parameter, numbers);
                let start = Candidate::of(scene, mistakes)?;
                if free.is_empty() {
                    return judge.judged(&start, level);
                }
                let (fitted, _) = judge.fit(&start, &free, level, CELL_STEP, [0, ROUNDS])?;
                judge.judged(&fitted, level)
            };
            let Some(judged) = judged() else {
                continue;
            };
            let other = judged.candidate();
            if judged.cost - gain <= cost || is_explained && judge.explains(other) {
                // After this replacement, others that failed before may succeed, so all are tried
                // again.
                return with_own(judge, other, cost.max(judged.cost));
            }
        }
        first += numbers.len();
    }
    candidate.clone()
}

/// Returns variants of a field's wrong numbers, in which some numbers are replaced by those of the
/// correct scene. The other numbers are free, i.e. may be fitted again. In a vector, one or two
/// coordinates are free. If `eye` and `lookat` are wrong together, one of the two points is free.
/// Each variant comes with the indices of its free numbers.
///
/// Variants with few free numbers come first. The first variants have no free number: in the
/// numbers of the correct scene, one is changed by a typical slip.
fn plainer(
    scene: &Scene,
    parameter: &Parameter,
    numbers: &[f64],
) -> Vec<(Parameter, Vec<f64>, Vec<usize>)> {
    let own = parameter.numbers(scene);
    let fewer = match (&parameter.fields[..], own.len()) {
        // The length of a direction does not affect the picture. So the direction is scaled until
        // one coordinate equals the scene's own.
        (["normal" | "direction"], _) => {
            let is_scaled = (0..3).any(|i| numbers[i].abs() == own[i].abs() && own[i] != 0.0);
            let nonzero = (0..3).filter(|&i| !is_scaled && numbers[i] * own[i] != 0.0);
            let scaled = nonzero.map(|i| {
                let by = (own[i] / numbers[i]).abs();
                let scaled = numbers.iter().map(|x| by * x).collect();
                let free = (0..3).filter(|&j| j != i).collect();
                (parameter.clone(), scaled, free)
            });
            scaled.collect()
        }
        ([_, _], _) => {
            let fields = parameter.fields.iter().zip(numbers.chunks(3));
            let alone = fields.map(|(field, own)| {
                let point = Parameter::new(parameter.owner, &[*field]);
                (point, own.to_vec(), vec![0, 1, 2])
            });
            alone.collect()
        }
        (_, 3) if !parameter.is_color() => {
            let are_own = (0..3).filter(|&i| numbers[i] == own[i]).count();
            let free: [&[usize]; 6] = [&[0], &[1], &[2], &[1, 2], &[0, 2], &[0, 1]];
            let fewer = free.into_iter().filter(|free| 3 - free.len() > are_own);
            let with = |free: &[usize]| {
                let mut mixed = own.clone();
                free.iter().for_each(|&i| mixed[i] = numbers[i]);
                (parameter.clone(), mixed, free.to_vec())
            };
            fewer.map(with).collect()
        }
        _ => Vec::new(),
    };
    [slips(scene, parameter, numbers), fewer].concat()
}

/// Returns variants of the scene's numbers in which one number is changed by a typical slip
/// ([`SLIPS`]). Only variants are returned whose picture is shifted by less than a pixel from the
/// picture for `numbers`.
fn slips(
    scene: &Scene,
    parameter: &Parameter,
    numbers: &[f64],
) -> Vec<(Parameter, Vec<f64>, Vec<usize>)> {
    let own = parameter.numbers(scene);
    let steps = parameter
        .put(scene, numbers)
        .map(|wrong| parameter.steps(&wrong, 1.0));
    let Some(steps) = steps.filter(|_| parameter.fields.len() == 1 && !parameter.is_color()) else {
        return Vec::new();
    };
    let changed = (0..own.len()).flat_map(|i| {
        SLIPS.map(|by| {
            let mut changed = own.clone();
            changed[i] *= by;
            changed
        })
    });
    let is_near = |changed: &Vec<f64>| {
        let off = changed.iter().zip(numbers).zip(&steps);
        changed != numbers
            && off
                .into_iter()
                .all(|((one, other), step)| (one - other).abs() < step.abs())
    };
    changed
        .filter(is_near)
        .map(|changed| (parameter.clone(), changed, Vec::new()))
        .collect()
}

/// Rounds a hypothesis's numbers to as few digits as possible. Returns `None` if no rounded numbers
/// explain the picture equally well, or if the budget of work is used up.
pub fn shortened(judge: &Judge, candidate: &Candidate) -> Option<Candidate> {
    let level = judge.fitting(candidate);
    let (_, fitted) = judge.fit_all(candidate, level, [0, 1])?;
    let long = judge.judged(candidate, level)?;
    // A rounded number is not treated as fitted, so the cost should contain no penalty for it. But
    // `judged` adds the penalties ([`price`]) of all numbers to the cost. So these penalties are
    // added to the limit as well.
    let most = long.cost + price(level, fitted.numbers.len());
    let steps = candidate.steps(1.0);
    let rounded_to = |part: f64| {
        // If the picture hardly depends on a number, such as the length of a vector, the number's
        // standard deviation is very large. So it is limited to the change that moves the picture
        // by a pixel.
        let errors = fitted.errors.iter().zip(&steps);
        let errors = errors
            .map(|(error, step)| (part * step.abs()).max((DEVIATIONS * error).min(step.abs())));
        let numbers = candidate.numbers().into_iter().zip(errors);
        let numbers: Vec<f64> = numbers.map(|(x, error)| rounded(x, error)).collect();
        candidate.with_numbers(judge.scene, &numbers)
    };
    let is_as_good = |short: &Candidate| {
        let judged = judge.judged(short, level);
        // Noise with a structure, such as that of a regular grid of samples, may be fitted best by
        // long numbers. So short numbers that explain the picture are accepted even if their cost
        // is higher.
        judged.is_some_and(|judged| judged.cost <= most) || judge.explains(short)
    };
    let mut shorter =
        (0..QUARTERS).filter_map(|i| rounded_to(TENTH / libm::pow(4.0, f64::from(i))));
    shorter.find(is_as_good)
}
