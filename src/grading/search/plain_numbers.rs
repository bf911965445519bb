//! Simplifies fitted numbers. They become the scene's own numbers, or results of a slip of the
//! hand, if these explain the picture as well, and otherwise get fewer digits.
//!
//! Somebody who mistypes a scene usually changes one number of a vector, and writes a short number.
//! So among equally good fits, those that change the fewest of the scene's numbers are preferred.
//! Of these, the one whose numbers have the fewest digits is chosen.

use super::{
    judge::{CELL_STEP, Judge, price},
    numeric_mistakes::SLIPS,
};
use crate::{
    grading::hypotheses::{Candidate, Mistake, Parameter},
    numbers::rounded,
    scene::Scene,
};

/// Maximum displacement of an edge, in pixels, that rounding a number may cause in the first round
/// of attempts. Each further round allows less, so numbers become longer. With a larger value,
/// shorter numbers are tried first, but more of them are rejected.
const TENTH: f64 = 0.1;
/// Maximum number of rounds of rounding. Each round allows a quarter of the displacement of the
/// round before. The fifth allows 0.0004 pixels, so more rounds would hardly change a picture.
const QUARTERS: i32 = 5;

/// Number of standard deviations of a fitted number by which rounding may change it. The value may
/// be generous, because a test of the rounded numbers follows.
const DEVIATIONS: f64 = 8.0;

/// Maximum number of rounds of fitting the other numbers, after one number was replaced by the
/// scene's own number. More rounds take longer; with fewer, the other numbers may not reach their
/// best values.
const ROUNDS: usize = 8;

/// Returns a hypothesis with simplified numbers.
pub fn plain(judge: &Judge, candidate: &Candidate) -> Candidate {
    let found = judge.judged(candidate, judge.fitting(candidate));
    let own = found.map(|found| with_own(judge, candidate, found.cost));
    let own = own.unwrap_or_else(|| candidate.clone());
    shortened(judge, &own).unwrap_or(own)
}

/// Replaces fitted numbers by the scene's own if the picture is then explained equally well.
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
            // A number that is not fitted has no price, so the cost is reduced by the prices of the
            // numbers that become the scene's own.
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
                // Replacements that failed before may succeed from the new numbers, so all are
                // tried again.
                return with_own(judge, other, cost.max(judged.cost));
            }
        }
        first += numbers.len();
    }
    candidate.clone()
}

/// Returns variants of a field's wrong numbers, in which some are replaced by the numbers of the
/// correct scene. The other numbers are free, i.e. may be fitted again. In a vector, one or two
/// coordinates are free. In `eye` and `lookat` together, one point is free. Each variant comes with
/// the indices of its free numbers.
///
/// Variants with few free numbers come first. The very first ones have no free number: they are the
/// numbers of the correct scene, one of which is changed by a slip of the hand.
fn plainer(
    scene: &Scene,
    parameter: &Parameter,
    numbers: &[f64],
) -> Vec<(Parameter, Vec<f64>, Vec<usize>)> {
    let own = parameter.numbers(scene);
    let fewer = match (&parameter.fields[..], own.len()) {
        // A picture does not determine the length of a direction, so the direction is scaled until
        // one coordinate is the scene's own.
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

/// Returns variants of the scene's numbers in which one number is changed by a slip of the hand.
/// Leaves out variants whose picture is shifted by a pixel or more from the picture that `numbers`
/// make.
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

/// Rounds a hypothesis's numbers to as few digits as possible. Returns `None` if no rounding
/// explains the picture as well, or if the budget of work is used up.
pub fn shortened(judge: &Judge, candidate: &Candidate) -> Option<Candidate> {
    let level = judge.fitting(candidate);
    let (_, fitted) = judge.fit_all(candidate, level, [0, 1])?;
    let long = judge.judged(candidate, level)?;
    // A shortened number is not treated as fitted, so it should have no price. But `judged`
    // includes the prices of all numbers in the cost of a hypothesis. So these prices are added to
    // the limit of the cost.
    let most = long.cost + price(level, fitted.numbers.len());
    let steps = candidate.steps(1.0);
    let rounded_to = |part: f64| {
        // The picture may hardly depend on a number, such as the length of a vector. The number's
        // standard deviation is then arbitrarily large, so it is limited to the change that moves
        // the picture by a pixel.
        let errors = fitted.errors.iter().zip(&steps);
        let errors = errors
            .map(|(error, step)| (part * step.abs()).max((DEVIATIONS * error).min(step.abs())));
        let numbers = candidate.numbers().into_iter().zip(errors);
        let numbers: Vec<f64> = numbers.map(|(x, error)| rounded(x, error)).collect();
        candidate.with_numbers(judge.scene, &numbers)
    };
    let is_as_good = |short: &Candidate| {
        let judged = judge.judged(short, level);
        // Noise with a structure, such as that of a regular grid of samples, may be fitted only by
        // long numbers. So short numbers are accepted even at a higher cost, if they explain the
        // picture.
        judged.is_some_and(|judged| judged.cost <= most) || judge.explains(short)
    };
    let mut shorter =
        (0..QUARTERS).filter_map(|i| rounded_to(TENTH / libm::pow(4.0, f64::from(i))));
    shorter.find(is_as_good)
}
