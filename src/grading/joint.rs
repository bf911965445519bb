//! Rows of the table that were made together: how a picture is laid out, what is seen in it, the
//! order of its channels, and how light is encoded.
//!
//! One of them alone may explain nothing: of a board whose squares are truncated nothing is seen in
//! a picture that is upside down. On the tiny grid all of them are tried together, before any
//! number is.

use super::{
    candidate::{Candidate, Mistake, Shows},
    judge::{Judge, least},
    level::Level,
    levenberg_marquardt::absolute,
    mistakes::ROWS,
    prediction::Prediction,
};

/// So many that leave least are tried with what changes light otherwise.
const BEST: usize = 8;

/// So many ways to see the scene and to lay it out are tried with what changes light, those of
/// which the picture shows the same in other light.
const ALIKE: usize = 32;

/// Another row has to leave less than this part of what is left without it.
const WORTH: f64 = 0.95;

/// How much what is seen and what is expected vary together, whatever was done to light: the
/// correlation of the sums of their channels, or what that is if light and dark are exchanged.
fn alike(shown: &Prediction) -> f64 {
    let (mut count, mut sums, mut products) = (0.0, [0.0; 2], [0.0; 3]);
    for (seen, mean) in shown.seen.iter().zip(&shown.moments.mean) {
        let [a, b] = [seen, mean].map(|light| light.element_sum());
        if !a.is_nan() {
            count += 1.0;
            sums = [sums[0] + a, sums[1] + b];
            products = [
                products[0] + a * a,
                products[1] + a * b,
                products[2] + b * b,
            ];
        }
    }
    let [aa, ab, bb] = [(0, 0, 0), (1, 0, 1), (2, 1, 1)]
        .map(|(at, i, j)| products[at] - sums[i] * sums[j] / f64::max(count, 1.0));
    ab.abs() / (aa * bb).sqrt().max(1e-12)
}

/// Several rows that together leave little, and how much each leaves on the tiny grid.
pub fn rows_together(judge: &Judge, right: &Candidate, tiny: &Level) -> Vec<(f64, Candidate)> {
    let rows = ROWS.iter();
    // What is little is not told from what a JPEG does.
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
        rows.partition(|(one, _)| one.curve != right.curve || !one.looks.is_empty());
    let (layout, seen): (Vec<_>, Vec<_>) = others
        .into_iter()
        .partition(|(one, _)| one.layout != right.layout);
    // The same without and with each.
    let with = |candidate: &Candidate, rows: &[(Candidate, Mistake)]| {
        let changed = rows
            .iter()
            .filter_map(|(_, mistake)| candidate.with(mistake.clone()));
        let all: Vec<Candidate> = std::iter::once(candidate.clone()).chain(changed).collect();
        all
    };
    let left = |candidate: Candidate| {
        judge.work.may_go_on().then_some(())?;
        let shown = judge.predicted(&candidate, tiny)?;
        // A picture of one colour was told before.
        let mean = &shown.moments.mean;
        mean.iter().any(|one| *one != mean[0]).then_some(())?;
        let left = absolute(&shown.differences());
        Some((
            left / libm::pow(WORTH, candidate.mistakes.len() as f64),
            candidate,
        ))
    };
    // What is seen first: the same is made only once.
    let seen = with(right, &seen).into_iter();
    let laid_out = seen.flat_map(|candidate| with(&candidate, &layout));
    let alike = laid_out.filter_map(|candidate| {
        judge.work.may_go_on().then_some(())?;
        Some((-alike(&judge.predicted(&candidate, tiny)?), candidate))
    });
    let alike = least(alike, ALIKE).into_iter();
    let lit = alike.flat_map(|(_, candidate)| with(&candidate, &light));
    let best = least(lit.filter_map(left), BEST).into_iter();
    let both = best.flat_map(|(_, candidate)| with(&candidate, &light));
    let best = least(both.filter_map(left), BEST).into_iter();
    best.filter(|(_, candidate)| candidate.mistakes.len() > 1)
        .filter_map(|(_, candidate)| judge.left(candidate, tiny))
        .collect()
}
