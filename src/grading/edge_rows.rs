//! What explains a picture beside a set of mistakes: nothing, or a row that shows where colours
//! meet, and nowhere else.
//!
//! In: a candidate that is near the picture. Out: the same, maybe with such a row, if it explains
//! it. Rows are told by the part that is seen of what they change, on the pixels.

use std::sync::Arc;

use super::{
    candidate::{Candidate, Mistake, Row, Shows},
    displacement::Left,
    judge::{CELL_STEP, Judge, least},
    level::Level,
    mistakes::{OBJECT_ROWS, ROWS},
    plain_numbers::shortened,
};

/// Rounds of fitting numbers to the middle grid, new ones from a fit to a coarser one, and earlier
/// ones from this.
pub const ROUNDS: usize = 4;

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

/// A picture is much wrong if more than one of so many pixels is.
const MUCH: usize = 50;

/// Half a pixel is looked for where the picture lies no farther than this from it, in pixels, and
/// more in parts of its length.
const NEAR: f64 = 0.5;

/// Maximum number of rows that move what is seen and are looked at, those nearest to what edges
/// tell.
const SHIFTS: usize = 4;

/// Of rows that show in areas, a tiny grid has to show so many standard deviations and such a part
/// for them to be looked at where a picture is explained without.
const HINTED: f64 = 3.0;
const HINTED_PART: f64 = 0.3;

/// A candidate with all of its numbers fitted to a level; none if it has none.
pub fn refitted(
    judge: &Judge,
    candidate: &Candidate,
    level: &Level,
    rounds: [usize; 2],
) -> Option<Candidate> {
    let all: Vec<usize> = (0..candidate.numbers().len()).collect();
    (!all.is_empty()).then_some(())?;
    let (fitted, _) = judge.fit(candidate, &all, level, CELL_STEP, rounds)?;
    Some(fitted)
}

/// The same with what explains a picture beside it: nothing, or a row that shows where colours
/// meet; none if it is not explained so.
pub fn explained_with(judge: &Judge, candidate: &Candidate) -> Option<Candidate> {
    let edges = judge.edges();
    // What is found so far is judged, however much work that is.
    let (left, null) = judge.work.without_limit(|| {
        let left = Left::by(judge, candidate);
        left.zip(judge.judged(candidate, edges))
    })?;
    // Cut off bytes and another curve show in whole areas.
    let is_much_wrong = left.strays * MUCH > judge.fine.grid.count();
    (left.is_at_edges || is_much_wrong).then_some(())?;
    let predicted = edges.predict(&null.rendering);
    edges.compare_with(Arc::clone(&null.rendering));
    // What is done to light, and what a JPEG does, makes other noise at edges.
    let is_coded = judge.fine.jpeg.is_some();
    let may = candidate.keeps_light() && !is_coded;
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges if PIXELS.contains(&row.id) => false,
        // Where the faulty tracer shows edges elsewhere, they are not known well enough.
        Shows::AtEdges => {
            let may = may || candidate.keeps_light() && row.id == IN_CODED;
            may && left.is_at_edges && candidate.behaviour.is_in_place()
        }
        Shows::Everywhere => may && !left.are_areas_right,
    });
    let rows = rows.map(|row| Mistake::Row(row, None));
    let by = left.off.filter(|_| !candidate.is_shifted());
    let rows = rows.chain(by.into_iter().flat_map(|off| shifts(candidate, off.by)));
    let hinted = match left.is_noise() && may && candidate.mistakes.is_empty() {
        true => hinted(judge, candidate),
        false => Vec::new(),
    };
    let told = |mistake: Mistake| {
        judge.work.may_go_on().then_some(())?;
        let with = candidate.with(mistake.clone())?;
        let rendering = edges.render(&with, &judge.work)?;
        let [part, deviations] = predicted.part_seen(&null.score, &edges.predict(&rendering));
        let is_told = match is_coded {
            false => (part - 1.0).abs() < PART && deviations > SURE,
            // The coding blurs and weakens it.
            true => {
                let with = judge.judged(&with, edges)?;
                with.score.squares < LEFT_IN_CODED * null.score.squares
            }
        };
        let is_told =
            is_told || matches!(mistake, Mistake::Row(row, _) if row.shows == Shows::Everywhere);
        is_told.then(|| Some((judge.judged(&with, edges)?.cost, with)))?
    };
    let told = least(rows.chain(hinted).filter_map(told), usize::MAX);
    let best = told
        .iter()
        .find(|(_, with)| judge.explains(with))
        .or(told.first());
    let best = best.and_then(|(_, with)| fitted_with(judge, with.clone()));
    let filtered = || {
        let width = left.width?;
        let widths = match width < 1.0 {
            true => NARROW_WIDTHS.to_vec(),
            false => WIDTHS.map(|by| (width * by).max(LEAST_WIDE)).to_vec(),
        };
        let widths = widths.into_iter().filter_map(|width| {
            let with = candidate.with(Mistake::Filter(width))?;
            Some((judge.judged(&with, edges)?.cost, with))
        });
        let (_, with) = least(widths, 1).pop()?;
        fitted_with(judge, with)
    };
    best.or_else(filtered)
        .or_else(|| left.is_noise().then(|| candidate.clone()))
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
    let near = rows.filter_map(off).filter(|one| one.0 <= NEAR);
    let near = least(near, SHIFTS).into_iter();
    near.map(|(_, mistake)| mistake).collect()
}

/// A candidate if it explains the picture, or does with numbers that are fitted anew, as those
/// were before its last mistake.
fn fitted_with(judge: &Judge, with: Candidate) -> Option<Candidate> {
    if judge.explains(&with) {
        return Some(with);
    }
    Left::by(judge, &with)?.is_at_edges.then_some(())?;
    let fitted = refitted(judge, &with, judge.fitting(&with), [0, ROUNDS])?;
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
