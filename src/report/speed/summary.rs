//! Writes sentences and a table about a measurement, for a terminal and for an HTML page.

use super::{
    estimate::{Estimate, Ranking},
    notation::{BENDS, UNKNOWN, asked_error, factor, plural, samples, seconds, slope, time},
    results::{EndSlope, Measurement},
};
use crate::{diagnostic::visible_line, numbers, scene::Method, suggest};

/// A table with a row for each method.
pub struct SummaryTable {
    /// Column headings. A heading may contain a line feed, at which it is broken if the column is
    /// narrow.
    pub heads: Vec<String>,
    /// Rows of cells. The first cell is the method's name.
    pub rows: Vec<Vec<String>>,
}

/// CPU time, in seconds, below which methods are not compared by time. Starting the threads and
/// preparing the scene takes some milliseconds with every method. This time varies so much that it
/// would hide the differences between the methods.
const TOO_QUICK: f64 = 0.01;

/// Returns a line with the picture's size, the numbers of runs and of threads, and the machine.
pub fn heading(measured: &Measurement) -> String {
    let whole = measured.whole();
    let machine = &measured.machine;
    format!(
        "{} × {} pixels, {}, {} on {} ({})",
        whole.width,
        whole.height,
        plural(measured.runs(), "run"),
        plural(measured.threads, "thread"),
        printable(&machine.processor),
        plural(machine.processors, "processor"),
    )
}

/// Returns a recommendation for each error in `measured.errors`: a sentence that recommends a
/// method for reducing the error to this value.
pub fn verdicts(measured: &Measurement) -> Vec<String> {
    let verdict = |&error: &f64| verdict(measured, error);
    measured.errors.iter().map(verdict).collect()
}

/// Returns a sentence that recommends a method for reducing the error to `error`, with the reason
/// and other methods for comparison. Methods are compared by CPU time or, if some CPU time is below
/// 10 ms, by samples.
pub fn verdict(measured: &Measurement, error: f64) -> String {
    let Ranking { fastest, others } = measured.ranking(error);
    let wanted = asked_error(error);
    let Some((_, first)) = fastest.first() else {
        return format!("No method is known to reach an error of {wanted}.");
    };
    let basis = match (first.is_extrapolated, measured.runs()) {
        (false, 1) => "By one run alone, use",
        (false, _) => "Use",
        (true, 1) => "By extrapolation of one run, use",
        (true, _) => "By extrapolation, use",
    };
    let names = suggest::choice(fastest.iter().map(|(method, _)| method.name()));
    let is_exact = |(method, _): &&(Method, Estimate)| *method == Method::Exact;
    if let ([only], []) = (fastest.as_slice(), others.as_slice()) {
        let cost = cost(only);
        return format!(
            "{basis} {names} for an error of {wanted}, the only method that is known to reach it: {cost}."
        );
    }
    if let Some(by_samples) = by_samples(measured, error) {
        return format!("{basis} {by_samples}");
    }
    let last = fastest.last().map_or(*first, |(_, last)| *last);
    let [least, most] = [first, &last].map(|it| time(it, it.cpu));
    let why = match fastest.as_slice() {
        [(Method::Exact, _)] => format!("it takes {least} of CPU time and has no sampling error"),
        [(_, it)] => {
            format!(
                "it takes the least CPU time, {least}, with {}",
                per_pixel(it)
            )
        }
        all => {
            let mut range = least;
            if range != most {
                range += &format!(" to {most}");
            }
            let exact = all.iter().find(is_exact);
            let exact = exact.map_or("", |_| ", and exact has no sampling error");
            format!("they are about as fast, with {range} of CPU time{exact}")
        }
    };
    let next = others.iter().find(|it| !is_exact(it));
    let compared: Vec<_> = next
        .into_iter()
        .chain(others.iter().find(is_exact))
        .map(cost)
        .collect();
    let mut verdict = format!("{basis} {names} for an error of {wanted}: {why}.");
    if !compared.is_empty() {
        verdict += &format!(" For comparison, {}.", compared.join("; "));
    }
    verdict
}

/// Returns the end of a sentence that recommends the methods with the fewest samples for `error`.
/// Extrapolated estimates are ignored. Returns `None` if all other estimated CPU times are at least
/// [`TOO_QUICK`], because the methods can then be compared by time.
fn by_samples(measured: &Measurement, error: f64) -> Option<String> {
    let estimates = measured.series.iter().filter_map(|series| {
        let estimate = measured.estimate(series, error)?;
        (!estimate.is_extrapolated).then_some((series.method, estimate))
    });
    let estimates: Vec<(Method, Estimate)> = estimates.collect();
    if !estimates.iter().any(|(_, it)| it.cpu < TOO_QUICK) {
        return None;
    }
    let count = |(_, it): &(Method, Estimate)| it.per_pixel.unwrap_or(f64::INFINITY);
    let least = estimates.iter().map(count).fold(f64::INFINITY, f64::min);
    let (best, rest): (Vec<_>, Vec<_>) = estimates.iter().partition(|it| count(it) == least);
    let (_, first) = best.first()?;
    let names = suggest::choice(best.iter().map(|(method, _)| method.name()));
    let enough = match least {
        1.0 => "one sample per pixel is enough".to_owned(),
        _ => format!("{} are the fewest", per_pixel(first)),
    };
    let next = rest.iter().find(|(method, _)| *method == Method::Random);
    let next = next.or(rest.iter().min_by(|a, b| count(a).total_cmp(&count(b))));
    let mut compared: Vec<String> = next
        .map(|(method, it)| format!("{} needs {}", method.name(), samples(it)))
        .into_iter()
        .collect();
    compared.extend(
        measured
            .exact_estimate(error)
            .map(|it| cost(&(Method::Exact, it))),
    );
    let compared = match compared.as_slice() {
        [] => String::new(),
        all => format!(" For comparison, {}.", all.join("; ")),
    };
    Some(format!(
        "{names} for an error of {}: {enough}. Times below {} are too short to compare.{compared}",
        asked_error(error),
        seconds(TOO_QUICK, 2),
    ))
}

/// Returns a phrase with a method's CPU time and samples per pixel, as a part of a sentence.
fn cost((method, estimate): &(Method, Estimate)) -> String {
    let is_guess = estimate.is_extrapolated;
    let takes = if is_guess { "would take" } else { "takes" };
    let with = match estimate.per_pixel {
        None => "without error".to_owned(),
        Some(_) => format!("with {}", per_pixel(estimate)),
    };
    let (name, cpu) = (method.name(), time(estimate, estimate.cpu));
    format!("{name} {takes} {cpu}, {with}")
}

fn per_pixel(estimate: &Estimate) -> String {
    let is_one = estimate.per_pixel == Some(1.0);
    let noun = if is_one { "sample" } else { "samples" };
    format!("{} {noun} per pixel", samples(estimate))
}

/// Returns the table of methods, with a row for each method. A row contains the slope of the
/// logarithm of the error over the logarithm of the number of samples, and two factors that follow
/// from the slope. It also contains the samples, the CPU time and the elapsed time that the method
/// needs for each of `errors`.
pub fn table(measured: &Measurement, errors: &[f64]) -> SummaryTable {
    let mut heads = vec!["method".to_owned()];
    heads.extend(
        [
            "slope at\nthe end",
            "4 × samples\ndivide it by",
            "a tenth\ncosts",
        ]
        .map(str::to_owned),
    );
    for wanted in errors.iter().copied().map(asked_error) {
        let columns = ["samples", "CPU time", "wall time"];
        heads.extend(columns.map(|what| format!("{what}\nfor {wanted}")));
    }
    let row = |method: Method, slopes: [String; 3], estimates: Vec<Option<Estimate>>| {
        let cells = estimates.into_iter().flat_map(|estimate| match estimate {
            None => [UNKNOWN; 3].map(str::to_owned),
            Some(it) => [samples(&it), time(&it, it.cpu), time(&it, it.wall)],
        });
        let name = [method.name().to_owned()].into_iter();
        name.chain(slopes).chain(cells).collect()
    };
    let mut rows: Vec<_> = (measured.series.iter())
        .map(|series| {
            let estimates = errors.iter().map(|&error| measured.estimate(series, error));
            row(series.method, slopes(series.slope()), estimates.collect())
        })
        .collect();
    if measured.exact.is_some() {
        let estimates = errors.iter().map(|&error| measured.exact_estimate(error));
        rows.push(row(Method::Exact, Default::default(), estimates.collect()));
    }
    SummaryTable { heads, rows }
}

/// Returns the three cells about a slope. They contain the slope itself, the factor by which four
/// times as many samples divide the error, and the factor by which the number of samples must grow
/// to reduce the error to a tenth.
fn slopes(found: Option<EndSlope>) -> [String; 3] {
    let divisor = factor(found.and_then(|it| it.divisor()));
    let cost = found.and_then(|it| it.cost_of_a_tenth());
    let cost = cost.map_or(UNKNOWN.to_owned(), |cost| {
        format!("{} ×", factor(Some(cost)))
    });
    [slope(found), divisor, cost]
}

/// Returns sentences that explain the marks in the table, and the limits of the measurement.
pub fn notes(measured: &Measurement) -> Vec<String> {
    let bound = numbers::at_most(measured.reference.bound());
    let mut notes = vec![format!(
        "~ extrapolated; {UNKNOWN} not known; the exact picture is within {bound} of the truth in every channel."
    )];
    let mut slopes = measured.series.iter().filter_map(|series| series.slope());
    if slopes.any(|slope| slope.bends) {
        notes.push(format!(
            "{BENDS}: the last two parts of the line have different slopes, so that it has none yet; more samples would show it."
        ));
    }
    if measured.interrupted {
        notes.push("Interrupted: these are the runs that were made until then.".to_owned());
    }
    notes
}

/// Makes a text from outside, such as a file's name, safe to print and to put into XML. Control
/// characters are made visible. The two other characters that XML forbids, U+FFFE and U+FFFF, are
/// replaced.
pub fn printable(text: &str) -> String {
    visible_line(text).replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}
