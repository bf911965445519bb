//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times.
//!
//! A coarse grid tells which mistakes are worth a look, and a tiny one before it which numbers are; a middle one fits numbers and judges all of them. What shows
//! only where colours meet is judged on the pixels.

use super::{
    candidate::{Candidate, Cause, Named},
    fit::absolute,
    light::Curve,
    made::Made,
    mistakes::{OBJECT_ROWS, ROWS, Row, Shows},
    number_text,
    numbers::numbers,
    objects::labels,
    parameters::Owner,
    patch::patch,
    search::{Found, Search, joined, split},
};
use crate::cancel::{self, Cancelled};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that leave least on the coarse grid.
const FINALISTS: usize = 3;

/// Rounds of fitting numbers to the middle grid: none by squares, as new numbers come from a fit to a coarser one, and earlier ones from this.
const ROUNDS: [usize; 2] = [0, 4];

/// So many objects are looked at, those around which most is wrong.
const SUSPECTS: usize = 12;

/// A sample in the middle of a pixel makes as little noise as two random ones; more than this come of several.
const ONE: f64 = 3.0;

/// The mistakes that explain a picture, from what a program without mistakes would have made.
pub fn run(search: &Search) -> Result<Option<Found>, Cancelled> {
    let right = Candidate::right(search.scene);
    let Some(mut best) = search.judged_on(&search.middle, right, None) else {
        return Ok(None);
    };
    // That nothing is wrong for certain does not say that nothing is wrong: what moves by a pixel where all pixels show several colours is found by the likelihood
    // alone.
    let mut is_open = search.explains_all(&best);
    while best.candidate.named.len() < MOST_MISTAKES
        && (is_open || !search.is_explained(&best.candidate))
        && search.work.may_go_on()
        && let Some(next) = step(search, &best, is_open)
    {
        best = next;
        is_open = false;
    }
    let short = shortened(search, best);
    let mut best = with_edges(search, short, None)?;
    // A shift by half a pixel may be taken for a camera that looks a little elsewhere.
    if let Some(found) = &best
        && let [one] = found.candidate.named.as_slice()
        && let Cause::Numbers(parameter, _) = &one.cause
        && parameter.owner == Owner::Camera
    {
        let right = Candidate::right(search.scene);
        let other = with_edges(search, right, found.score.samples)?;
        let other = other.filter(|other| search.has_no_strays(&other.candidate));
        best = best
            .into_iter()
            .chain(other)
            .min_by(|one, other| one.cost.total_cmp(&other.cost));
    }
    cancel::unless_set(search.cancel, best)
}

/// A candidate, or the same with a row that shows only where colours meet, if that is better on the pixels. How many samples a pixel has may be known from
/// another candidate that explains the picture.
fn with_edges(
    search: &Search,
    candidate: Candidate,
    samples: Option<f64>,
) -> Result<Option<Found>, Cancelled> {
    // Where areas are not explained yet, that comes first. What is found so far is judged, however much work that is.
    let most = search.work.lift();
    let is_open = !search.has_no_strays(&candidate);
    let null = search.judged_on(&search.edges, candidate, None);
    search.work.restore(most);
    let Some(null) = null else {
        return Ok(None);
    };
    // What is done to light, or to a JPEG, makes other noise at edges, of which too little is known to tell these. One sample is its own mean, wherever in a pixel it lies.
    let may = null.candidate.looks.is_empty()
        && null.candidate.curve == Curve::Right
        && search.fine.jpeg.is_none();
    let samples = samples.or(null.score.samples);
    let is_one = samples.is_some_and(|samples| samples < ONE);
    let shows = |row: &&Row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges => may && !is_one,
        Shows::Everywhere => may,
    };
    let rows = ROWS.iter().filter(shows);
    let candidates = rows.filter_map(|row| null.candidate.with(row.named()));
    let judged = candidates
        .take_while(|_| search.work.may_go_on())
        .filter_map(|candidate| search.judged_on(&search.edges, candidate, Some(&null.made)));
    let judged: Vec<Found> = judged.collect();
    let best = judged
        .into_iter()
        .map(|found| (search.gain(&search.edges, &null, &found), found))
        .filter(|(gain, _)| *gain > 0.0)
        .filter(|(_, found)| !is_open || search.has_no_strays(&found.candidate))
        .max_by(|one, other| one.0.total_cmp(&other.0));
    cancel::unless_set(search.cancel, Some(best.map_or(null, |(_, found)| found)))
}

/// The best candidate with one more mistake, if it is better.
fn step(search: &Search, from: &Found, is_open: bool) -> Option<Found> {
    let coarse = search.made(&from.candidate, &search.coarse, None)?;
    let suspects = suspects(search, from);
    let mut tried = rows(search, from, &coarse, &suspects);
    // A row says more than numbers that make the same picture: where it explains all, they need not be looked for.
    let row = tried.iter().min_by(|one, other| one.0.total_cmp(&other.0));
    if let Some((_, row)) = row
        && !is_open
        && let Some(found) = likelier(search, from, row.clone())
        && let Some(found) = refined(search, found)
        && found.cost < from.cost
        && search.explains_all(&found)
    {
        return Some(found);
    }
    // Half of the work that is left is left for judging those that were tried.
    let most = search.work.keep(0.5);
    if let Some(tiny) = search.made_to_compare(&from.candidate) {
        tried.extend(numbers(search, from, [&tiny, &coarse], &suspects));
    }
    let are_all_numbers_tried = search.work.may_go_on();
    search.work.restore(most);
    tried.sort_by(|one, other| one.0.total_cmp(&other.0));
    let finalists = tried
        .into_iter()
        .take(FINALISTS)
        .map(|(_, candidate)| candidate);
    let unfitted = finalists.filter_map(|candidate| likelier(search, from, candidate));
    let mut unfitted: Vec<Found> = unfitted.collect();
    unfitted.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    let mut judged: Vec<Found> = Vec::new();
    // What explains all is taken to be beaten only by what has fewer numbers: more of them come nearer before all are fitted to the end.
    let mut fewest = usize::MAX;
    for found in unfitted {
        if found.candidate.fitted() < fewest
            && let Some(found) = refined(search, found)
        {
            if !is_open && search.explains_all(&found) {
                fewest = found.candidate.fitted();
            }
            judged.push(found);
        }
    }
    judged.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    // Where not all were tried, the best of them need not be the best of all; what explains all is.
    let are_all_tried = search.work.may_go_on() && are_all_numbers_tried;
    let is_better = |best: &Found| {
        let is_likelier = match is_open {
            true => search.gain(&search.middle, from, best) > 0.0,
            false => best.cost < from.cost,
        };
        is_likelier
            && (are_all_tried || search.explains_all(best))
            && search.is_seen(best, &from.candidate)
    };
    // The few that were judged are looked at in all pixels, however much work that is.
    let most = search.work.lift();
    let better = judged.into_iter().find(is_better);
    search.work.restore(most);
    // Something too many would explain anything; it is thought of where nothing else explains more than before.
    better.or_else(|| {
        (!is_open && are_all_tried).then_some(())?;
        let patched = from.candidate.with(patch(search, from)?)?;
        let found = search.judged_on(&search.middle, patched, Some(&from.made))?;
        (found.cost < from.cost).then_some(found)
    })
}

/// A candidate judged; none if it is no likelier than what it is made from.
fn likelier(search: &Search, from: &Found, candidate: Candidate) -> Option<Found> {
    let found = search.judged_on(&search.middle, candidate, Some(&from.made))?;
    (found.score.likelihood > from.score.likelihood).then_some(found)
}

/// A candidate that was judged, with its numbers fitted to the middle grid, and judged again.
fn refined(search: &Search, found: Found) -> Option<Found> {
    let candidate = search.fitted(found.candidate, &search.middle, &found.made, ROUNDS)?;
    search.judged_on(&search.middle, candidate, Some(&found.made))
}

/// The rows of the table, and how much each leaves on the coarse grid.
fn rows(search: &Search, from: &Found, coarse: &Made, suspects: &[usize]) -> Vec<(f64, Candidate)> {
    let rows = ROWS.iter().filter(|row| row.shows == Shows::InAreas);
    let mut named: Vec<Named> = rows.map(Row::named).collect();
    for &object in suspects {
        let name = Owner::Object(object).name(search.scene);
        named.extend(OBJECT_ROWS.iter().map(|row| Named {
            id: row.id,
            message: format!("{name} {}", row.message),
            help: row.help.to_owned(),
            cause: Cause::ObjectRow(row.change, object),
        }));
    }
    let candidates = named
        .into_iter()
        .filter_map(|named| from.candidate.with(named));
    let left = |candidate: Candidate| {
        let made = search.tried(&candidate, &search.coarse, Some(coarse))?;
        Some((
            absolute(&search.differences(&made, &search.coarse)),
            candidate,
        ))
    };
    candidates.filter_map(left).collect()
}

/// The objects that may be wrong, those first around which most is.
fn suspects(search: &Search, from: &Found) -> Vec<usize> {
    let grid = &search.middle.grid;
    let candidate = &from.candidate;
    let labels = labels(search, candidate, grid);
    let mut wrong = vec![0.0; search.scene.objects.len()];
    for (at, off) in from.score.off.iter().enumerate() {
        // An object that grew is wrong beside where it is seen.
        let reach = [0, 2, grid.width() * 2];
        let near = reach
            .iter()
            .flat_map(|by| [at.checked_sub(*by), Some(at + by)])
            .flatten();
        let mut objects: Vec<_> = near.filter_map(|at| *labels.get(at)?).collect();
        objects.sort_unstable();
        objects.dedup();
        objects
            .into_iter()
            .for_each(|object| wrong[object] += libm::log1p(*off));
    }
    let mut suspects: Vec<_> = (0..wrong.len())
        .filter(|&object| wrong[object] > 0.0)
        .collect();
    suspects.sort_by(|&one, &other| wrong[other].total_cmp(&wrong[one]));
    suspects.truncate(SUSPECTS);
    suspects
}

/// A candidate whose numbers have as few digits as do.
fn shortened(search: &Search, found: Found) -> Candidate {
    let mut named = found.candidate.named.clone();
    level(&mut named);
    let Some(leveled) = Candidate::of(search.scene, &named).filter(|_| !joined(&named).is_empty())
    else {
        return found.candidate;
    };
    let Some(fitted) = search.fit_all(&leveled, &search.middle, &found.made, [0, 1]) else {
        return found.candidate;
    };
    let of = |named: &Named| match &named.cause {
        Cause::Numbers(parameter, _) => parameter.steps(&leveled.scene),
        _ => Vec::new(),
    };
    let steps: Vec<f64> = named.iter().flat_map(of).collect();
    let named = &named;
    // A number that is short was not fitted: it may cost what that costs.
    let [width, height] = search.middle.grid.size().map(f64::from);
    let price = 0.5 * libm::log(width * height);
    for digits in [8.0, 2.0] {
        // What a vector's length may be off is no matter, so that no error is more than a part of a step.
        let rounded = joined(named).into_iter().zip(&fitted.errors).zip(&steps);
        let rounded: Vec<f64> = rounded
            .map(|((x, error), step)| number_text::rounded(x, (digits * error).min(step.abs())))
            .collect();
        if let Some(candidate) = Candidate::of(search.scene, &split(named, &rounded))
            && let Some(judged) = search.judged_on(&search.middle, candidate, Some(&found.made))
            && judged.cost <= found.cost + price * rounded.len() as f64
        {
            return judged.candidate;
        }
    }
    leveled
}

fn level(named: &mut [Named]) {
    for one in named {
        if let Cause::Numbers(parameter, numbers) = &mut one.cause {
            number_text::level(parameter, numbers);
        }
    }
}
