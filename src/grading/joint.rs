//! Rows of the table that were made together: how a picture is laid out, what is seen in it, the
//! order of its channels, and how light is encoded.
//!
//! One of them alone may explain nothing: of a board whose squares are truncated nothing is seen in
//! a picture that is upside down. On the tiny grid all of them are tried together, before any
//! number is.

use super::{
    candidate::{Candidate, Mistake, Shows},
    judge::Judge,
    levenberg_marquardt::absolute,
    mistakes::ROWS,
    prediction::Prediction,
};

/// So many that leave least are tried with what changes light otherwise, and are looked at on the
/// coarse grid.
const BEST: usize = 8;

/// So many ways to see the scene and to lay it out are tried with what changes light, those of
/// which the picture shows the same in other light.
const ALIKE: usize = 32;

/// Another row has to leave less than this part of what is left without it.
const WORTH: f64 = 0.95;

/// What a row changes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Changes {
    Layout,
    Seen,
    Channels,
    Light,
}

fn changes(right: &Candidate, changed: &Candidate) -> Changes {
    if changed.layout != right.layout {
        return Changes::Layout;
    }
    match &changed.mistakes[..] {
        [.., Mistake::Row(row, _)] if matches!(row.id, "channels" | "gray") => Changes::Channels,
        _ if changed.curve != right.curve || changed.looks.len() != right.looks.len() => {
            Changes::Light
        }
        _ => Changes::Seen,
    }
}

/// How much what is seen and what is expected vary together, whatever was done to light: the
/// correlation of the sums of their channels, or what that is if light and dark are exchanged.
fn alike(shown: &Prediction) -> f64 {
    let (mut count, mut sums, mut products) = (0.0, [0.0; 2], [0.0; 3]);
    for (seen, mean) in shown.seen.iter().zip(&shown.moments.mean) {
        let [a, b] = [seen, mean].map(|light| light.iter().sum::<f64>());
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

/// Several rows that together leave little, and how much each leaves on the coarse grid.
pub fn rows_together(judge: &Judge, right: &Candidate) -> Vec<(f64, Candidate)> {
    let Some(tiny) = judge.tiny(right) else {
        return Vec::new();
    };
    let rows = ROWS.iter();
    // What is little is not told from what a JPEG does.
    let is_coded = judge.fine.jpeg.is_some();
    let rows = rows.filter(|row| match row.shows {
        Shows::InAreas => true,
        Shows::AtEdges => false,
        Shows::Everywhere => !is_coded && row.id != "cut_off",
    });
    let rows: Vec<(Changes, Mistake)> = rows
        .filter_map(|row| {
            let mistake = Mistake::Row(row, None);
            let changed = right.with(mistake.clone())?;
            Some((changes(right, &changed), mistake))
        })
        .collect();
    let of = |kind: Changes| {
        let rows = rows.iter().filter(move |(own, _)| *own == kind);
        rows.map(|(_, mistake)| mistake)
    };
    // The same without and with each.
    let with = |candidate: &Candidate, kinds: &[Changes]| {
        let mistakes = kinds.iter().flat_map(|kind| of(*kind));
        let changed = mistakes.filter_map(|mistake| candidate.with(mistake.clone()));
        let mut all = vec![candidate.clone()];
        all.extend(changed);
        all
    };
    let left = |candidate: Candidate| {
        judge.work.may_go_on().then_some(())?;
        let shown = judge.predicted(&candidate, &tiny)?;
        // A picture of one colour was told before.
        let mean = &shown.moments.mean;
        mean.iter().any(|one| *one != mean[0]).then_some(())?;
        let left = absolute(&shown.differences());
        let count = i32::try_from(candidate.mistakes.len()).unwrap_or(i32::MAX);
        Some((left / libm::pow(WORTH, f64::from(count)), candidate))
    };
    let least_first = |mut tried: Vec<(f64, Candidate)>| {
        tried.sort_by(|one, other| one.0.total_cmp(&other.0));
        tried.truncate(BEST);
        tried
    };
    // What is seen first: the same is made only once.
    let seen = with(right, &[Changes::Seen]).into_iter();
    let laid_out = seen.flat_map(|candidate| with(&candidate, &[Changes::Layout]));
    let alike = laid_out.filter_map(|candidate| {
        judge.work.may_go_on().then_some(())?;
        Some((alike(&judge.predicted(&candidate, &tiny)?), candidate))
    });
    let mut alike: Vec<(f64, Candidate)> = alike.collect();
    alike.sort_by(|one, other| other.0.total_cmp(&one.0));
    alike.truncate(ALIKE);
    let alike = alike.into_iter().map(|(_, candidate)| candidate);
    let lit = alike.flat_map(|candidate| with(&candidate, &[Changes::Channels, Changes::Light]));
    let best = least_first(lit.filter_map(left).collect());
    let both = best.iter().flat_map(|(_, candidate)| {
        let has = |kind: Changes| {
            let mut own = candidate.mistakes.iter();
            own.any(|own| matches!(own, Mistake::Row(row, _) if of(kind).any(|other| matches!(other, Mistake::Row(other, _) if std::ptr::eq(*row, *other)))))
        };
        let other = if has(Changes::Light) { Changes::Channels } else { Changes::Light };
        with(candidate, &[other])
    });
    let best = least_first(both.filter_map(left).collect());
    best.into_iter()
        .filter(|(_, candidate)| candidate.mistakes.len() > 1)
        .filter_map(|(_, candidate)| {
            let differences = judge.differences(&candidate, &judge.coarse)?;
            Some((absolute(&differences), candidate))
        })
        .collect()
}
