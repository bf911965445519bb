//! Tests whether a hypothesis explains the picture if a mistake is added that is visible only at
//! edges.
//!
//! In: a hypothesis about the program that is close to the picture. Out: the hypothesis, perhaps
//! with one more mistake, if it explains the picture. The added mistake may be a row of the table
//! of mistakes, a shift of all samples, or a wrong pixel width. A row predicts a change of the
//! picture. The row is accepted only if this change is observed in the pixels.

use std::sync::Arc;

use super::{
    judge::{Judge, least},
    plain_numbers::shortened,
};
use crate::grading::hypotheses::{
    Behaviour, Candidate, Mistake, MistakeRow, OBJECT_ROWS, ROWS, Shows,
};

/// Maximum number of rounds in which numbers are fitted to a grid of high resolution. A few rounds
/// are enough, because the numbers were fitted to a coarser grid before.
pub const ROUNDS: usize = 4;

/// Tolerance of the observed fraction of a predicted change. A mistake predicts a change at edges,
/// and the picture shows a fraction of this change. The mistake is named only if the fraction is 1
/// ± 0.3, i.e. if about the whole change is observed. With a larger tolerance, mistakes with
/// similar effects would be confused.
const SHARE_TOLERANCE: f64 = 0.3;
/// Minimum significance of an observed change, in standard deviations. A mistake predicts a change
/// at edges, and the picture shows a fraction of this change. The mistake is named only if the
/// fraction exceeds 0 by this many standard deviations, so that it is not chance.
const SURE: f64 = 7.0;
/// Maximum fraction of the squared difference between a JPEG and its prediction that a mistake at
/// edges may leave. If more is left, the mistake is not named, because it explains only a part of
/// the difference.
const LEFT_IN_CODED: f64 = 0.25;

/// Identifiers of the mistakes that move samples by a few pixels at most.
const SHIFT_IDS: [&str; 2] = ["half_pixel", "window_one_less"];

/// Identifier of the only mistake at edges that can be recognised in a JPEG: the program averages
/// encoded samples instead of light.
const CODED_ID: &str = "averaged_encoded";

/// Maximum fraction of the squared difference between the picture and its prediction that a wrong
/// pixel width may leave. Noise is subtracted first. If the width leaves more, it is not named,
/// because another mistake at edges may look like a slight blur.
const LEFT_BY_FILTER: f64 = 0.5;

/// Maximum ratio of two squared errors on the grid `middle`: with a mistake that is weakly visible
/// everywhere, and without it. If the ratio is greater, the mistake is not tested on single pixels,
/// because it explains only a part of the error.
const LEFT_BY_ROW: f64 = 0.5;

/// Factors by which an estimated pixel width greater than 1 is multiplied. All products are tried,
/// and the most likely one is used as the width. With more factors, the width would be more
/// precise, but the search would take longer.
const WIDTHS: [f64; 4] = [0.7, 0.8, 0.9, 1.0];
/// Least pixel width that is reported as too wide, in pixels. Smaller estimates are raised to this
/// value, so that they differ from the correct width, 1.
const LEAST_WIDE: f64 = 1.1;
/// Pixel widths, in pixels, that are tried if pixels are too narrow. The most likely one is used. A
/// few values suffice, because the edges in a picture determine a narrow width only roughly.
const NARROW_WIDTHS: [f64; 3] = [0.25, 0.5, 0.7];

/// Maximum difference between the estimated shift of all edges in the picture and the shift that a
/// mistake causes. If the difference is greater, the mistake is not tried. The unit is a pixel. If
/// the mistake shifts by more than a pixel, the difference is divided by this shift.
const MAX_SHIFT_ERROR: f64 = 0.5;

/// Threshold of a shift of all samples along x and along y, in pixels. A smaller shift is tried as
/// a mistake of its own, even if no row of the table of mistakes causes it. Such shifts occur if
/// all pixels use the same few random sample positions. With four positions, their mean is shifted
/// by less than the threshold in each direction with a probability of more than 95 %.
const MAX_SLIGHT_SHIFT: f64 = 0.35;

/// Maximum number of mistakes that are tried to explain a shift of all edges. The mistakes with the
/// most similar shifts are tried. More mistakes would take longer, and explain the shift less well.
const SHIFTS: usize = 4;

/// Minimum significance of a change on the coarsest grid, in standard deviations. A mistake
/// predicts a change of the picture, and the picture shows a fraction of this change. If the
/// fraction exceeds 0 by more than this many standard deviations, and also exceeds
/// [`HINTED_SHARE`], the mistake is tested on single pixels. That test decides, so the value may be
/// low.
const HINTED: f64 = 3.0;
/// Minimum fraction of a predicted change that the picture must show on the coarsest grid. A
/// mistake predicts a change of the picture. If the picture shows a larger fraction of this change,
/// with the significance [`HINTED`], the mistake is tested on single pixels. That test decides, so
/// the value may be low.
const HINTED_SHARE: f64 = 0.3;

/// Returns a hypothesis that explains the picture: `candidate` itself, or `candidate` with one more
/// mistake, which is visible only at edges. Returns `None` if none of these explains the picture.
pub fn explained_with(judge: &Judge, candidate: &Candidate) -> Option<Candidate> {
    let edges = judge.central_crop();
    // The hypothesis is tested even if the budget of work is used up, because it may explain the
    // picture.
    let work = &judge.work;
    let residual = work.without_limit(|| judge.residual(candidate))?;
    if !residual.is_at_edges && !residual.is_much_wrong {
        return None;
    }
    // Effects on light and JPEG coding change the noise at edges, so most mistakes at edges cannot
    // be tested.
    let is_coded = judge.fine.jpeg.is_some();
    let may = candidate.keeps_light() && !is_coded;
    let rows = ROWS.iter().filter(|row| match row.shows {
        Shows::InAreas => false,
        Shows::AtEdges if SHIFT_IDS.contains(&row.id) => false,
        // If the program traces rays so that edges move, its picture is estimated from samples,
        // which is too inexact for a test at edges.
        Shows::AtEdges => {
            let may = may || candidate.keeps_light() && row.id == CODED_ID;
            may && residual.is_at_edges && candidate.behaviour.is_in_place()
        }
        // Mistakes such as truncated bytes are visible in whole areas. So they are tried even if
        // the wrong pixels do not lie at edges, but only if they explain much of the error.
        Shows::Everywhere => {
            let is_likely = || explains_much(judge, candidate, Mistake::Row(row, None));
            may && !residual.are_areas_right && is_likely() == Some(true)
        }
    });
    let rows: Vec<Mistake> = rows.map(|row| Mistake::Row(row, None)).collect();
    if !residual.is_at_edges && rows.is_empty() {
        return None;
    }
    let null = work.without_limit(|| judge.judged(candidate, edges))?;
    let predicted = edges.predict(&null.rendering);
    edges.compare_with(Arc::clone(&null.rendering));
    let rows = rows.into_iter();
    let is_shifted = candidate.behaviour.is_shifted();
    let by = residual.displacement.filter(|_| !is_shifted);
    let rows = rows.chain(by.into_iter().flat_map(|off| shifts(candidate, off.by)));
    // If all edges are shifted by less than `MAX_SLIGHT_SHIFT`, the samples are probably not
    // centred in their pixels. A slightly wrong number of the scene is less likely. So the shift
    // itself is tried as a mistake.
    let is_slight = |by: &[f64; 2]| by[0].abs().max(by[1].abs()) < MAX_SLIGHT_SHIFT;
    let slight = by.map(|off| off.by.map(|length| (100.0 * length).round() / 100.0));
    let slight = slight.filter(is_slight).map(Mistake::Shift);
    let rows = rows.chain(slight);
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
            // JPEG coding blurs and weakens the predicted change. So the test is only that the
            // mistake reduces the difference from the picture enough.
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
            let with = judge.judged(&candidate.with(Mistake::Filter(width))?, edges)?;
            Some((with.cost, with))
        });
        let (_, with) = least(widths, 1).pop()?;
        let noise = with.score.noise;
        let [before, after] = [&null, &with].map(|one| one.score.squares - noise);
        let is_clear = after < LEFT_BY_FILTER * before;
        is_clear.then(|| fitted_with(judge, with.candidate().clone()))?
    };
    best.or_else(filtered)
        .or_else(|| residual.is_noise().then(|| candidate.clone()))
}

/// Returns whether a mistake reduces the squared error on the grid `middle` to at most a fraction
/// [`LEFT_BY_ROW`] of its value. Returns `None` if the mistake is impossible, or if the budget of
/// work is used up.
fn explains_much(judge: &Judge, candidate: &Candidate, mistake: Mistake) -> Option<bool> {
    let after = judge.square(&candidate.with(mistake)?)?;
    Some(after <= LEFT_BY_ROW * judge.square(candidate)?)
}

/// Returns the mistakes that shift samples by about `by`, given in pixels to the right and down.
/// The mistake with the most similar shift comes first.
fn shifts(candidate: &Candidate, by: [f64; 2]) -> Vec<Mistake> {
    let rows = ROWS.iter().filter(|row| SHIFT_IDS.contains(&row.id));
    let by = candidate.layout.source_direction(by);
    let sides = [candidate.scene.image.width, candidate.scene.image.height].map(f64::from);
    let off = |row: &'static MistakeRow| {
        let mistake = Mistake::Row(row, None);
        let Behaviour { offset, spread, .. } = candidate.with(mistake.clone())?.behaviour;
        // The shift, in pixels, that the mistake causes in the middle of the picture.
        let shift = |i: usize| offset[i] + (spread[i] - 1.0) * sides[i] / 2.0;
        let off = |i: usize| (by[i] - shift(i)).abs() / shift(i).abs().max(1.0);
        Some((off(0).max(off(1)), mistake))
    };
    let near = rows.filter_map(off).filter(|one| one.0 <= MAX_SHIFT_ERROR);
    let near = least(near, SHIFTS).into_iter();
    near.map(|(_, mistake)| mistake).collect()
}

/// Returns the hypothesis `with` if it explains the picture. If it does not, fits its numbers
/// again, and returns the result if that explains the picture. Otherwise returns `None`.
fn fitted_with(judge: &Judge, with: Candidate) -> Option<Candidate> {
    if judge.explains(&with) {
        return Some(with);
    }
    if !judge.residual(&with)?.is_at_edges {
        return None;
    }
    let (fitted, _) = judge.fit_all(&with, judge.fitting(&with), [0, ROUNDS])?;
    let short = shortened(judge, &fitted).unwrap_or(fitted);
    judge.explains(&short).then_some(short)
}

/// Returns the mistakes whose effects seem to be visible on the coarsest grid. They are tried even
/// if a correct program seems to explain the picture. If most pixels mix several colours, the
/// effect of a mistake may look like noise in single pixels.
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

/// Iterates over the rows of the table of mistakes that are visible in areas of one colour, and
/// over exchanges of the colours of two objects. A row about a single object is tried for each of
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
    // If several mistakes change the picture in the same way, the caller keeps the first, so usual
    // mistakes come first. For example, a missing object comes before a wrong formula by which the
    // object is never hit.
    of_objects
        .chain(exchanged)
        .chain(rows.map(|row| Mistake::Row(row, None)))
}
