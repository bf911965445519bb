//! Writes a measurement for other programs: as CSV, with a row for each method and number of
//! samples, and as JSON.

use std::io;

use serde::Serialize;
use serde_json::{Value, json};

use super::{
    estimate::Estimate,
    results::{EndSlope, Measurement, MethodSeries, Run, end},
    summary::verdicts,
};

/// A row of the CSV file. Times are medians in seconds: CPU time in `time`, and elapsed time in
/// `wall`. Errors are in linear light. The exact method uses no samples, so its row contains an
/// error bound instead of the number of samples, the error and the slope. The slope is also left
/// out if the line of errors bends ([`EndSlope`]).
#[derive(Default, Serialize)]
struct CsvRow {
    method: &'static str,
    per_pixel: Option<u64>,
    runs: usize,
    time: f64,
    wall: f64,
    rmse: Option<f64>,
    slope: Option<f64>,
    slope_error: Option<f64>,
    bound: Option<f64>,
}

/// Returns the measurement as CSV: a row of column names, then a row for each method and number of
/// samples.
///
/// # Errors
///
/// Fails if a row cannot be written.
pub fn to_csv(measured: &Measurement) -> io::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for series in &measured.series {
        let slope = series.slope().filter(|slope| !slope.bends);
        for point in &series.points {
            writer.serialize(CsvRow {
                per_pixel: Some(point.per_pixel),
                rmse: Some(point.typical().error),
                slope: slope.map(|it| it.slope),
                slope_error: slope.and_then(|it| it.error),
                ..row(series.method.name(), &point.runs)
            })?;
        }
    }
    if let Some(exact) = &measured.exact {
        writer.serialize(CsvRow {
            bound: Some(measured.reference.bound()),
            ..row("exact", exact)
        })?;
    }
    let bytes = writer.into_inner().map_err(io::Error::other)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

fn row(method: &'static str, runs: &[Run]) -> CsvRow {
    let Run { cpu, wall, .. } = Run::typical(runs);
    CsvRow {
        method,
        runs: runs.len(),
        time: cpu,
        wall,
        ..CsvRow::default()
    }
}

/// Converts runs to JSON: the median times and the root mean square error of all runs, and the
/// values of each run.
fn of_runs(runs: &[Run]) -> Value {
    let each = |number: fn(&Run) -> f64| runs.iter().map(number).collect::<Vec<_>>();
    let Run { cpu, wall, error } = Run::typical(runs);
    json!({
        "time": cpu,
        "wall": wall,
        "rmse": error,
        "runs": {"time": each(|run| run.cpu), "wall": each(|run| run.wall), "rmse": each(|run| run.error)},
    })
}

/// Converts a measurement to JSON. Numbers that are not finite become null.
pub fn to_json(measured: &Measurement) -> Value {
    let whole = measured.whole();
    let (machine, reference) = (&measured.machine, &measured.reference);
    let exact = measured.exact.as_ref().map(|runs| {
        let mut exact = of_runs(runs);
        exact["bound"] = reference.bound().into();
        exact
    });
    let method = |series| of_series(measured, series);
    json!({
        "scene": measured.subject.name,
        "overrides": measured.subject.overrides,
        "version": env!("CARGO_PKG_VERSION"),
        "machine": {"processor": machine.processor, "processors": machine.processors},
        "threads": measured.threads,
        "image": {"width": whole.width, "height": whole.height},
        "seed": measured.seed,
        "complete": !measured.interrupted,
        "runs": measured.runs(),
        "per_pixel": measured.rungs,
        "reference": {
            "method": "exact",
            "bound": reference.bound(),
            "root_mean_square_bound": reference.root_mean_square_bound(),
        },
        "mixed_pixels": {"edges": measured.mixture.edges, "board": measured.mixture.board},
        "exact": exact,
        "methods": measured.series.iter().map(method).collect::<Vec<_>>(),
        "verdicts": verdicts(measured),
    })
}

fn of_series(measured: &Measurement, series: &MethodSeries) -> Value {
    let slope = |found: EndSlope| {
        json!({
            "slope": found.slope,
            "slope_error": found.error,
            "bends": found.bends,
            "per_pixel": end(&series.points).iter().map(|point| point.per_pixel).collect::<Vec<_>>(),
        })
    };
    let needed = measured.errors.iter().map(|&error| {
        let estimate = measured.estimate(series, error);
        let number = |pick: fn(&Estimate) -> f64| estimate.as_ref().map(pick);
        json!({
            "error": error,
            "per_pixel": estimate.and_then(|estimate| estimate.per_pixel),
            "time": number(|estimate| estimate.cpu),
            "least_time": number(|estimate| estimate.cpu_runs[0]),
            "greatest_time": number(|estimate| estimate.cpu_runs[1]),
            "wall": number(|estimate| estimate.wall),
            "extrapolated": estimate.map(|estimate| estimate.is_extrapolated),
        })
    });
    let points = series.points.iter().map(|point| {
        let mut found = of_runs(&point.runs);
        found["per_pixel"] = point.per_pixel.into();
        found
    });
    json!({
        "method": series.method.name(),
        "measured": points.collect::<Vec<_>>(),
        "fit": series.slope().map(slope),
        "needed": needed.collect::<Vec<_>>(),
    })
}
