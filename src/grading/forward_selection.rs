//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times.
//!
//! A coarse grid tells which mistakes are worth a look, and a tiny one before it which numbers are; a middle one fits numbers and judges all of them. What shows
//! only where colours meet is judged on the pixels.

use std::sync::Arc;

use std::collections::BTreeSet;

use super::{
    candidate::{Candidate, Mistake, Shows},
    joint,
    judge::{Judge, Judged},
    levenberg_marquardt::absolute,
    light::Curve,
    mistakes::{OBJECT_ROWS, ROWS},
    numeric_mistakes::numeric_mistakes,
    objects::labels,
    parameters::Owner,
    patch::patch,
    plain_numbers::plain,
};
use crate::cancel::{self, Cancelled};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that leave least on the coarse grid.
const FINALISTS: usize = 3;

/// So many programs that behave otherwise are looked at on the coarse grid.
const BEHAVING: usize = 6;

/// Rounds of fitting numbers to the middle grid, new ones from a fit to a coarser one, and earlier ones from this.
const ROUNDS: usize = 4;

/// By how much of a cell numbers are varied on the middle grid.
pub const CELL_STEP: f64 = 0.25;

/// So many objects are looked at, those in and beside which most is wrong.
const SUSPECTS: usize = 12;

/// A sample in the middle of a pixel makes as little noise as two random ones; more than this come of several.
const MOST_TAKEN_FOR_ONE: f64 = 3.0;

/// The mistakes that explain a picture, from what a program without mistakes would have made.
pub fn run(judge: &Judge) -> Result<Option<Judged>, Cancelled> {
    let right = Candidate::right(judge.scene);
    let Some(mut best) = judge.judged(&right, &judge.middle) else {
        return Ok(None);
    };
    // That nothing is wrong for certain does not say that nothing is wrong: what moves by a pixel where all pixels show several colours is found by the likelihood
    // alone.
    let mut is_open = judge.explains_all(best.candidate());
    while best.candidate().mistakes.len() < MOST_MISTAKES
        && (is_open || !judge.is_explained(best.candidate()))
        && judge.work.may_go_on()
        && let Some(next) = step(judge, &best, is_open)
    {
        best = next;
        is_open = false;
    }
    let short = plain(judge, &best);
    let mut best = with_edges(judge, &short, None);
    // A shift by half a pixel may be taken for a camera that looks a little elsewhere.
    if let Some(found) = &best
        && let [Mistake::Numbers(parameter, _)] = found.candidate().mistakes.as_slice()
        && parameter.owner == Owner::Camera
    {
        let other = with_edges(judge, &right, found.score.samples);
        let other = other.filter(|other| judge.explains_all(other.candidate()));
        let both = best.into_iter().chain(other);
        best = both.min_by(|one, other| one.cost.total_cmp(&other.cost));
    }
    cancel::unless_set(judge.cancel, best)
}

/// A candidate, or the same with a row that shows only where colours meet, if that is better on the pixels. How many samples a pixel has may be known from
/// another candidate that explains the picture.
fn with_edges(judge: &Judge, candidate: &Candidate, samples: Option<f64>) -> Option<Judged> {
    // Where areas are not explained yet, that comes first. What is found so far is judged, however much work that is.
    let (is_open, null) = judge.work.without_limit(|| {
        let is_open = !judge.explains_all(candidate);
        (is_open, judge.judged(candidate, &judge.edges))
    });
    let null = null?;
    judge.edges.compare_with(Arc::clone(&null.rendering));
    // What is done to light, or to a JPEG, makes other noise at edges, of which too little is known to tell these. One sample is its own mean, wherever in a pixel it lies.
    let may =
        candidate.looks.is_empty() && candidate.curve == Curve::Right && judge.fine.jpeg.is_none();
    let is_one =
        (samples.or(null.score.samples)).is_some_and(|samples| samples < MOST_TAKEN_FOR_ONE);
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges => may && !is_one,
        Shows::Everywhere => may,
    });
    let best = rows
        .take_while(|_| judge.work.may_go_on())
        .filter_map(|row| candidate.with(Mistake::Row(row, None)))
        // Samples of the faulty tracer are too few to tell edges.
        .filter(|other| other.behaviour == candidate.behaviour)
        .filter_map(|candidate| judge.judged(&candidate, &judge.edges))
        .map(|found| (judge.gain(&judge.edges, &null, &found), found))
        .filter(|(gain, _)| *gain > 0.0)
        .filter(|(_, found)| !is_open || judge.explains_all(found.candidate()))
        .max_by(|one, other| one.0.total_cmp(&other.0));
    Some(best.map_or(null, |(_, found)| found))
}

/// The best candidate with one more mistake, if it is better.
fn step(judge: &Judge, from: &Judged, is_open: bool) -> Option<Judged> {
    judge.compare_with(from.candidate());
    let suspects = suspects(judge, from);
    let mut tried = rows(judge, from, &suspects);
    if from.candidate().mistakes.is_empty() && !is_open {
        tried.extend(joint::rows_together(judge, from.candidate()));
    }
    // A row says more than numbers that make the same picture: where it explains all, they need not be looked for.
    let row = tried.iter().min_by(|one, other| one.0.total_cmp(&other.0));
    if let Some((_, row)) = row
        && !is_open
        && let Some(found) = likelier(judge, from, row)
        && let Some(found) = refined(judge, found)
        && found.cost < from.cost
        && judge.explains_all(found.candidate())
    {
        return Some(found);
    }
    // Half of the work that is left is left for judging those that were tried.
    let are_all_numbers_tried = judge.work.within(0.5, || {
        tried.extend(numeric_mistakes(judge, from, &suspects));
        judge.work.may_go_on()
    });
    tried.sort_by(|one, other| one.0.total_cmp(&other.0));
    tried.truncate(FINALISTS);
    let unfitted = tried.iter().filter_map(|one| likelier(judge, from, &one.1));
    let mut unfitted: Vec<Judged> = unfitted.collect();
    unfitted.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    let mut judged: Vec<Judged> = Vec::new();
    // What explains all is taken to be beaten only by what has fewer numbers: more of them come nearer before all are fitted to the end.
    let mut fewest = usize::MAX;
    for found in unfitted {
        if found.candidate().fitted() < fewest
            && let Some(found) = refined(judge, found)
        {
            if !is_open && judge.explains_all(found.candidate()) {
                fewest = found.candidate().fitted();
            }
            judged.push(found);
        }
    }
    judged.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    // Where not all were tried, the best of them need not be the best of all; what explains all is.
    let are_all_tried = judge.work.may_go_on() && are_all_numbers_tried;
    let is_better = |best: &Judged| {
        let is_likelier = match is_open {
            true => judge.gain(&judge.middle, from, best) > 0.0,
            false => best.cost < from.cost,
        };
        is_likelier
            && (are_all_tried || judge.explains_all(best.candidate()))
            && judge.is_seen(best, from.candidate())
    };
    // The few that were judged are looked at in all pixels, however much work that is.
    let better = judge
        .work
        .without_limit(|| judged.into_iter().find(is_better));
    // Something too many would explain anything; it is thought of where nothing else explains more than before.
    better.or_else(|| {
        (!is_open && are_all_tried).then_some(())?;
        let patched = from.candidate().with(patch(judge, from)?)?;
        let found = judge.judged(&patched, &judge.middle)?;
        (found.cost < from.cost).then_some(found)
    })
}

/// A candidate judged; none if it is no likelier than what it is made from.
fn likelier(judge: &Judge, from: &Judged, candidate: &Candidate) -> Option<Judged> {
    let found = judge.judged(candidate, &judge.middle)?;
    (found.score.likelihood > from.score.likelihood).then_some(found)
}

/// A candidate that was judged, with its numbers fitted to the middle grid, and judged again.
fn refined(judge: &Judge, found: Judged) -> Option<Judged> {
    let candidate = found.candidate();
    let free = candidate.numbers().len();
    if free == 0 {
        return Some(found);
    }
    let middle = &judge.middle;
    let (fitted, _) = judge.fit(candidate, free, middle, CELL_STEP, [0, ROUNDS])?;
    judge.judged(&fitted, middle)
}

/// The rows of the table, and how much each leaves on the coarse grid.
fn rows(judge: &Judge, from: &Judged, suspects: &[usize]) -> Vec<(f64, Candidate)> {
    let rows = ROWS.iter().filter(|row| row.shows == Shows::InAreas);
    let rows = rows.map(|row| Mistake::Row(row, None));
    let of_objects = suspects.iter().flat_map(|&object| {
        let rows = OBJECT_ROWS.iter();
        rows.map(move |row| Mistake::Row(row, Some(object)))
    });
    let candidates = rows.chain(of_objects);
    let candidates = candidates.filter_map(|mistake| from.candidate().with(mistake));
    // What the faulty tracer makes takes most of the work: of that the tiny grid chooses.
    let behaviour = from.candidate().behaviour;
    let (mut all, behaving): (Vec<_>, Vec<_>) =
        candidates.partition(|candidate| candidate.behaviour == behaviour);
    if let Some(tiny) = judge.tiny(from.candidate()) {
        let left = |candidate: Candidate| {
            let differences = judge.differences(&candidate, &tiny)?;
            Some((absolute(&differences), candidate))
        };
        let mut ranked: Vec<_> = behaving.into_iter().filter_map(left).collect();
        ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
        ranked.truncate(BEHAVING);
        all.extend(ranked.into_iter().map(|(_, candidate)| candidate));
    }
    all.into_iter()
        .filter_map(|candidate| {
            let differences = judge.differences(&candidate, &judge.coarse)?;
            Some((absolute(&differences), candidate))
        })
        .collect()
}

/// The objects that may be wrong, those first in and beside which most is.
fn suspects(judge: &Judge, from: &Judged) -> Vec<usize> {
    let grid = &judge.middle.grid;
    let labels = labels(judge, from.candidate(), from.candidate().layout, grid);
    let mut wrong = vec![0.0; judge.scene.objects.len()];
    for (at, off) in from.score.off.iter().enumerate() {
        // An object that grew is wrong beside where it is seen.
        let near: BTreeSet<usize> = grid.around(at, 2).filter_map(|at| labels[at]).collect();
        near.into_iter()
            .for_each(|object| wrong[object] += libm::log1p(*off));
    }
    let mut suspects: Vec<_> = (0..wrong.len())
        .filter(|&object| wrong[object] > 0.0)
        .collect();
    suspects.sort_by(|&one, &other| wrong[other].total_cmp(&wrong[one]));
    suspects.truncate(SUSPECTS);
    suspects
}
