//! Forward selection: the mistake that explains most, then the table once more on what is left, at
//! most four times; and where that leads nowhere, the next best in its place.
//!
//! A coarse grid tells which mistakes are worth a look, and a tiny one before it which numbers are;
//! a middle one fits numbers and judges all of them. What shows only where colours meet is judged
//! on the pixels.

use std::{collections::BTreeSet, sync::Arc};

use super::{
    candidate::{Candidate, Mistake, Row, Shows},
    displacement::Edges,
    joint,
    judge::{CELL_STEP, Judge, Judged},
    levenberg_marquardt::absolute,
    mistakes::{OBJECT_ROWS, ROWS},
    numeric_mistakes::numeric_mistakes,
    objects::labels,
    patch::patch,
    plain_numbers::{plain, shortened},
};
use crate::cancel::{self, Cancelled};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that leave least on the coarse grid.
const FINALISTS: usize = 4;

/// So many programs that behave otherwise are looked at on the coarse grid.
const BEHAVING: usize = 12;

/// Rows that turn the picture or mirror it.
const TURNS: [&str; 4] = ["mirrored", "upside_down", "turned_180", "up_negated"];

/// Rounds of fitting numbers to the middle grid, new ones from a fit to a coarser one, and earlier
/// ones from this.
const ROUNDS: usize = 4;

/// So many objects are looked at, those in and beside which most is wrong.
const SUSPECTS: usize = 12;

/// A row about edges is told if the part that is seen of what it changes is that of one, to within
/// this, and so many standard deviations from none; in a JPEG, if it leaves less than such a part
/// of the squared difference.
const PART: f64 = 0.3;
const SURE: f64 = 7.0;
const LEFT_IN_CODED: f64 = 0.25;

/// Ids of the rows that move what is seen by pixels or parts of them.
const PIXELS: [&str; 2] = ["half_pixel", "window_one_less"];

/// Id of the only row about edges that can be told from a JPEG.
const IN_CODED: &str = "averaged_encoded";

/// Factors of the width that edges tell, of which the likeliest is taken.
const WIDTHS: [f64; 4] = [0.7, 0.8, 0.9, 1.0];
/// Least width of a pixel that is called wide.
const LEAST_WIDE: f64 = 1.1;
/// Widths of narrow pixels, of which the likeliest is taken: edges tell them less well.
const NARROW_WIDTHS: [f64; 3] = [0.25, 0.5, 0.7];

/// A picture is a little wrong if at most one of so many pixels is.
const LITTLE: usize = 20;

/// Half a pixel is looked for where the picture lies no farther than this from it, in pixels.
const NEAR: f64 = 0.5;

/// Maximum number of rows that move what is seen and are looked at, those nearest to what edges
/// tell.
const SHIFTS: usize = 4;

/// Of rows that show in areas, a tiny grid has to show so many standard deviations and such a part
/// for them to be looked at where a picture is explained without.
const HINTED: f64 = 3.0;
const HINTED_PART: f64 = 0.3;

/// The mistakes that explain a picture best, from what a program without mistakes would have made,
/// and whether they explain it.
pub fn run(judge: &Judge) -> Result<Option<(Judged, bool)>, Cancelled> {
    let right = Candidate::right(judge.scene);
    let Some(best) = judge.judged(&right, &judge.middle) else {
        return Ok(None);
    };
    // Candidates not looked at yet, each with its detours: how many places behind the best its
    // mistakes stood when they were chosen, in sum.
    let mut open = vec![(0, best)];
    let mut nearest: Option<Judged> = None;
    let mut seen: Vec<Candidate> = Vec::new();
    let mut explained = None;
    // The fewest detours first, and of these the candidate that was made last, which goes on where
    // the one before ended.
    while let Some(at) = (0..open.len()).min_by_key(|&at| open[at].0) {
        let (detours, mut from) = open.remove(at);
        explained = explained_with(judge, from.candidate());
        // Numbers that are not the right ones leave a little, which others would seem to explain.
        if explained.is_none() && !from.candidate().numbers().is_empty() {
            let plain = plain(judge, from.candidate());
            explained = explained_with(judge, &plain);
            from = judge.judged(&plain, &judge.middle).unwrap_or(from);
        }
        if explained.is_some() || !judge.work.may_go_on() {
            nearest = nearer(nearest, from);
            break;
        }
        if from.candidate().mistakes.len() < MOST_MISTAKES {
            let next = step(judge, &from).into_iter();
            let next = next.filter(|next| !seen.iter().any(|one| one.is_alike(next.candidate())));
            let next: Vec<Judged> = next.collect();
            seen.extend(next.iter().map(|next| next.candidate().clone()));
            let next = (detours..).zip(next).collect::<Vec<_>>();
            open.splice(0..0, next);
        }
        nearest = nearer(nearest, from);
    }
    let Some(best) = nearest else {
        return Ok(None);
    };
    let is_explained = explained.is_some();
    let last = match explained {
        None => best.candidate().clone(),
        Some(right) if right.mistakes.is_empty() => right,
        Some(explained) => {
            let fewest = judge.work.without_limit(|| fewest(judge, &explained));
            let plainest = plain(judge, &fewest);
            match judge.explains(&plainest) {
                true => plainest,
                false => fewest,
            }
        }
    };
    let found = judge
        .work
        .without_limit(|| judge.judged(&last, &judge.edges));
    let found = found.map(|found| (found, is_explained));
    cancel::unless_set(judge.cancel, found)
}

/// The candidate of less cost.
fn nearer(one: Option<Judged>, other: Judged) -> Option<Judged> {
    match one {
        Some(one) if one.cost <= other.cost => Some(one),
        _ => Some(other),
    }
}

/// The same with what explains a picture beside it: nothing, or a row that shows where colours
/// meet; none if it is not explained so.
fn explained_with(judge: &Judge, candidate: &Candidate) -> Option<Candidate> {
    // What is found so far is judged, however much work that is.
    let (are_areas_right, wrong, null) = judge.work.without_limit(|| {
        let are_areas_right = judge.explains_all(candidate);
        let wrong = Edges::of(judge, candidate);
        (
            are_areas_right,
            wrong,
            judge.judged(candidate, &judge.edges),
        )
    });
    let null = null?;
    // Cut off bytes and another curve show in whole areas.
    let strays = judge.predicted(candidate, &judge.fine)?.strays();
    let is_much_wrong = strays.pixels.len() * 50 > judge.fine.grid.count();
    let is_little_wrong = strays.pixels.len() * LITTLE <= judge.fine.grid.count();
    let predicted = judge.edges.predict(&null.rendering);
    judge.edges.compare_with(Arc::clone(&null.rendering));
    // What is done to light, and what a JPEG does, makes other noise at edges.
    let is_coded = judge.fine.jpeg.is_some();
    let may = candidate.keeps_light() && !is_coded;
    let is_shifted =
        candidate.behaviour.offset != [0.0; 2] || candidate.behaviour.spread != [1.0; 2];
    let may_shift = !is_shifted && is_little_wrong;
    let by = wrong.off.filter(|_| may_shift).map(|off| off.by);
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges if PIXELS.contains(&row.id) => false,
        // What the faulty tracer makes is not known well enough at edges.
        Shows::AtEdges => {
            let may = may || candidate.keeps_light() && row.id == IN_CODED;
            may && are_areas_right && candidate.behaviour.is_right()
        }
        Shows::Everywhere => may && is_much_wrong,
    });
    let rows = rows.map(|row| Mistake::Row(row, None));
    let rows = rows.chain(by.into_iter().flat_map(|by| shifts(candidate, by)));
    let is_explained = are_areas_right && wrong.are_right() && judge.is_even(candidate);
    let hinted = match is_explained && may && candidate.mistakes.is_empty() {
        true => hinted(judge, candidate),
        false => Vec::new(),
    };
    let told = |mistake: Mistake| {
        judge.work.may_go_on().then_some(())?;
        let with = candidate.with(mistake.clone())?;
        let rendering = judge.edges.render(&with, &judge.work)?;
        let [part, deviations] = predicted.part_seen(&null.score, &judge.edges.predict(&rendering));
        let is_told = match is_coded {
            false => (part - 1.0).abs() < PART && deviations > SURE,
            // The coding blurs and weakens it.
            true => {
                let with = judge.judged(&with, &judge.edges)?;
                with.score.squares < LEFT_IN_CODED * null.score.squares
            }
        };
        let is_told =
            is_told || matches!(mistake, Mistake::Row(row, _) if row.shows == Shows::Everywhere);
        is_told.then_some((deviations, with))
    };
    let mut told: Vec<_> = rows.chain(hinted).filter_map(told).collect();
    told.sort_by(|one, other| other.0.total_cmp(&one.0));
    let best = told
        .iter()
        .find(|(_, with)| judge.explains(with))
        .or(told.first());
    let best = best.and_then(|(_, with)| fitted_with(judge, with.clone()));
    let filtered = || {
        let width = wrong.width.filter(|_| is_little_wrong)?;
        let widths = match width < 1.0 {
            true => NARROW_WIDTHS.to_vec(),
            false => WIDTHS.map(|by| (width * by).max(LEAST_WIDE)).to_vec(),
        };
        let widths = widths.into_iter().filter_map(|width| {
            let with = candidate.with(Mistake::Filter(width))?;
            Some((judge.judged(&with, &judge.edges)?.cost, with))
        });
        let (_, with) = widths.min_by(|one, other| one.0.total_cmp(&other.0))?;
        fitted_with(judge, with)
    };
    best.or_else(filtered)
        .or_else(|| is_explained.then(|| candidate.clone()))
}

/// The rows that move what is seen by about so much, the nearest first.
fn shifts(candidate: &Candidate, by: [f64; 2]) -> Vec<Mistake> {
    let rows = ROWS.iter().filter(|row| PIXELS.contains(&row.id));
    let by = candidate.layout.source_direction(by);
    let off = |row: &'static Row| {
        let mistake = Mistake::Row(row, None);
        let shift = candidate.with(mistake.clone())?.behaviour.offset;
        let off = |i: usize| (by[i] - shift[i]).abs() / shift[i].abs().max(1.0);
        Some((off(0).max(off(1)), mistake))
    };
    let mut near: Vec<_> = rows.filter_map(off).filter(|one| one.0 <= NEAR).collect();
    near.sort_by(|one, other| one.0.total_cmp(&other.0));
    near.truncate(SHIFTS);
    near.into_iter().map(|(_, mistake)| mistake).collect()
}

/// A candidate if it explains the picture, or does with numbers that are fitted anew, as those
/// were before its last mistake.
fn fitted_with(judge: &Judge, with: Candidate) -> Option<Candidate> {
    if judge.explains(&with) {
        return Some(with);
    }
    let free = with.numbers().len();
    (free > 0).then_some(())?;
    let (fitted, _) = judge.fit(&with, free, &judge.middle, CELL_STEP, [0, ROUNDS])?;
    let short = shortened(judge, &fitted);
    judge.explains(&short).then_some(short)
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
    let pairs = objects.iter().enumerate();
    let pairs =
        pairs.flat_map(|(at, &one)| objects[at + 1..].iter().map(move |&other| (one, other)));
    let exchanged =
        pairs.map(|(one, other)| Mistake::ColorsExchanged(one.min(other), one.max(other)));
    rows.map(|row| Mistake::Row(row, None))
        .chain(of_objects)
        .chain(exchanged)
}

/// The same with as few mistakes as explain the picture.
fn fewest(judge: &Judge, all: &Candidate) -> Candidate {
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
        fewest = simpler.find(|it| judge.explains(it)).unwrap_or(fewest);
    }
    for left_out in (0..fewest.mistakes.len()).rev() {
        // What shows at edges was not told without being sure of it, and neither was what a picture
        // hints at that a right program would explain.
        let is_sole = fewest.mistakes.len() == 1;
        if is_sole || fewest.mistakes.get(left_out).is_none_or(shows_at_edges) {
            continue;
        }
        let mistakes = fewest.mistakes.iter().enumerate();
        let mistakes = mistakes.filter(|(at, _)| *at != left_out);
        let mistakes: Vec<_> = mistakes.map(|(_, mistake)| mistake).collect();
        let Some(fewer) = of(&mistakes) else {
            continue;
        };
        // What is left out may have made up for what numbers are off, or for a row that shows at
        // edges.
        let fitted = || {
            let free = fewer.numbers().len();
            (free > 0).then_some(())?;
            let (fitted, _) = judge.fit(&fewer, free, &judge.middle, CELL_STEP, [0, ROUNDS])?;
            explained_with(judge, &plain(judge, &fitted))
        };
        let fewer = explained_with(judge, &fewer).or_else(fitted);
        if let Some(fewer) = fewer.filter(|fewer| fewer.fitted() < fewest.fitted()) {
            fewest = fewer;
        }
    }
    fewest
}

fn shows_at_edges(mistake: &Mistake) -> bool {
    match mistake {
        Mistake::Row(row, _) => row.shows != Shows::InAreas,
        Mistake::Filter(_) => true,
        _ => false,
    }
}

/// Candidates with one more mistake that are better, the best first.
fn step(judge: &Judge, from: &Judged) -> Vec<Judged> {
    judge.compare_with(from.candidate());
    let suspects = suspects(judge, from);
    let mut tried = rows(judge, from, &suspects);
    // A row says more than numbers that make the same picture: where it explains all, they need not
    // be looked for.
    let explaining = |tried: &[(f64, Candidate)]| {
        let row = tried.iter().min_by(|one, other| one.0.total_cmp(&other.0));
        let found = likelier(judge, from, &row?.1)?;
        (found.cost < from.cost && judge.explains(found.candidate())).then_some(found)
    };
    if let Some(found) = explaining(&tried) {
        return vec![found];
    }
    if from.candidate().mistakes.is_empty() {
        let together = joint::rows_together(judge, from.candidate());
        if let Some(found) = explaining(&together) {
            return vec![found];
        }
        tried.extend(together.into_iter().take(1));
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
    // What explains all is taken to be beaten only by what has fewer numbers: more of them come
    // nearer before all are fitted to the end.
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
    judge.work.without_limit(|| judged.retain(is_better));
    // Something too many would explain anything; it is thought of where nothing else explains more
    // than before.
    let patched = || {
        are_all_tried.then_some(())?;
        let patched = from.candidate().with(patch(judge, from)?)?;
        let found = judge.judged(&patched, &judge.middle)?;
        (found.cost < from.cost).then_some(found)
    };
    if judged.is_empty() {
        judged.extend(patched());
    }
    judged
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
