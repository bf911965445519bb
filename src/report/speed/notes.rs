//! What a reader of the numbers has to know: how they compare, and what is wrong with them.

use super::{
    fit::median,
    measure::{Measurement, Point, Series},
    needed::{Fastest, Needed},
    table::{error, method_list, plural, seconds, time},
};
use crate::numbers::at_most;
use crate::scene::Method;

/// Times of the same work that spread by more than this share of their median, from the least to the greatest, are called noisy.
pub const NOISY: f64 = 0.2;

/// Where tries at counts between the planned ones left so many times as much as the line says, a note tells.
const UNLIKE: f64 = 1.1;

/// What the factor of what an error takes means.
pub(super) const FACTOR: &str = "19 renders of 20 with so many times as many samples leave no more than the error, and renders with so many times as few no less, in the mean of squares. It comes from how much the \
     tries differ, each of which has a seed and mostly a count of its own; with fewer than three tries, of random and scatter, from how much runs of one count do, too, and without any from how far the line may be off: between two points as much as it may sag, \
     and of what is extrapolated as much as by the slope between any other two points or by −1/2. It is not known (?) with fewer than three tries of the other methods, which like powers of two, or squares, better than counts beside them, \
     nor of regular, whose grid falls into step with the picture, unless these very samples were measured; nor where the fewest that were measured are enough and more than one (≤), or may be so by luck.";

/// A machine whose last round took so much more or less time than its first, in the median, is said to have changed.
const DRIFT: f64 = 0.1;

impl Point {
    /// How far the times spread: (greatest − least) / median.
    pub fn spread(&self) -> f64 {
        spread(&self.times)
    }
}

/// How far times spread: (greatest − least) / median.
pub(super) fn spread(times: &[f64]) -> f64 {
    let greatest = times.iter().copied().fold(0.0, f64::max);
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    (greatest - least) / median(times)
}

/// The outcome in sentences: one for each error that is asked for.
pub fn verdicts(measured: &Measurement) -> Vec<String> {
    let exact = measured.exact.as_ref().map(|exact| {
        let bound = measured.reference.bound();
        format!(
            "exact: {}, within {}",
            seconds(median(&exact.times)),
            at_most(bound)
        )
    });
    let verdict = |&wanted: &f64| {
        let sampled = measured.fastest(wanted).map(|fastest| match fastest {
            Fastest::All => all(measured, wanted),
            Fastest::Of(methods) => of_methods(&methods, wanted),
        });
        let parts: Vec<_> = [exact.clone(), sampled].into_iter().flatten().collect();
        (!parts.is_empty()).then(|| parts.join("; "))
    };
    measured.errors.iter().filter_map(verdict).collect()
}

/// What is said where the fewest samples are enough for all.
fn all(measured: &Measurement, wanted: f64) -> String {
    let firsts = || {
        let points = measured.series.iter();
        points.filter_map(|series| series.points.first())
    };
    let worst = firsts().map(Point::error).fold(0.0, f64::max);
    let fewest = firsts().map(|point| point.per_pixel).max().unwrap_or(1);
    let error = match worst {
        0.0 => "no error at all".to_owned(),
        _ => format!("an error of {} or less", error(wanted)),
    };
    format!(
        "every sampled method had {error} with {} per pixel already, in {}, so that none is the fastest to come there",
        plural(fewest, "sample"),
        plural(measured.rounds() as u64, "run")
    )
}

fn of_methods(methods: &[(Method, Needed)], wanted: f64) -> String {
    let (unknown, known): (Vec<_>, Vec<_>) =
        methods.iter().partition(|(_, needed)| needed.is_unknown());
    let [names, unknown] =
        [known, unknown].map(|them| them.iter().map(|(it, _)| *it).collect::<Vec<_>>());
    let (method, needed) = methods[0];
    let samples = plural(needed.per_pixel as u64, "sample");
    let found = match needed.is_extrapolated {
        false => "",
        true => ", extrapolated",
    };
    let (time, wanted) = (time(&needed), error(wanted));
    if needed.is_unknown() {
        return format!(
            "which sampled method is the fastest is not known, as nothing is of how far off they are; {} should need {time} for an error of \
             {wanted} ({samples} per pixel{found})",
            method.name()
        );
    }
    let fastest = match names.as_slice() {
        [one] => format!(
            "the fastest sampled method, {}, needs {time} for an error of {wanted} ({samples} per pixel{found})",
            one.name()
        ),
        several => format!(
            "the fastest sampled methods, {}, cannot be told apart; {} needs {time} for an error of {wanted} ({samples} per pixel{found})",
            method_list(several),
            method.name()
        ),
    };
    match unknown.is_empty() {
        true => fastest,
        false => format!(
            "{fastest}; how long {} would take is not known",
            method_list(&unknown)
        ),
    }
}

/// What is to be kept in mind of the numbers.
pub fn notes(measured: &Measurement) -> Vec<String> {
    let mut notes = Vec::new();
    if measured.is_warm_up {
        notes.push(
            "Incomplete: it was interrupted before the first run was over. These are the runs of the warm-up, all with one seed, whose times \
             are those of a cold machine, in no mixed order."
                .to_owned(),
        );
    } else if measured.interrupted && measured.is_measured() {
        notes.push("Incomplete: it was interrupted while answers were tried.".to_owned());
    } else if measured.interrupted {
        notes.push(format!(
            "Incomplete: it was interrupted in run {} of {}.",
            measured.rounds().max(1),
            measured.runs
        ));
    } else if (measured.rounds() as u64) < measured.runs {
        notes.push(format!(
            "{} of {} planned runs were made: the time was up.",
            measured.rounds(),
            measured.runs
        ));
    }
    if measured.rounds() == 1 {
        notes.push("Each time is that of a single run: nothing is known of its spread.".to_owned());
    }
    notes.extend(noise(measured));
    notes.extend(drift(measured));
    notes.extend(extrapolation(measured));
    notes.extend(unlike_counts(measured));
    let bound = measured.reference.root_mean_square_bound();
    let errors = measured.errors.iter().copied();
    for wanted in errors.filter(|&wanted| !measured.tells(wanted)) {
        notes.push(format!(
            "An error of {} cannot be told from none: the reference itself is known to {} only, in the mean of squares.",
            error(wanted),
            at_most(bound)
        ));
    }
    let flat = measured.series.iter().filter(|series| {
        let mut errors = series.points.iter().map(Point::error);
        errors.any(|error| error <= bound)
    });
    let flat: Vec<_> = flat.map(|series| series.method).collect();
    if !flat.is_empty() {
        notes.push(format!(
            "{} came as near as the reference is known; no slope is fitted to an error of 0.",
            method_list(&flat)
        ));
    }
    let mut scatter = measured
        .series
        .iter()
        .filter(|series| series.method == Method::Scatter);
    if let Some(scatter) = scatter.next() {
        let slope = match has_empty_pixels(scatter) {
            true => {
                "; the slope (*) has the errors of those in it, and is steeper than that of more samples"
            }
            false => "",
        };
        notes.push(format!(
            "scatter lets its samples fall anywhere in the picture: with n per pixel on average a share of about exp(−n) of the \
             pixels gets none (37 % at 1, 2 % at 4) and shows the background instead{slope}."
        ));
    }
    notes
}

/// Whether there is a line through a method's errors, and it goes through some of pictures in which more than a thousandth of the pixels has no sample: with n
/// that fall anywhere, a share of about exp(−n).
pub(super) fn has_empty_pixels(series: &Series) -> bool {
    let few = |point: &Point| libm::exp(-(point.per_pixel as f64)) > 1e-3;
    let is_there = series.method == Method::Scatter && series.fit().is_some();
    is_there && series.points.iter().any(few)
}

fn extrapolation(measured: &Measurement) -> Option<String> {
    let needs = |series: &Series| {
        let needs = measured
            .errors
            .iter()
            .filter_map(|&error| measured.needed(series, error));
        needs.into_iter().any(|needed| needed.is_extrapolated)
    };
    let goes_on = match measured.series.iter().any(needs) {
        true => {
            "What is extrapolated goes on with the slope between the last of what was measured. "
        }
        false => "",
    };
    let is_asked = !(measured.errors.is_empty() || measured.series.is_empty());
    is_asked.then(|| format!("{goes_on}× and ÷: {FACTOR}"))
}

/// The planned counts are those that most methods like best: what tries left at others.
fn unlike_counts(measured: &Measurement) -> Option<String> {
    // Independent samples do not care how many they are: theirs would be noise.
    let others = measured.series.iter().filter(|it| !it.is_independent());
    let unlike = others.filter_map(|series| {
        let (least, greatest) = series.beside_line()?;
        (greatest > UNLIKE).then(|| format!("{} {least:.2} to {greatest:.2}", series.method.name()))
    });
    let unlike: Vec<_> = unlike.collect();
    (!unlike.is_empty()).then(|| {
        format!(
            "Powers of 4 suit some methods better than other counts do, and slopes are of them alone. At counts between them, single tries left so many times what the \
             straight line between the two says: {}.",
            unlike.join(", ")
        )
    })
}

/// Of how many combinations of method and samples the times are noisy, the exact method's among them.
pub(super) fn noisy(measured: &Measurement) -> usize {
    spreads(measured).filter(|&(.., it)| it > NOISY).count()
}

/// Each method, its samples per pixel, if it takes samples, and how far its times spread.
fn spreads(measured: &Measurement) -> impl Iterator<Item = (Method, Option<u64>, f64)> {
    let sampled = measured.series.iter().flat_map(|series| {
        let points = series.points.iter();
        points.map(|point| (series.method, Some(point.per_pixel), point.spread()))
    });
    let exact = measured.exact.iter();
    sampled.chain(exact.map(|exact| (Method::Exact, None, spread(&exact.times))))
}

fn noise(measured: &Measurement) -> Option<String> {
    let count = noisy(measured);
    let (method, per_pixel, worst) = spreads(measured).max_by(|(.., a), (.., b)| a.total_cmp(b))?;
    let samples = per_pixel.map_or(String::new(), |per_pixel| {
        format!(" with {per_pixel} per pixel")
    });
    (count > 0).then(|| {
        format!(
            "The machine was noisy: of {} of method and samples, {count} have times that spread by more than {} % of \
             their median, from the least to the greatest; the worst is {}{samples}, {:.0} %.",
            plural(spreads(measured).count() as u64, "combination"),
            NOISY * 100.0,
            method.name(),
            worst * 100.0
        )
    })
}

fn drift(measured: &Measurement) -> Option<String> {
    let rounds = measured.rounds();
    let points = measured.series.iter().flat_map(|series| &series.points);
    let ratios: Vec<_> = points
        .filter(|point| rounds > 1 && point.times.len() == rounds)
        .map(|point| point.times[rounds - 1] / point.times[0])
        .collect();
    let ratio = median(&ratios);
    (!ratios.is_empty() && (ratio - 1.0).abs() > DRIFT).then(|| {
        format!(
            "The machine changed while it measured: the last run of everything took {ratio:.2} times as long as the first, in the median."
        )
    })
}
