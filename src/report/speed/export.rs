//! The measurement for programs: CSV, a row for each method and number of samples, and JSON.

use std::{fmt::Write, io};

use hmac_sha256::Hash;
use serde::Serialize;
use serde_json::{Value, json};

use super::{
    measurement::{Measurement, Series, Times},
    statistics::median,
    summary::verdict,
};

/// A row of the CSV file. Times are in seconds, CPU times unless they are called wall; errors are in linear light. The exact method has a row without
/// samples, and a bound in place of errors.
#[derive(Default, Serialize)]
struct Row {
    method: &'static str,
    per_pixel: Option<u64>,
    samples: Option<u64>,
    runs: usize,
    seconds_median: f64,
    seconds_min: f64,
    seconds_max: f64,
    wall_median: f64,
    rays: Option<u64>,
    rmse: Option<f64>,
    rmse_min: Option<f64>,
    rmse_max: Option<f64>,
    slope: Option<f64>,
    slope_error: Option<f64>,
    bound: Option<f64>,
}

/// A row for each method and number of samples, after a row of names.
pub fn to_csv(measured: &Measurement) -> io::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for series in &measured.series {
        let fit = series.fit();
        for point in &series.points {
            let (rmse_min, rmse_max) = ends(&point.rmse);
            writer.serialize(Row {
                per_pixel: Some(point.per_pixel),
                samples: Some(samples(measured, point.per_pixel)),
                rays: Some(point.rays),
                rmse: Some(point.error()),
                rmse_min: Some(rmse_min),
                rmse_max: Some(rmse_max),
                slope: fit.map(|fit| fit.slope),
                slope_error: fit.and_then(|fit| fit.slope_error),
                ..row(series.method.name(), &point.times)
            })?;
        }
    }
    if let Some(exact) = &measured.exact {
        writer.serialize(Row {
            bound: Some(measured.reference.bound()),
            ..row("exact", exact)
        })?;
    }
    let bytes = writer.into_inner().map_err(io::Error::other)?;
    String::from_utf8(bytes).map_err(io::Error::other)
}

fn row(method: &'static str, times: &Times) -> Row {
    let (seconds_min, seconds_max) = ends(&times.cpu);
    Row {
        method,
        runs: times.cpu.len(),
        seconds_median: times.cpu(),
        seconds_min,
        seconds_max,
        wall_median: times.wall(),
        ..Row::default()
    }
}

/// All that was measured. A number that is not finite is null.
pub fn to_json(measured: &Measurement) -> Value {
    let whole = measured.whole();
    let (machine, reference) = (&measured.machine, &measured.reference);
    let exact = measured.exact.as_ref().map(|exact| {
        json!({"time": times(&exact.cpu), "wall": times(&exact.wall), "bound": reference.bound()})
    });
    let methods = measured.series.iter();
    let verdicts = measured
        .errors
        .iter()
        .map(|&error| verdict(measured, error));
    json!({
        "scene": measured.subject.name,
        "sha256": sha256(&measured.subject.recipe.scene),
        "overrides": measured.subject.recipe.overrides,
        "version": env!("CARGO_PKG_VERSION"),
        "machine": {"processor": machine.processor, "processors": machine.processors},
        "threads": measured.threads,
        "image": {"width": whole.width, "height": whole.height},
        "seed": measured.seed,
        "complete": !measured.interrupted,
        "runs": measured.runs(),
        "per_pixel": measured.rungs,
        "seconds": measured.seconds,
        "reference": {
            "method": "exact",
            "bound": reference.bound(),
            "root_mean_square_bound": reference.root_mean_square_bound(),
        },
        "exact": exact,
        "methods": methods.map(|series| of_series(measured, series)).collect::<Vec<_>>(),
        "verdicts": verdicts.collect::<Vec<_>>(),
    })
}

fn of_series(measured: &Measurement, series: &Series) -> Value {
    let fit = series.fit().map(
        |fit| json!({"slope": fit.slope, "slope_error": fit.slope_error, "points": fit.points}),
    );
    let needed = measured.errors.iter().map(|&error| {
        let needed = measured.needed(series, error);
        json!({
            "error": error,
            "per_pixel": needed.and_then(|needed| needed.per_pixel),
            "time": needed.map(|needed| needed.cpu),
            "wall": needed.map(|needed| needed.wall),
            "extrapolated": needed.map(|needed| needed.is_extrapolated),
        })
    });
    let points = series.points.iter().map(|point| {
        json!({
            "per_pixel": point.per_pixel,
            "samples": samples(measured, point.per_pixel),
            "time": times(&point.times.cpu),
            "wall": times(&point.times.wall),
            "rays": point.rays,
            "rmse": point.error(),
            "rmse_runs": point.rmse,
        })
    });
    json!({
        "method": series.method.name(),
        "measured": points.collect::<Vec<_>>(),
        "fit": fit,
        "needed": needed.collect::<Vec<_>>(),
    })
}

fn times(runs: &[f64]) -> Value {
    let (min, max) = ends(runs);
    json!({"median": median(runs), "min": min, "max": max, "runs": runs})
}

/// The samples of the whole picture.
fn samples(measured: &Measurement, per_pixel: u64) -> u64 {
    per_pixel.saturating_mul(measured.whole().pixels())
}

fn ends(values: &[f64]) -> (f64, f64) {
    let start = (f64::INFINITY, f64::NEG_INFINITY);
    let wider = |(low, high): (f64, f64), &value: &f64| (low.min(value), high.max(value));
    values.iter().fold(start, wider)
}

/// The SHA-256 (FIPS 180-4) of a text's bytes, as `sha256sum` prints it.
fn sha256(text: &str) -> String {
    let mut digits = String::new();
    for byte in Hash::hash(text.as_bytes()) {
        // Writing to a string does not fail.
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}
