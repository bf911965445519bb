//! Completes a set of mistakes by one that is visible only at edges.
//!
//! In: a candidate that is near the picture. Out: the candidate, maybe with a row about edges or
//! another pixel width, if it explains the picture then. A row is judged on the pixels, by the
//! share of its change that is observed.

use std::sync::Arc;

use super::{
    judge::{CELL_STEP, Judge, least},
    plain_numbers::shortened,
    residual::Residual,
};
use crate::grading::{
    hypotheses::{Candidate, Mistake, MistakeRow, OBJECT_ROWS, ROWS, Shows},
    scoring::Level,
};

/// Rounds of fitting numbers to the middle grid. Each is preceded by rounds on a coarser grid, so
/// few suffice.
pub const ROUNDS: usize = 4;

/// Greatest deviation from 1 of the observed share of a row's change, for the row to be named.
const SHARE_TOLERANCE: f64 = 0.3;
/// Standard deviations from 0 that the observed share must have, for a row about edges to be named.
const SURE: f64 = 7.0;
/// Greatest share of the squared difference that a row may leave in a JPEG, to be named.
const LEFT_IN_CODED: f64 = 0.25;

/// Ids of the rows that shift samples by pixels or parts of them.
const SHIFT_IDS: [&str; 2] = ["half_pixel", "window_one_less"];

/// Id of the only row about edges that can be recognised in a JPEG.
const CODED_ID: &str = "averaged_encoded";

/// Factors that are tried on the estimated width of a wide pixel; the likeliest is taken.
const WIDTHS: [f64; 4] = [0.7, 0.8, 0.9, 1.0];
/// Least width of a pixel that is reported as wide.
const LEAST_WIDE: f64 = 1.1;
/// Widths that are tried for a narrow pixel; the likeliest is taken, because edges determine it
/// less well.
const NARROW_WIDTHS: [f64; 3] = [0.25, 0.5, 0.7];

/// Number of pixels of which more than one must be wrong for a picture to count as much wrong.
const MUCH_WRONG: usize = 50;

/// Greatest difference between the estimated shift and that of a row, in pixels, and relative to a
/// shift of more than a pixel.
const MAX_SHIFT_ERROR: f64 = 0.5;

/// Maximum number of shifting rows that are tried, nearest to the estimated displacement first.
const SHIFTS: usize = 4;

/// Standard deviations from 0 that a row's observed share must have on the tiny grid, for the row
/// to be tried on a picture that is explained without it.
const HINTED: f64 = 3.0;
/// Least observed share of such a row on the tiny grid.
const HINTED_SHARE: f64 = 0.3;

/// Fits all of a candidate's numbers to a level. Returns `None` if it has none.
pub fn refitted(
    judge: &Judge,
    candidate: &Candidate,
    level: &Level,
    rounds: [usize; 2],
) -> Option<Candidate> {
    let all: Vec<usize> = (0..candidate.numbers().len()).collect();
    if all.is_empty() {
        return None;
    }
    let (fitted, _) = judge.fit(candidate, &all, level, CELL_STEP, rounds)?;
    Some(fitted)
}

/// Completes a candidate by what explains the picture: nothing, a row about edges, or another pixel
/// width. Returns `None` if none of these does.
pub fn explained_with(judge: &Judge, candidate: &Candidate) -> Option<Candidate> {
    let edges = judge.central_crop();
    // What is found so far is judged even if the budget is used up.
    let (residual, null) = judge.work.without_limit(|| {
        let residual = Residual::of_candidate(judge, candidate);
        residual.zip(judge.judged(candidate, edges))
    })?;
    // Truncated bytes and another curve are visible in whole areas.
    let is_much_wrong = residual.strays * MUCH_WRONG > judge.fine.grid.count();
    if !residual.is_at_edges && !is_much_wrong {
        return None;
    }
    let predicted = edges.predict(&null.rendering);
    edges.compare_with(Arc::clone(&null.rendering));
    // Effects on light and a JPEG's coding change the noise at edges.
    let is_coded = judge.fine.jpeg.is_some();
    let may = candidate.keeps_light() && !is_coded;
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges if SHIFT_IDS.contains(&row.id) => false,
        // The faulty tracer does not know edges well enough where it moves them.
        Shows::AtEdges => {
            let may = may || candidate.keeps_light() && row.id == CODED_ID;
            may && residual.is_at_edges && candidate.behaviour.is_in_place()
        }
        Shows::Everywhere => may && !residual.are_areas_right,
    });
    let rows = rows.map(|row| Mistake::Row(row, None));
    let is_shifted = candidate.behaviour.is_shifted();
    let by = residual.displacement.filter(|_| !is_shifted);
    let rows = rows.chain(by.into_iter().flat_map(|off| shifts(candidate, off.by)));
    let hinted = if residual.is_noise() && may && candidate.mistakes.is_empty() {
        hinted(judge, candidate)
    } else {
        Vec::new()
    };
    let test = |mistake: Mistake| {
        judge.work.check()?;
        let with = candidate.with(mistake.clone())?;
        let rendering = edges.render(&with, &judge.work)?;
        let [part, deviations] = predicted.observed_share(&null.score, &edges.predict(&rendering));
        let is_clear = if is_coded {
            // The coding blurs and weakens the change.
            let with = judge.judged(&with, edges)?;
            with.score.squares < LEFT_IN_CODED * null.score.squares
        } else {
            (part - 1.0).abs() < SHARE_TOLERANCE && deviations > SURE
        };
        let is_clear =
            is_clear || matches!(mistake, Mistake::Row(row, _) if row.shows == Shows::Everywhere);
        if !is_clear {
            return None;
        }
        Some((judge.judged(&with, edges)?.cost, with))
    };
    let tested = least(rows.chain(hinted).filter_map(test), usize::MAX);
    let explained = tested.iter().find(|(_, with)| judge.explains(with));
    let best = explained.or(tested.first());
    let best = best.and_then(|(_, with)| fitted_with(judge, with.clone()));
    let filtered = || {
        let width = residual.width?;
        let widths = if width < 1.0 {
            NARROW_WIDTHS.to_vec()
        } else {
            WIDTHS.map(|by| (width * by).max(LEAST_WIDE)).to_vec()
        };
        let widths = widths.into_iter().filter_map(|width| {
            let with = candidate.with(Mistake::Filter(width))?;
            Some((judge.judged(&with, edges)?.cost, with))
        });
        let (_, with) = least(widths, 1).pop()?;
        fitted_with(judge, with)
    };
    best.or_else(filtered)
        .or_else(|| residual.is_noise().then(|| candidate.clone()))
}

/// Returns the rows that shift samples by about `by` pixels, the nearest first.
fn shifts(candidate: &Candidate, by: [f64; 2]) -> Vec<Mistake> {
    let rows = ROWS.iter().filter(|row| SHIFT_IDS.contains(&row.id));
    let by = candidate.layout.source_direction(by);
    let off = |row: &'static MistakeRow| {
        let mistake = Mistake::Row(row, None);
        let shift = candidate.with(mistake.clone())?.behaviour.offset;
        let off = |i: usize| (by[i] - shift[i]).abs() / shift[i].abs().max(1.0);
        Some((off(0).max(off(1)), mistake))
    };
    let near = rows.filter_map(off).filter(|one| one.0 <= MAX_SHIFT_ERROR);
    let near = least(near, SHIFTS).into_iter();
    near.map(|(_, mistake)| mistake).collect()
}

/// Returns a candidate if it explains the picture, with its numbers as they were before its last
/// mistake or fitted anew.
fn fitted_with(judge: &Judge, with: Candidate) -> Option<Candidate> {
    if judge.explains(&with) {
        return Some(with);
    }
    if !Residual::of_candidate(judge, &with)?.is_at_edges {
        return None;
    }
    let fitted = refitted(judge, &with, judge.fitting(&with), [0, ROUNDS])?;
    let short = shortened(judge, &fitted);
    judge.explains(&short).then_some(short)
}

/// Returns the rows that a tiny grid hints at although the picture is explained without them: where
/// most pixels show mixtures, what is wrong may pass for noise.
fn hinted(judge: &Judge, candidate: &Candidate) -> Vec<Mistake> {
    let hinted = || {
        let tiny = judge.tiny(candidate)?;
        let null = judge.judged(candidate, &tiny)?;
        let predicted = tiny.predict(&null.rendering);
        let is_hinted = |mistake: &Mistake| {
            let with = candidate.with(mistake.clone())?;
            let rendering = tiny.render(&with, &judge.work)?;
            let [part, deviations] =
                predicted.observed_share(&null.score, &tiny.predict(&rendering));
            Some(part > HINTED_SHARE && deviations > HINTED)
        };
        let all: Vec<usize> = (0..judge.scene.objects.len()).collect();
        let rows = rows_in_areas(&all);
        Some(rows.filter(|row| is_hinted(row) == Some(true)).collect())
    };
    hinted().unwrap_or_default()
}

/// Iterates over the rows that are visible in areas; those about an object once for each of
/// `objects`.
pub fn rows_in_areas(objects: &[usize]) -> impl Iterator<Item = Mistake> {
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
