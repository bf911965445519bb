//! The plainest numbers that explain a picture as well as those that were fitted: the scene's own
//! where that is so, and else short ones.
//!
//! Whoever mistypes a scene changes one number of a vector, and to a short one. Among fits that are
//! equally good, that one is told which has most of the scene's own numbers, and then the fewest
//! digits.

use super::{
    candidate::{Candidate, Mistake},
    judge::{CELL_STEP, Judge, price},
    levenberg_marquardt::solve,
    parameters::Parameter,
};
use crate::{numbers::rounded, scene::Scene};

/// No edge moves by more than this part of a pixel for a shorter number, and by a quarter of it in
/// each round after that.
const TENTH: f64 = 0.1;
const QUARTERS: i32 = 5;

/// A number is not rounded further than it may be off itself: so many standard deviations.
const DEVIATIONS: f64 = 8.0;

/// So many sets of numbers of each size are tried to be the scene's own.
const LIKELIEST: usize = 2;

/// Rounds of fitting the other numbers where one is the scene's own.
const ROUNDS: usize = 8;

/// A candidate whose numbers are as plain as they can be.
pub fn plain(judge: &Judge, candidate: &Candidate) -> Candidate {
    let found = judge.judged(candidate, &judge.middle);
    let own = found.map(|found| with_own(judge, candidate, found.cost));
    shortened(judge, own.as_ref().unwrap_or(candidate))
}

/// The same with the scene's own numbers where it explains the picture as well with them.
fn with_own(judge: &Judge, candidate: &Candidate, cost: f64) -> Candidate {
    let (middle, scene) = (&judge.middle, judge.scene);
    let is_explained = judge.explains(candidate);
    for at in 0..candidate.mistakes.len() {
        let Mistake::Numbers(parameter, numbers) = &candidate.mistakes[at] else {
            continue;
        };
        if parameter.is_color() || parameter.fields[0] == "normal" {
            continue;
        }
        let own = parameter.numbers(scene);
        if own.len() < 2 {
            continue;
        }
        let sets = likeliest_sets(judge, candidate, at, &own);
        for fixed in sets {
            if !judge.work.may_go_on() {
                return candidate.clone();
            }
            let is_own = |i: &usize| numbers.get(*i) == own.get(*i);
            // Each time there are more of them.
            let are_more = fixed.len() > (0..own.len()).filter(is_own).count();
            if numbers.len() != own.len() || !are_more {
                continue;
            }
            let Some(other) = refitted(judge, candidate, at, parameter, &fixed) else {
                continue;
            };
            let Some(judged) = judge.judged(&other, middle) else {
                continue;
            };
            // What is not fitted does not cost.
            let free = price(middle, fixed.len());
            if judged.cost - free <= cost || is_explained && judge.explains(&other) {
                // From better numbers those may be found that could not be before.
                return with_own(judge, &narrowed(other, at, scene), cost.max(judged.cost));
            }
        }
    }
    candidate.clone()
}

/// The sets of numbers of a mistake that may be the scene's own, those first that leave fewest
/// free: all but one, all but two, and of an eye and what it looks at one of the two points. Of
/// each size the likeliest, to second order: with the covariances of a set's numbers, C, a fit is
/// worse by dᵀ C⁻¹ d where these change by d.
fn likeliest_sets(judge: &Judge, candidate: &Candidate, at: usize, own: &[f64]) -> Vec<Vec<usize>> {
    let count = own.len();
    let sizes: Vec<Vec<Vec<usize>>> = match count {
        6 => vec![vec![(3..6).collect(), (0..3).collect()]],
        _ => vec![
            (0..count)
                .map(|i| (0..count).filter(|j| *j != i).collect())
                .collect(),
            (0..count).map(|i| vec![i]).collect(),
        ],
    };
    let first = first_number(candidate, at);
    let numbers = candidate.numbers();
    let fitted = judge.fit(candidate, numbers.len(), &judge.middle, CELL_STEP, [0, 1]);
    let Some((_, fitted)) = fitted else {
        return Vec::new();
    };
    let worse = |set: &Vec<usize>| {
        let row = |i: &usize| -> Vec<f64> {
            let own = &fitted.covariances[first + i];
            set.iter().map(|j| own[first + j]).collect()
        };
        let change: Vec<f64> = set.iter().map(|&i| own[i] - numbers[first + i]).collect();
        let solved = solve(set.iter().map(row).collect(), change.clone());
        solved.map_or(f64::INFINITY, |solved| {
            change.iter().zip(solved).map(|(a, b)| a * b).sum()
        })
    };
    let likeliest = |mut sets: Vec<Vec<usize>>| {
        sets.sort_by(|one, other| worse(one).total_cmp(&worse(other)));
        sets.truncate(LIKELIEST);
        sets
    };
    sizes.into_iter().flat_map(likeliest).collect()
}

/// The place of the first number of a mistake among all of a candidate's.
fn first_number(candidate: &Candidate, at: usize) -> usize {
    let before = candidate.mistakes[..at].iter();
    let counts = before.map(|mistake| match mistake {
        Mistake::Numbers(_, numbers) => numbers.len(),
        _ => 0,
    });
    counts.sum()
}

/// The same, where some numbers of a mistake are the scene's, and the others are fitted anew.
fn refitted(
    judge: &Judge,
    candidate: &Candidate,
    at: usize,
    parameter: &Parameter,
    fixed: &[usize],
) -> Option<Candidate> {
    let own = parameter.numbers(judge.scene);
    let first = first_number(candidate, at);
    let all = candidate.numbers();
    let mut start = all.clone();
    fixed.iter().for_each(|&i| start[first + i] = own[i]);
    let free: Vec<usize> = (0..own.len())
        .filter(|i| !fixed.contains(i))
        .map(|i| first + i)
        .collect();
    judge.fit_some(
        &candidate.with_numbers(judge.scene, &start)?,
        &free,
        CELL_STEP,
        ROUNDS,
    )
}

/// The same, where a mistake of two points is one of that which is not the scene's own.
fn narrowed(candidate: Candidate, at: usize, scene: &Scene) -> Candidate {
    let mut mistakes = candidate.mistakes.clone();
    if let Mistake::Numbers(parameter, numbers) = &mut mistakes[at]
        && let [one, other] = parameter.fields[..]
    {
        let own = parameter.numbers(scene);
        let alone = |field| Parameter {
            owner: parameter.owner,
            fields: vec![field],
        };
        if numbers[3..] == own[3..] {
            mistakes[at] = Mistake::Numbers(alone(one), numbers[..3].to_vec());
        } else if numbers[..3] == own[..3] {
            mistakes[at] = Mistake::Numbers(alone(other), numbers[3..].to_vec());
        }
    }
    let with = |candidate: Candidate, mistake| candidate.with(mistake);
    let narrow = mistakes.into_iter().try_fold(Candidate::right(scene), with);
    narrow.unwrap_or(candidate)
}

/// A candidate whose numbers have as few digits as do.
pub fn shortened(judge: &Judge, candidate: &Candidate) -> Candidate {
    let middle = &judge.middle;
    let free = candidate.numbers().len();
    if free == 0 {
        return candidate.clone();
    }
    let leveled = candidate.with_numbers(judge.scene, &candidate.leveled_numbers());
    let Some(leveled) = leveled else {
        return candidate.clone();
    };
    let Some((_, fitted)) = judge.fit(&leveled, free, middle, CELL_STEP, [0, 1]) else {
        return leveled;
    };
    let Some(long) = judge.judged(&leveled, middle) else {
        return leveled;
    };
    // A number that is short was not fitted: it may cost what that costs.
    let most = long.cost + price(middle, free);
    let steps = leveled.steps(1.0);
    let rounded_to = |part: f64| {
        // What a vector's length may be off is no matter, so that no error is more than a part of a
        // step.
        let errors = fitted.errors.iter().zip(&steps);
        let errors = errors
            .map(|(error, step)| (part * step.abs()).max((DEVIATIONS * error).min(step.abs())));
        let numbers = leveled.numbers().into_iter().zip(errors);
        let numbers: Vec<f64> = numbers.map(|(x, error)| rounded(x, error)).collect();
        leveled.with_numbers(judge.scene, &numbers)
    };
    let is_as_good = |short: &Candidate| {
        let judged = judge.judged(short, middle);
        // Noise that is no chance, as that of a regular grid, may be fitted by a long number.
        judged.is_some_and(|judged| judged.cost <= most) || judge.explains(short)
    };
    let mut shorter =
        (0..QUARTERS).filter_map(|i| rounded_to(TENTH / libm::pow(4.0, f64::from(i))));
    shorter.find(is_as_good).unwrap_or(leveled)
}
