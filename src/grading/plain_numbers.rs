//! The plainest numbers that explain a picture as well as those that were fitted: the scene's own
//! where that is so, and else short ones.
//!
//! Whoever mistypes a scene changes one number of a vector, and to a short one. Among fits that are
//! equally good, that one is told which has most of the scene's own numbers, and then the fewest
//! digits.

use super::{
    candidate::{Candidate, Mistake},
    judge::{CELL_STEP, Judge, price},
    parameters::Parameter,
};
use crate::{numbers::rounded, scene::Scene};

/// No edge moves by more than this part of a pixel for a shorter number, and by a quarter of it in
/// each round after that.
const TENTH: f64 = 0.1;
const QUARTERS: i32 = 5;

/// A number is not rounded further than it may be off itself: so many standard deviations.
const DEVIATIONS: f64 = 8.0;

/// Rounds of fitting the other numbers where one is the scene's own.
const ROUNDS: usize = 8;

/// A candidate whose numbers are as plain as they can be.
pub fn plain(judge: &Judge, candidate: &Candidate) -> Candidate {
    let found = judge.judged(candidate, judge.fitting(candidate));
    let own = found.map(|found| with_own(judge, candidate, found.cost));
    shortened(judge, own.as_ref().unwrap_or(candidate))
}

/// The same with the scene's own numbers where it explains the picture as well with them.
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
            // What is not fitted does not cost.
            let gain = price(level, numbers.len() - free.len());
            let free: Vec<usize> = free.into_iter().map(|i| first + i).collect();
            let judged = || {
                let mut mistakes = candidate.mistakes.clone();
                mistakes[at] = Mistake::Numbers(parameter, numbers);
                let start = Candidate::of(scene, mistakes)?;
                let (fitted, _) = judge.fit(&start, &free, level, CELL_STEP, [0, ROUNDS])?;
                judge.judged(&fitted, level)
            };
            let Some(judged) = judged() else {
                continue;
            };
            let other = judged.candidate();
            if judged.cost - gain <= cost || is_explained && judge.explains(other) {
                // From better numbers those may be found that could not be before.
                return with_own(judge, other, cost.max(judged.cost));
            }
        }
        first += numbers.len();
    }
    candidate.clone()
}

/// Numbers of which more are the scene's own, and which of the others are free, those first that
/// leave fewest free: all but one are the scene's own, or all but two, and of an eye and what it
/// looks at one of the two points.
fn plainer(
    scene: &Scene,
    parameter: &Parameter,
    numbers: &[f64],
) -> Vec<(Parameter, Vec<f64>, Vec<usize>)> {
    let own = parameter.numbers(scene);
    match (&parameter.fields[..], own.len()) {
        // Of a direction no picture tells the length: it is such that one number is the scene's.
        (["normal" | "direction"], _) => {
            let is_scaled = (0..3).any(|i| numbers[i].abs() == own[i].abs() && own[i] != 0.0);
            let told = (0..3).filter(|&i| !is_scaled && numbers[i] * own[i] != 0.0);
            let scaled = told.map(|i| {
                let by = (own[i] / numbers[i]).abs();
                let scaled = numbers.iter().map(|x| by * x).collect();
                (
                    parameter.clone(),
                    scaled,
                    (0..3).filter(|&j| j != i).collect(),
                )
            });
            scaled.collect()
        }
        ([_, _], _) => {
            let fields = parameter.fields.iter().zip(numbers.chunks(3));
            let alone = fields.map(|(field, own)| {
                let (owner, fields) = (parameter.owner, vec![*field]);
                (Parameter { owner, fields }, own.to_vec(), vec![0, 1, 2])
            });
            alone.collect()
        }
        (_, 3) if !parameter.is_color() => {
            let are_own = (0..3).filter(|&i| numbers[i] == own[i]).count();
            let free = [
                vec![0],
                vec![1],
                vec![2],
                vec![1, 2],
                vec![0, 2],
                vec![0, 1],
            ];
            let fewer = free.into_iter().filter(|free| 3 - free.len() > are_own);
            let with = |free: Vec<usize>| {
                let mut mixed = own.clone();
                free.iter().for_each(|&i| mixed[i] = numbers[i]);
                (parameter.clone(), mixed, free)
            };
            fewer.map(with).collect()
        }
        _ => Vec::new(),
    }
}

/// A candidate whose numbers have as few digits as do.
pub fn shortened(judge: &Judge, candidate: &Candidate) -> Candidate {
    let level = judge.fitting(candidate);
    let free: Vec<usize> = (0..candidate.numbers().len()).collect();
    if free.is_empty() {
        return candidate.clone();
    }
    let Some((_, fitted)) = judge.fit(candidate, &free, level, CELL_STEP, [0, 1]) else {
        return candidate.clone();
    };
    let Some(long) = judge.judged(candidate, level) else {
        return candidate.clone();
    };
    // A number that is short was not fitted: it may cost what that costs.
    let most = long.cost + price(level, free.len());
    let steps = candidate.steps(1.0);
    let rounded_to = |part: f64| {
        // What a vector's length may be off is no matter, so that no error is more than a part of a
        // step.
        let errors = fitted.errors.iter().zip(&steps);
        let errors = errors
            .map(|(error, step)| (part * step.abs()).max((DEVIATIONS * error).min(step.abs())));
        let numbers = candidate.numbers().into_iter().zip(errors);
        let numbers: Vec<f64> = numbers.map(|(x, error)| rounded(x, error)).collect();
        candidate.with_numbers(judge.scene, &numbers)
    };
    let is_as_good = |short: &Candidate| {
        let judged = judge.judged(short, level);
        // Noise that is no chance, as that of a regular grid, may be fitted by a long number.
        judged.is_some_and(|judged| judged.cost <= most) || judge.explains(short)
    };
    let mut shorter =
        (0..QUARTERS).filter_map(|i| rounded_to(TENTH / libm::pow(4.0, f64::from(i))));
    shorter
        .find(is_as_good)
        .unwrap_or_else(|| candidate.clone())
}
