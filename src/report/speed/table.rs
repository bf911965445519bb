//! The measurement as text for a terminal, and how its numbers are written everywhere.

use std::fmt::Write;

use super::{
    fit::{Fit, median},
    measure::{Measurement, Point, Series},
    needed::Needed,
    notes::{NOISY, has_empty_pixels, notes, spread, verdicts},
    ticks::ends,
};
use crate::{numbers, scene::Method, suggest};

/// What a slope's error means.
pub(super) const SLOPE: &str = "of the line through the logarithms of samples and error; ± covers its standard error and the slope between any \
     two points, tried ones among them, of which one has at least twice the samples of the other. Nothing is known of it from single runs. More samples than these may have another one.";

/// What the rates mean.
pub(super) const RATE: &str = "all samples by the time that they take, traced or not.";
pub(super) const RAYS: &str = "those of the samples that are traced, by the same time: where pixels are certain to show one colour, none is.";

/// What it means that fewer may do.
pub(super) const AT_MOST: &str = "whether fewer samples may do: these are the fewest that were measured, or the fewest of those that left no error at all.";

/// The tables of errors, of times and of what an error takes.
pub fn table(measured: &Measurement) -> String {
    let mut text = heading(measured);
    text += "\n";
    text += &errors(measured);
    text += "\n";
    text += &times(measured);
    for &wanted in &measured.errors {
        text += "\n";
        text += &needs(measured, wanted);
    }
    text += "\n";
    for verdict in verdicts(measured) {
        text += &wrapped(&verdict);
    }
    for note in notes(measured) {
        text += &wrapped(&format!("note: {note}"));
    }
    if !measured.series.is_empty() {
        text += &wrapped(
            "largest: the largest difference of any channel of any pixel, with the most samples.",
        );
        text += &wrapped(&format!("slope: {SLOPE}"));
        text += &wrapped(&format!("million samples/s: {RATE}"));
        text += &wrapped(&format!("million rays/s: {RAYS}"));
    }
    text
}

/// What was measured, and on what.
pub(super) fn heading(measured: &Measurement) -> String {
    let whole = measured.whole();
    let machine = &measured.machine;
    format!(
        "{}: {} × {} pixels, {} of each, seeds from {}\n{} on {} ({})\nreference: exact, every channel within {}\n",
        measured.subject.name,
        whole.width,
        whole.height,
        plural(measured.rounds() as u64, "run"),
        measured.seed,
        plural(measured.threads as u64, "thread"),
        machine.processor,
        plural(machine.processors as u64, "processor"),
        numbers::at_most(measured.reference.bound()),
    )
}

fn errors(measured: &Measurement) -> String {
    let mut text = format!("{:16}", "error");
    for rung in &measured.rungs {
        let _ = write!(text, "{rung:>9}");
    }
    text += match measured.series.is_empty() {
        true => "   largest\n",
        false => "   largest  slope\n",
    };
    for series in &measured.series {
        let _ = write!(text, "{:16}", series.method.name());
        for cell in cells(measured, series, |point| error(point.error())) {
            let _ = write!(text, "{cell:>9}");
        }
        let largest = series.points.last().map_or(0.0, |point| point.largest);
        let _ = writeln!(text, "{:>10}  {}", error(largest), marked_slope(series));
    }
    if measured.exact.is_some() {
        let width = 9 * measured.rungs.len() + 10;
        let bound = numbers::at_most(measured.reference.bound());
        let _ = writeln!(text, "{:16}{bound:>width$}", "exact, within");
    }
    text
}

fn times(measured: &Measurement) -> String {
    let mut text = format!("{:16}", "time");
    for rung in &measured.rungs {
        let _ = write!(text, "{rung:>9}");
    }
    text += match measured.series.is_empty() {
        true => "    spread\n",
        false => "    spread  million samples/s  million rays/s\n",
    };
    for series in &measured.series {
        let _ = write!(text, "{:16}", series.method.name());
        for cell in cells(measured, series, |point| seconds(point.seconds())) {
            let _ = write!(text, "{cell:>9}");
        }
        let widest = series.points.iter().map(|point| point.spread());
        let last = series.points.last();
        let samples = last.map_or(0.0, Point::samples_per_second);
        let rays = last.map_or(0.0, Point::rays_per_second);
        let _ = writeln!(
            text,
            "{:>10}{:>19.1}{:>16.1}",
            percent(widest.fold(0.0, f64::max), measured.rounds()),
            samples / 1e6,
            rays / 1e6
        );
    }
    if let Some(exact) = &measured.exact {
        let width = 9 * measured.rungs.len();
        let time = seconds(median(&exact.times));
        let _ = writeln!(
            text,
            "{:16}{time:^width$}{:>10}",
            "exact",
            percent(spread(&exact.times), exact.times.len())
        );
    }
    text
}

fn needs(measured: &Measurement, wanted: f64) -> String {
    let mut text = format!(
        "{:16}{:>9}{:>8}{:>9}\n",
        format!("for {}", error(wanted)),
        "samples",
        "× ÷",
        "time"
    );
    for series in &measured.series {
        let name = series.method.name();
        let _ = match measured.needed(series, wanted) {
            None => writeln!(text, "{name:16}{:>9}{:>8}{:>9}", "-", "", "-"),
            Some(needed) => {
                let extrapolated = match needed.is_extrapolated {
                    true => "  extrapolated",
                    false => "",
                };
                let tried =
                    tried(series, wanted).map_or(String::new(), |tried| format!("  {tried}"));
                writeln!(
                    text,
                    "{name:16}{:>9}{:>8}{:>9}{extrapolated}{tried}",
                    samples(&needed),
                    doubt(&needed),
                    time(&needed),
                )
            }
        };
    }
    if measured.exact.is_some() {
        let time = measured.exact_seconds(wanted);
        let time = time.map_or("-".to_owned(), seconds);
        let _ = writeln!(text, "{:16}{:>9}{:>8}{time:>9}", "exact", "-", "");
    }
    text
}

/// What came of the tries for an error, if there are any.
pub(super) fn tried(series: &Series, wanted: f64) -> Option<String> {
    let tries: Vec<&Point> = series.tries_for(wanted).map(|it| &it.point).collect();
    let made = match tries.len() {
        0 => return None,
        1 => "1 try".to_owned(),
        many => format!("{many} tries"),
    };
    let counts = range(tries.iter().map(|point| point.per_pixel as f64), count);
    let errors = range(tries.iter().map(|point| point.error()), error);
    Some(format!("{made}: {counts} left {errors}"))
}

/// The least and the greatest of some numbers (at least one).
fn range(numbers: impl Iterator<Item = f64>, written: fn(f64) -> String) -> String {
    let (least, greatest) = ends(numbers);
    let [least, greatest] = [least, greatest].map(written);
    match least == greatest {
        true => least,
        false => format!("{least} to {greatest}"),
    }
}

/// A cell for each number of samples; `-` where nothing was measured.
pub(super) fn cells(
    measured: &Measurement,
    series: &Series,
    cell: impl Fn(&Point) -> String,
) -> Vec<String> {
    let at = |rung: &u64| series.points.iter().find(|point| point.per_pixel == *rung);
    measured
        .rungs
        .iter()
        .map(|rung| at(rung).map_or("-".to_owned(), &cell))
        .collect()
}

/// The slope of a method's errors, marked where a note says what else is in it.
pub(super) fn marked_slope(series: &Series) -> String {
    let mark = if has_empty_pixels(series) { " *" } else { "" };
    format!("{}{mark}", slope(series.fit()))
}

/// A slope, and how far it may be off.
fn slope(fit: Option<Fit>) -> String {
    match fit {
        None => "-".to_owned(),
        Some(fit) => match fit.slope_error {
            None => format!("{:.3}", fit.slope),
            Some(error) => {
                // An error that is not 0 does not look as if it were.
                let digits = (3..9).find(|&digits| error * libm::exp10(f64::from(digits)) >= 0.5);
                let digits = digits.unwrap_or(3) as usize;
                format!("{:.digits$} ± {error:.digits$}", fit.slope)
            }
        },
    }
}

/// An error: whole fractions that somebody asks for as such, others with two digits.
pub(super) fn error(error: f64) -> String {
    let inverse = 1.0 / error;
    if (2.0..=65536.0).contains(&inverse)
        && inverse.fract() == 0.0
        && (inverse as u64).is_multiple_of(64)
    {
        format!("1/{inverse}")
    } else if error == 0.0 {
        "0".to_owned()
    } else if error < 1e-4 {
        format!("{error:.1e}")
    } else {
        significant(error, 3)
    }
}

/// A time in seconds or milliseconds, with three digits.
pub(super) fn seconds(seconds: f64) -> String {
    in_unit(seconds, 3)
}

fn in_unit(seconds: f64, digits: i32) -> String {
    if seconds < 0.9995 {
        format!("{} ms", significant(seconds * 1e3, digits))
    } else if seconds < 1e5 {
        format!("{} s", significant(seconds, digits))
    } else {
        format!("{seconds:.1e} s")
    }
}

/// The time that an error takes; of one that is extrapolated no more than the first digit is worth reading.
pub(super) fn time(needed: &Needed) -> String {
    match needed.is_extrapolated {
        true => {
            let unit = libm::exp10(libm::floor(libm::log10(needed.seconds.max(1e-300))));
            format!("~{}", in_unit((needed.seconds / unit).round() * unit, 1))
        }
        false => seconds(needed.seconds),
    }
}

/// How far what an error takes may be off, as a factor.
pub(super) fn doubt(needed: &Needed) -> String {
    match needed.factor {
        Some(factor) if factor < 100.0 => significant(factor, 3),
        Some(factor) => format!("{factor:.0e}"),
        None => "?".to_owned(),
    }
}

/// The samples that an error takes: "≤" stands where fewer were not measured.
pub(super) fn samples(needed: &Needed) -> String {
    let least = if needed.is_at_most { "≤ " } else { "" };
    format!("{least}{}", count(needed.per_pixel))
}

/// A number of samples.
pub(super) fn count(samples: f64) -> String {
    match samples < 1e7 {
        true => format!("{samples}"),
        false => format!("{samples:.1e}"),
    }
}

/// How far times spread, marked where they are noisy; nothing is known of a single one.
pub(super) fn percent(share: f64, runs: usize) -> String {
    if runs < 2 {
        return "-".to_owned();
    }
    let mark = if share > NOISY { "!" } else { "" };
    format!("{mark}{:.0} %", share * 100.0)
}

/// Methods in a sentence.
pub(super) fn method_list(methods: &[Method]) -> String {
    suggest::list(methods.iter().map(|method| method.name()))
}

pub(super) fn plural(count: u64, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// So many digits, not counting zeros in front; digits before the point all stay.
fn significant(number: f64, digits: i32) -> String {
    let before = libm::floor(libm::log10(number.max(1e-300))) as i32 + 1;
    let after = (digits - before).max(0) as usize;
    format!("{number:.after$}")
}

/// Lines of at most 100 characters.
fn wrapped(text: &str) -> String {
    let mut lines = String::new();
    let mut length = 0;
    for word in text.split(' ') {
        let width = word.chars().count() + 1;
        if length + width > 100 {
            lines += "\n ";
            length = 1;
        } else if length > 0 {
            lines += " ";
        }
        lines += word;
        length += width;
    }
    lines + "\n"
}
