//! Forward selection: the mistake that explains most, then the table once more on what is left, at most four times.
//!
//! A coarse grid tells which mistakes are worth a look, and a tiny one before it which numbers are; a middle one fits numbers and judges all of them. What shows
//! only where colours meet is judged on the pixels.

use super::{
    candidate::{Candidate, Mistake},
    light::Curve,
    made::Made,
    mistakes::{OBJECT_ROWS, ROWS, Shows},
    numbers::numbers,
    objects::labels,
    parameters::Owner,
    patch::patch,
    search::{Found, Search, price},
};
use crate::{
    cancel::{self, Cancelled},
    numbers::rounded,
};

/// So many mistakes are named at most.
const MOST_MISTAKES: usize = 4;

/// So many are fitted and judged at a time, of those that leave least on the coarse grid.
const FINALISTS: usize = 3;

/// Rounds of fitting numbers to the middle grid, new ones from a fit to a coarser one, and earlier ones from this.
const ROUNDS: usize = 4;

/// By how much of a cell numbers are varied on the middle grid.
const STEP: f64 = 0.25;

/// So many objects are looked at, those around which most is wrong.
const SUSPECTS: usize = 12;

/// A sample in the middle of a pixel makes as little noise as two random ones; more than this come of several.
const ONE: f64 = 3.0;

/// The mistakes that explain a picture, from what a program without mistakes would have made.
pub fn run(search: &Search) -> Result<Option<Found>, Cancelled> {
    let right = Candidate::right(search.scene);
    let Some(mut best) = search.judged(&right, &search.middle, None) else {
        return Ok(None);
    };
    // That nothing is wrong for certain does not say that nothing is wrong: what moves by a pixel where all pixels show several colours is found by the likelihood
    // alone.
    let mut is_open = explains_all(search, &best);
    while best.candidate().mistakes.len() < MOST_MISTAKES
        && (is_open || !search.is_explained(best.candidate()))
        && search.work.may_go_on()
        && let Some(next) = step(search, &best, is_open)
    {
        best = next;
        is_open = false;
    }
    let short = shortened(search, &best);
    let mut best = with_edges(search, &short, None);
    // A shift by half a pixel may be taken for a camera that looks a little elsewhere.
    if let Some(found) = &best
        && let [Mistake::Numbers(parameter, _)] = found.candidate().mistakes.as_slice()
        && parameter.owner == Owner::Camera
    {
        let other = with_edges(search, &right, found.score.samples);
        let other = other.filter(|other| search.explains_all(other.candidate(), None));
        let both = best.into_iter().chain(other);
        best = both.min_by(|one, other| one.cost.total_cmp(&other.cost));
    }
    cancel::unless_set(search.cancel, best)
}

fn explains_all(search: &Search, found: &Found) -> bool {
    search.explains_all(found.candidate(), Some(&found.made))
}

/// A candidate, or the same with a row that shows only where colours meet, if that is better on the pixels. How many samples a pixel has may be known from
/// another candidate that explains the picture.
fn with_edges(search: &Search, candidate: &Candidate, samples: Option<f64>) -> Option<Found> {
    // Where areas are not explained yet, that comes first. What is found so far is judged, however much work that is.
    let (is_open, null) = search.work.without_limit(|| {
        let is_open = !search.explains_all(candidate, None);
        (is_open, search.judged(candidate, &search.edges, None))
    });
    let null = null?;
    // What is done to light, or to a JPEG, makes other noise at edges, of which too little is known to tell these. One sample is its own mean, wherever in a pixel it lies.
    let may =
        candidate.looks.is_empty() && candidate.curve == Curve::Right && search.fine.jpeg.is_none();
    let is_one = (samples.or(null.score.samples)).is_some_and(|samples| samples < ONE);
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges => may && !is_one,
        Shows::Everywhere => may,
    });
    let best = rows
        .take_while(|_| search.work.may_go_on())
        .filter_map(|row| candidate.with(Mistake::Row(row, None)))
        .filter_map(|candidate| search.judged(&candidate, &search.edges, Some(&null.made)))
        .map(|found| (search.gain(&search.edges, &null, &found), found))
        .filter(|(gain, _)| *gain > 0.0)
        .filter(|(_, found)| !is_open || search.explains_all(found.candidate(), None))
        .max_by(|one, other| one.0.total_cmp(&other.0));
    Some(best.map_or(null, |(_, found)| found))
}

/// The best candidate with one more mistake, if it is better.
fn step(search: &Search, from: &Found, is_open: bool) -> Option<Found> {
    let coarse = search.made(from.candidate(), &search.coarse, None)?;
    let suspects = suspects(search, from);
    let mut tried = rows(search, from, &coarse, &suspects);
    // A row says more than numbers that make the same picture: where it explains all, they need not be looked for.
    let row = tried.iter().min_by(|one, other| one.0.total_cmp(&other.0));
    if let Some((_, row)) = row
        && !is_open
        && let Some(found) = likelier(search, from, row)
        && let Some(found) = refined(search, found)
        && found.cost < from.cost
        && explains_all(search, &found)
    {
        return Some(found);
    }
    // Half of the work that is left is left for judging those that were tried.
    let are_all_numbers_tried = search.work.within(0.5, || {
        tried.extend(numbers(search, from, &coarse, &suspects));
        search.work.may_go_on()
    });
    tried.sort_by(|one, other| one.0.total_cmp(&other.0));
    tried.truncate(FINALISTS);
    let unfitted = tried
        .iter()
        .filter_map(|one| likelier(search, from, &one.1));
    let mut unfitted: Vec<Found> = unfitted.collect();
    unfitted.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    let mut judged: Vec<Found> = Vec::new();
    // What explains all is taken to be beaten only by what has fewer numbers: more of them come nearer before all are fitted to the end.
    let mut fewest = usize::MAX;
    for found in unfitted {
        if found.candidate().fitted() < fewest
            && let Some(found) = refined(search, found)
        {
            if !is_open && explains_all(search, &found) {
                fewest = found.candidate().fitted();
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
            && (are_all_tried || explains_all(search, best))
            && search.is_seen(best, from.candidate())
    };
    // The few that were judged are looked at in all pixels, however much work that is.
    let better = search
        .work
        .without_limit(|| judged.into_iter().find(is_better));
    // Something too many would explain anything; it is thought of where nothing else explains more than before.
    better.or_else(|| {
        (!is_open && are_all_tried).then_some(())?;
        let patched = from.candidate().with(patch(search, from)?)?;
        let found = search.judged(&patched, &search.middle, Some(&from.made))?;
        (found.cost < from.cost).then_some(found)
    })
}

/// A candidate judged; none if it is no likelier than what it is made from.
fn likelier(search: &Search, from: &Found, candidate: &Candidate) -> Option<Found> {
    let found = search.judged(candidate, &search.middle, Some(&from.made))?;
    (found.score.likelihood > from.score.likelihood).then_some(found)
}

/// A candidate that was judged, with its numbers fitted to the middle grid, and judged again.
fn refined(search: &Search, found: Found) -> Option<Found> {
    let candidate = found.candidate();
    let free = candidate.numbers().len();
    if free == 0 {
        return Some(found);
    }
    let middle = &search.middle;
    let (fitted, _) = search.fit(candidate, free, (middle, &found.made), STEP, [0, ROUNDS])?;
    search.judged(&fitted, middle, Some(&found.made))
}

/// The rows of the table, and how much each leaves on the coarse grid.
fn rows(search: &Search, from: &Found, coarse: &Made, suspects: &[usize]) -> Vec<(f64, Candidate)> {
    let rows = ROWS.iter().filter(|row| row.shows == Shows::InAreas);
    let rows = rows.map(|row| Mistake::Row(row, None));
    let of_objects = suspects.iter().flat_map(|&object| {
        let rows = OBJECT_ROWS.iter();
        rows.map(move |row| Mistake::Row(row, Some(object)))
    });
    let candidates = rows.chain(of_objects);
    let candidates = candidates.filter_map(|mistake| from.candidate().with(mistake));
    candidates
        .filter_map(|candidate| {
            let left = search.left(&candidate, &search.coarse, coarse)?;
            Some((left, candidate))
        })
        .collect()
}

/// The objects that may be wrong, those first around which most is.
fn suspects(search: &Search, from: &Found) -> Vec<usize> {
    let grid = &search.middle.grid;
    let labels = labels(search, from.candidate(), grid);
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
fn shortened(search: &Search, found: &Found) -> Candidate {
    let (candidate, middle) = (found.candidate(), &search.middle);
    let free = candidate.numbers().len();
    let leveled = candidate.with_numbers(search.scene, &candidate.leveled_numbers());
    let Some(leveled) = leveled.filter(|_| free > 0) else {
        return candidate.clone();
    };
    let Some((_, fitted)) = search.fit(&leveled, free, (middle, &found.made), STEP, [0, 1]) else {
        return leveled;
    };
    // A number that is short was not fitted: it may cost what that costs.
    let most = found.cost + price(middle, free);
    for digits in [8.0, 2.0] {
        // What a vector's length may be off is no matter, so that no error is more than a part of a step.
        let errors = fitted.errors.iter().zip(leveled.steps(1.0));
        let errors = errors.map(|(error, step)| (digits * error).min(step.abs()));
        let numbers = leveled.numbers().into_iter().zip(errors);
        let numbers: Vec<f64> = numbers.map(|(x, error)| rounded(x, error)).collect();
        if let Some(short) = leveled.with_numbers(search.scene, &numbers)
            && let Some(judged) = search.judged(&short, middle, Some(&found.made))
            && judged.cost <= most
        {
            return short;
        }
    }
    leveled
}
