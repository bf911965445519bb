//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times.
//!
//! A coarse grid tells which mistakes are worth a look, and a tiny one before it which numbers are; a middle one fits numbers and judges all of them. What shows
//! only where colours meet is judged on the pixels.

use std::{collections::BTreeSet, sync::Arc};

use super::{
    candidate::{Candidate, Mistake, Shows},
    displacement::displaced,
    joint,
    judge::{CELL_STEP, Judge, Judged},
    levenberg_marquardt::absolute,
    light::{Curve, Look},
    mistakes::{OBJECT_ROWS, ROWS},
    numeric_mistakes::numeric_mistakes,
    objects::labels,
    patch::patch,
    plain_numbers::plain,
};
use crate::cancel::{self, Cancelled};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that leave least on the coarse grid.
const FINALISTS: usize = 3;

/// So many programs that behave otherwise are looked at on the coarse grid.
const BEHAVING: usize = 12;

/// Rows that turn the picture or mirror it.
const TURNS: [&str; 4] = ["mirrored", "upside_down", "turned_180", "up_negated"];

/// Rounds of fitting numbers to the middle grid, new ones from a fit to a coarser one, and earlier ones from this.
const ROUNDS: usize = 4;

/// So many objects are looked at, those in and beside which most is wrong.
const SUSPECTS: usize = 12;

/// A row about edges is told if the part that is seen of what it changes is that of one, to within
/// this, and so many standard deviations from none.
const PART: f64 = 0.3;
const SURE: f64 = 7.0;

/// Half a pixel is looked for where the picture lies no farther than this from it, in pixels.
const NEAR: f64 = 0.4;

/// Of rows that show in areas, a tiny grid has to show so many standard deviations and such a part
/// for them to be looked at where a picture is explained without.
const HINTED: f64 = 3.0;
const HINTED_PART: f64 = 0.3;

/// The mistakes that explain a picture, from what a program without mistakes would have made.
pub fn run(judge: &Judge) -> Result<Option<Judged>, Cancelled> {
    let right = Candidate::right(judge.scene);
    let Some(mut best) = judge.judged(&right, &judge.middle) else {
        return Ok(None);
    };
    let mut edges = explained_with(judge, &right);
    while edges.is_none()
        && best.candidate().mistakes.len() < MOST_MISTAKES
        && judge.work.may_go_on()
        && let Some(next) = step(judge, &best)
    {
        edges = explained_with(judge, next.candidate());
        best = next;
        // Numbers that are not the right ones leave a little, which others would seem to explain.
        if edges.is_none() && !best.candidate().numbers().is_empty() {
            let plain = plain(judge, best.candidate());
            edges = explained_with(judge, &plain);
            if let Some(plain) = judge.judged(&plain, &judge.middle) {
                best = plain;
            }
        }
    }
    let last = match edges {
        None => best.candidate().clone(),
        Some(row) => {
            let with_row = |candidate: &Candidate| match &row {
                Some(row) => candidate.with(row.clone()),
                None => Some(candidate.clone()),
            };
            let explains = |candidate: &Candidate| {
                with_row(candidate).is_some_and(|candidate| judge.explains(&candidate))
            };
            let fewest = judge
                .work
                .without_limit(|| fewest(judge, best.candidate(), &explains));
            let plainest = plain(judge, &fewest);
            let last = match explains(&plainest) {
                true => plainest,
                false => fewest,
            };
            with_row(&last).unwrap_or(last)
        }
    };
    let found = judge
        .work
        .without_limit(|| judge.judged(&last, &judge.edges));
    cancel::unless_set(judge.cancel, found)
}

/// What explains a picture beside a candidate: nothing, or a row that shows where colours meet;
/// none if it is not explained so.
fn explained_with(judge: &Judge, candidate: &Candidate) -> Option<Option<Mistake>> {
    // What is found so far is judged, however much work that is.
    let (are_areas_right, off, null) = judge.work.without_limit(|| {
        let are_areas_right = judge.explains_all(candidate);
        let off = displaced(judge, candidate);
        (are_areas_right, off, judge.judged(candidate, &judge.edges))
    });
    let null = null?;
    // Cut off bytes and another curve show in whole areas.
    let strays = judge.predicted(candidate, &judge.fine)?.strays();
    let is_much_wrong = strays.pixels.len() * 50 > judge.fine.grid.count();
    let predicted = judge.edges.predict(&null.rendering);
    judge.edges.compare_with(Arc::clone(&null.rendering));
    // What is done to light, or to a JPEG, makes other noise at edges.
    let mut looks = candidate.looks.iter();
    let may = looks.all(|look| matches!(look, Look::Channels(_)))
        && candidate.curve == Curve::Right
        && judge.fine.jpeg.is_none();
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges if row.id == "half_pixel" => may && off.is_some(),
        // What the faulty tracer makes is not known well enough at edges.
        Shows::AtEdges => may && are_areas_right && candidate.behaviour.is_right(),
        Shows::Everywhere => may && is_much_wrong,
    });
    let rows = rows.map(|row| Mistake::Row(row, None));
    let is_near = |with: &Candidate| {
        let (shift, by) = (with.shift(), off.map_or([0.0; 2], |off| off.by));
        shift == [0.0; 2] || (0..2).all(|i| (by[i] - shift[i]).abs() <= NEAR)
    };
    let is_explained = are_areas_right && off.is_none() && judge.is_even(candidate);
    let hinted = match is_explained && may && candidate.mistakes.is_empty() {
        true => hinted(judge, candidate),
        false => Vec::new(),
    };
    let told = |mistake: Mistake| {
        judge.work.may_go_on().then_some(())?;
        let with = candidate.with(mistake.clone())?;
        is_near(&with).then_some(())?;
        let rendering = judge.edges.render(&with, &judge.work)?;
        let [part, deviations] = predicted.part_seen(&null.score, &judge.edges.predict(&rendering));
        let is_told = (part - 1.0).abs() < PART && deviations > SURE;
        let is_told =
            is_told || matches!(mistake, Mistake::Row(row, _) if row.shows == Shows::Everywhere);
        (is_told && judge.explains(&with)).then_some((deviations, mistake))
    };
    let best = rows
        .chain(hinted)
        .filter_map(told)
        .max_by(|one, other| one.0.total_cmp(&other.0));
    match best {
        Some((_, row)) => Some(Some(row)),
        None => is_explained.then_some(None),
    }
}

/// Rows that change so little that a candidate explains a picture without them, and of which a tiny
/// grid shows a part: where all that is seen is a mixture, what is wrong may pass for noise.
fn hinted(judge: &Judge, candidate: &Candidate) -> Vec<Mistake> {
    let hinted = || {
        let tiny = judge.tiny(candidate)?;
        let null = judge.judged(candidate, &tiny)?;
        let predicted = tiny.predict(&null.rendering);
        let is_hinted = |mistake: &Mistake| {
            let with = candidate.with(mistake.clone())?;
            let rendering = tiny.render(&with, &judge.work)?;
            let [part, deviations] = predicted.part_seen(&null.score, &tiny.predict(&rendering));
            (part > HINTED_PART && deviations > HINTED).then_some(())
        };
        let all: Vec<usize> = (0..judge.scene.objects.len()).collect();
        let rows = rows_in_areas(&all);
        Some(rows.filter(|row| is_hinted(row).is_some()).collect())
    };
    hinted().unwrap_or_default()
}

/// The rows of the table that show in areas, those about an object of each of some objects.
fn rows_in_areas(objects: &[usize]) -> impl Iterator<Item = Mistake> {
    let rows = ROWS.iter().filter(|row| row.shows == Shows::InAreas);
    let of_objects = objects.iter().flat_map(|&object| {
        let rows = OBJECT_ROWS.iter();
        rows.map(move |row| Mistake::Row(row, Some(object)))
    });
    rows.map(|row| Mistake::Row(row, None)).chain(of_objects)
}

/// The same with as few mistakes as explain the picture.
fn fewest(judge: &Judge, all: &Candidate, explains: &dyn Fn(&Candidate) -> bool) -> Candidate {
    let of = |mistakes: &[&Mistake]| {
        let mut mistakes = mistakes.iter();
        let right = Candidate::right(judge.scene);
        mistakes.try_fold(right, |candidate, one| candidate.with((*one).clone()))
    };
    let mut fewest = all.clone();
    // Of several that turn the picture one may do.
    let is_turn = |mistake: &Mistake| TURNS.contains(&mistake.id());
    let (turns, others): (Vec<_>, Vec<_>) = all.mistakes.iter().partition(|one| is_turn(one));
    if turns.len() > 1 {
        let rows = ROWS.iter().filter(|row| TURNS.contains(&row.id));
        let rows: Vec<_> = rows.map(|row| Mistake::Row(row, None)).collect();
        let with = |row: &Mistake| of(&[&[row], &others[..]].concat());
        let mut simpler = of(&others).into_iter().chain(rows.iter().filter_map(with));
        fewest = simpler.find(explains).unwrap_or(fewest);
    }
    for left_out in (0..fewest.mistakes.len()).rev() {
        let mistakes = fewest.mistakes.iter().enumerate();
        let mistakes = mistakes.filter(|(at, _)| *at != left_out);
        let mistakes: Vec<_> = mistakes.map(|(_, mistake)| mistake).collect();
        let Some(fewer) = of(&mistakes) else {
            continue;
        };
        // What is left out may have made up for what numbers are off.
        let fitted = || {
            let fitted = judge.fit(
                &fewer,
                fewer.numbers().len(),
                &judge.middle,
                CELL_STEP,
                [0, ROUNDS],
            );
            fitted.map(|(candidate, _)| plain(judge, &candidate))
        };
        let fewer = match fewer.numbers().is_empty() || explains(&fewer) {
            true => Some(fewer.clone()),
            false => fitted(),
        };
        if let Some(fewer) = fewer.filter(explains) {
            fewest = fewer;
        }
    }
    fewest
}

/// The best candidate with one more mistake, if it is better.
fn step(judge: &Judge, from: &Judged) -> Option<Judged> {
    judge.compare_with(from.candidate());
    let suspects = suspects(judge, from);
    let mut tried = rows(judge, from, &suspects);
    // A row says more than numbers that make the same picture: where it explains all, they need not be looked for.
    let explaining = |tried: &[(f64, Candidate)]| {
        let row = tried.iter().min_by(|one, other| one.0.total_cmp(&other.0));
        let found = likelier(judge, from, &row?.1)?;
        (found.cost < from.cost && judge.explains(found.candidate())).then_some(found)
    };
    if let Some(found) = explaining(&tried) {
        return Some(found);
    }
    if from.candidate().mistakes.is_empty() {
        let together = joint::rows_together(judge, from.candidate());
        if let Some(found) = explaining(&together) {
            return Some(found);
        }
        tried.extend(together);
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
            if judge.explains(found.candidate()) {
                fewest = found.candidate().fitted();
            }
            judged.push(found);
        }
    }
    judged.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    // Where not all were tried, the best of them need not be the best of all; what explains all is.
    let are_all_tried = judge.work.may_go_on() && are_all_numbers_tried;
    let is_better = |best: &Judged| {
        best.cost < from.cost && (are_all_tried || judge.explains(best.candidate()))
    };
    // The few that were judged are looked at in all pixels, however much work that is.
    let better = judge
        .work
        .without_limit(|| judged.into_iter().find(is_better));
    // Something too many would explain anything; it is thought of where nothing else explains more than before.
    better.or_else(|| {
        are_all_tried.then_some(())?;
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
    let candidates = rows_in_areas(suspects);
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
