//! Finds combinations of mistakes that explain a picture only together. The combined mistakes are
//! of three kinds: mistakes that change what is seen, wrong arrangements of pixels, and effects on
//! light, such as a wrong encoding or order of channels.
//!
//! One mistake of a combination may explain nothing. For example, wrong squares of a checkerboard
//! are not recognised in a picture that is also upside down. So combinations are tried on the
//! coarsest grid, before any numbers are fitted.

use super::{
    judge::{Judge, least},
    levenberg_marquardt::absolute,
};
use crate::grading::{
    hypotheses::{Candidate, Mistake, ROWS, Shows},
    scoring::{Level, Prediction},
};

/// Number of combinations of mistakes that are extended by a second effect on light. Combinations
/// with the least difference from the picture are chosen. A larger number takes longer.
const BEST: usize = 8;

/// Number of combinations without effects on light that are extended by such effects. Combinations
/// with the highest correlation with the picture are chosen. When all were extended, this took most
/// of the time of judging a wrong picture.
const CORRELATED: usize = 32;

/// Number by which a combination's difference from the picture is divided, once for each of its
/// mistakes. So a further mistake must explain more than 5 % of the difference.
const ROW_RATIO: f64 = 0.95;

/// Returns how strongly observed and predicted light are correlated, from 0 to 1. The light of a
/// cell is the sum of its channels. Effects on light hardly change this correlation. Inverted
/// colours change only its sign, so the absolute value is returned.
fn correlation(prediction: &Prediction) -> f64 {
    let mut sums = [0.0; 6];
    for (seen, mean) in prediction.observed.iter().zip(&prediction.moments.mean) {
        let [a, b] = [seen, mean].map(|light| light.element_sum());
        if !a.is_nan() {
            let terms = [1.0, a, b, a * a, a * b, b * b];
            sums = std::array::from_fn(|i| sums[i] + terms[i]);
        }
    }
    let [n, a, b, aa, ab, bb] = sums;
    let covariance = |product: f64, one: f64, other: f64| product - one * other / n.max(1.0);
    let variances = covariance(aa, a, a) * covariance(bb, b, b);
    covariance(ab, a, b).abs() / variances.sqrt().max(1e-12)
}

/// Returns the combinations of several mistakes with the least differences from the picture on the
/// coarsest grid, `tiny`. Each comes with its difference.
pub fn joint_rows(judge: &Judge, right: &Candidate, tiny: &Level) -> Vec<(f64, Candidate)> {
    let rows = ROWS.iter();
    // Of the weakly visible mistakes, only one encoding is tried, and not in a JPEG, whose coding
    // hides weak mistakes.
    let is_coded = judge.fine.jpeg.is_some();
    let rows = rows.filter(|row| match row.shows {
        Shows::InAreas => true,
        Shows::AtEdges => false,
        Shows::Everywhere => !is_coded && row.id == "gamma_22",
    });
    let rows = rows.filter_map(|row| {
        let mistake = Mistake::Row(row, None);
        Some((right.with(mistake.clone())?, mistake))
    });
    let (light, others): (Vec<_>, Vec<_>) =
        rows.partition(|(one, _)| one.curve != right.curve || !one.effects.is_empty());
    let (layout, seen): (Vec<_>, Vec<_>) = others
        .into_iter()
        .partition(|(one, _)| one.layout != right.layout);
    // Returns the hypothesis itself, and its extensions by each of the mistakes alone.
    let with = |candidate: &Candidate, rows: &[(Candidate, Mistake)]| {
        let changed = rows
            .iter()
            .map(|(_, mistake)| candidate.with(mistake.clone()));
        let all = std::iter::once(Some(candidate.clone())).chain(changed);
        Vec::from_iter(all.flatten())
    };
    let left = |candidate: Candidate| {
        judge.work.check()?;
        let prediction = judge.predicted(&candidate, tiny)?;
        // A prediction of one colour is skipped, because pictures of one colour are judged before
        // the search.
        let mean = &prediction.moments.mean;
        if mean.iter().all(|one| *one == mean[0]) {
            return None;
        }
        let penalty = libm::pow(ROW_RATIO, candidate.mistakes.len() as f64);
        Some((absolute(&prediction.differences()) / penalty, candidate))
    };
    // Mistakes that change what is seen are tried first, because each of them needs a new
    // rendering. Combinations with other mistakes reuse this rendering.
    let seen = with(right, &seen).into_iter();
    let laid_out = seen.flat_map(|candidate| with(&candidate, &layout));
    let correlated = laid_out.filter_map(|candidate| {
        judge.work.check()?;
        Some((-correlation(&judge.predicted(&candidate, tiny)?), candidate))
    });
    let correlated = least(correlated, CORRELATED).into_iter();
    let lit = correlated.flat_map(|(_, candidate)| with(&candidate, &light));
    let best = least(lit.filter_map(left), BEST).into_iter();
    let both = best.flat_map(|(_, candidate)| with(&candidate, &light));
    let best = least(both.filter_map(left), BEST).into_iter();
    best.filter(|(_, candidate)| candidate.mistakes.len() > 1)
        .filter_map(|(_, candidate)| judge.with_difference(candidate, tiny))
        .collect()
}
