//! What a measurement says in words and in one table, for a terminal and for a page alike.

use super::{
    measurement::Measurement,
    needed::Needed,
    units::{UNKNOWN, error, plural, samples, slope, time},
};
use crate::{diagnostic::visible, numbers, scene::Method};

/// A line for each method.
pub struct Table {
    /// What the columns hold; a line feed stands where a narrow column may break.
    pub heads: Vec<String>,
    /// A method's name and its cells.
    pub rows: Vec<Vec<String>>,
}

/// What was measured, how often and on what.
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

/// Which method to use for an error, and why.
pub fn verdict(measured: &Measurement, wanted: f64) -> String {
    let all = measured.fastest(wanted);
    let wanted = error(wanted);
    let told = |(method, needed): &(Method, Needed)| {
        let (name, cpu) = (method.name(), time(needed, needed.cpu));
        match needed.per_pixel {
            None => format!("{name} takes {cpu}, without error"),
            Some(_) => format!("{name} takes {cpu}, with {}", per_pixel(needed)),
        }
    };
    let [first, rest @ ..] = all.as_slice() else {
        return format!("No method is known to come to an error of {wanted}.");
    };
    let (method, needed) = first;
    let cpu = time(needed, needed.cpu);
    match (method, rest.first()) {
        (_, None) => format!(
            "Of these methods, one is known to come to an error of {wanted}: {}.",
            told(first)
        ),
        (Method::Exact, Some(next)) => format!(
            "Use exact: it takes {cpu} of CPU time and makes no error. The fastest sampling method takes longer for an error of {wanted}: {}.",
            told(next)
        ),
        (_, Some(next)) => {
            let exact = rest[1..]
                .iter()
                .find(|(method, _)| *method == Method::Exact);
            let others: Vec<_> = [next].into_iter().chain(exact).map(told).collect();
            format!(
                "Use {}: it comes to an error of {wanted} in the least CPU time, {cpu}, with {}. For comparison, {}.",
                method.name(),
                per_pixel(needed),
                others.join("; ")
            )
        }
    }
}

fn per_pixel(needed: &Needed) -> String {
    let one = if needed.per_pixel == Some(1.0) {
        ""
    } else {
        "s"
    };
    format!("{} sample{one} per pixel", samples(needed))
}

/// For each method its slope, and for each error the samples, the CPU time and the wall time that it takes.
pub fn table(measured: &Measurement) -> Table {
    let mut heads = vec!["method".to_owned(), "slope of\nthe error".to_owned()];
    for wanted in measured.errors.iter().map(|&wanted| error(wanted)) {
        let columns = ["samples", "CPU time", "wall time"];
        heads.extend(columns.map(|what| format!("{what}\nfor {wanted}")));
    }
    let cells = |needed: Option<Needed>| match needed {
        None => [UNKNOWN; 3].map(str::to_owned),
        Some(it) => [samples(&it), time(&it, it.cpu), time(&it, it.wall)],
    };
    let row = |method: Method, slope: String, needed: &dyn Fn(f64) -> Option<Needed>| {
        let mut row = vec![method.name().to_owned(), slope];
        row.extend(
            measured
                .errors
                .iter()
                .flat_map(|&wanted| cells(needed(wanted))),
        );
        row
    };
    let sampled = measured.series.iter().map(|series| {
        let needed = |wanted| measured.needed(series, wanted);
        row(series.method, slope(series.fit()), &needed)
    });
    let needed = |wanted| measured.exact_needed(wanted);
    let exact = measured
        .exact
        .iter()
        .map(|_| row(Method::Exact, String::new(), &needed));
    Table {
        heads,
        rows: sampled.chain(exact).collect(),
    }
}

/// How to read the table.
pub fn notes(measured: &Measurement) -> Vec<String> {
    let bound = numbers::at_most(measured.reference.bound());
    let mut notes = vec![format!(
        "~ extrapolated; {UNKNOWN} not known; exact is within {bound} of the truth in every channel."
    )];
    if measured.interrupted {
        notes.push("Interrupted: these are the runs that were made until then.".to_owned());
    }
    notes
}

/// Text from outside as it may stand anywhere: with controls made visible, and without the two characters that XML cannot hold even so.
pub fn printable(text: &str) -> String {
    visible(text).replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}
