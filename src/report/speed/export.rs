//! The measurement for programs: CSV, a row for each method and number of samples, and JSON.

use std::fmt::Write;

use hmac_sha256::Hash;
use serde_json::{Value, json};

use super::{
    fit::median,
    measure::{Measurement, Point, Series},
    notes::{FACTOR, notes, spread, verdicts},
    table::{AT_MOST, RATE, RAYS, SLOPE},
    tried::Try,
};

/// A row for each method and number of samples, after a row of names. Times are in seconds, errors in linear light. Rows of samples that were
/// tried say for which error, and have no part in the slope. The exact method has a row without samples, and a bound in place of errors.
pub fn to_csv(measured: &Measurement) -> String {
    let mut text = "method,per_pixel,samples,runs,seconds_median,seconds_min,seconds_max,spread,samples_per_second,rays,rays_per_second,rmse,rmse_min,\
                    rmse_max,largest_error,slope,slope_error,bound,tried_for\n"
        .to_owned();
    for series in &measured.series {
        let fit = series.fit();
        let slope = fit.map_or(String::new(), |fit| fit.slope.to_string());
        let slope_error = fit.and_then(|fit| fit.slope_error);
        let slope_error = slope_error.map_or(String::new(), |error| error.to_string());
        for point in &series.points {
            let _ = writeln!(text, "{},{slope},{slope_error},,", columns(series, point));
        }
        for Try { wanted, point, .. } in &series.tries {
            let _ = writeln!(text, "{},,,,{wanted}", columns(series, point));
        }
    }
    if let Some(exact) = &measured.exact {
        let [fast, slow] = ends(&exact.times);
        let _ = writeln!(
            text,
            "exact,,,{},{},{fast},{slow},{},,,,,,,,,,{},",
            exact.times.len(),
            median(&exact.times),
            spread_cell(&exact.times),
            measured.reference.bound()
        );
    }
    text
}

/// The columns up to the largest error.
fn columns(series: &Series, point: &Point) -> String {
    let [fast, slow] = ends(&point.times);
    let [good, bad] = ends(&point.rmse);
    format!(
        "{},{},{},{},{},{fast},{slow},{},{},{},{},{},{good},{bad},{}",
        series.method.name(),
        point.per_pixel,
        point.samples,
        point.times.len(),
        point.seconds(),
        spread_cell(&point.times),
        point.samples_per_second(),
        point.rays,
        point.rays_per_second(),
        point.error(),
        point.largest
    )
}

/// All that was measured. A number that is not finite is null.
pub fn to_json(measured: &Measurement) -> Value {
    let whole = measured.whole();
    let reference = &measured.reference;
    let exact = measured.exact.as_ref().map(|exact| {
        json!({
            "time": times(&exact.times),
            "bound": reference.bound(),
        })
    });
    json!({
        "scene": measured.subject.name,
        "sha256": sha256(&measured.subject.recipe.scene),
        "overrides": measured.subject.recipe.overrides,
        "version": env!("CARGO_PKG_VERSION"),
        "machine": {"processor": measured.machine.processor, "processors": measured.machine.processors},
        "threads": measured.threads,
        "image": {"width": whole.width, "height": whole.height},
        "seed": measured.seed,
        "complete": !measured.interrupted,
        "warm_up": measured.is_warm_up,
        "planned_runs": measured.runs,
        "runs": measured.rounds(),
        "per_pixel": measured.rungs,
        "seconds": measured.seconds,
        "reference": {
            "method": "exact",
            "bound": reference.bound(),
            "root_mean_square_bound": reference.root_mean_square_bound(),
        },
        "exact": exact,
        "methods": measured.series.iter().map(|series| of_series(measured, series)).collect::<Vec<_>>(),
        "verdicts": verdicts(measured),
        "notes": notes(measured),
        "about": {"slope_error": SLOPE, "factor": FACTOR, "at_most": AT_MOST, "samples_per_second": RATE, "rays": RAYS},
    })
}

fn of_series(measured: &Measurement, series: &Series) -> Value {
    let fit = series.fit().map(|fit| {
        json!({
            "slope": fit.slope,
            "slope_error": fit.slope_error,
            "slope_error_residuals": fit.residual_error,
            "slope_error_runs": fit.measured_error,
            "slope_error_bend": fit.bend,
            "points": fit.points,
        })
    });
    let errors = measured.errors.iter();
    let needed = errors.map(|&error| match measured.needed(series, error) {
        None => {
            json!({"error": error, "per_pixel": null, "at_most": null, "factor": null, "time": null, "extrapolated": null, "rests_on_tries": 0, "tries": []})
        }
        Some(needed) => json!({
            "error": error,
            "per_pixel": needed.per_pixel,
            "at_most": needed.is_at_most,
            "factor": needed.factor,
            "time": needed.seconds,
            "extrapolated": needed.is_extrapolated,
            "rests_on_tries": needed.tries,
            "tries": series.tries_for(error).map(
                |Try { seed, point, .. }| json!({
                    "per_pixel": point.per_pixel,
                    "seed": seed,
                    "time": point.seconds(),
                    "rmse": point.error(),
                    "largest_error": point.largest,
                }),
            ).collect::<Vec<_>>(),
        }),
    });
    json!({
        "method": series.method.name(),
        "measured": series.points.iter().map(of_point).collect::<Vec<_>>(),
        "fit": fit,
        "needed": needed.collect::<Vec<_>>(),
    })
}

fn of_point(point: &Point) -> Value {
    json!({
        "per_pixel": point.per_pixel,
        "samples": point.samples,
        "time": times(&point.times),
        "samples_per_second": point.samples_per_second(),
        "rays": point.rays,
        "rays_per_second": point.rays_per_second(),
        "rmse": point.error(),
        "rmse_runs": point.rmse,
        "largest_error": point.largest,
    })
}

fn times(times: &[f64]) -> Value {
    let [min, max] = ends(times);
    json!({"median": median(times), "min": min, "max": max, "spread": known_spread(times), "runs": times})
}

fn ends(values: &[f64]) -> [f64; 2] {
    [
        values.iter().copied().fold(f64::INFINITY, f64::min),
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    ]
}

/// The SHA-256 (FIPS 180-4) of a text's bytes, as `sha256sum` prints it.
pub(super) fn sha256(text: &str) -> String {
    let mut digits = String::new();
    for byte in Hash::hash(text.as_bytes()) {
        let _ = write!(digits, "{byte:02x}");
    }
    digits
}

/// How far times spread; nothing is known of a single one.
fn known_spread(times: &[f64]) -> Option<f64> {
    (times.len() > 1).then(|| spread(times))
}

/// The same in a table, where nothing stands for what is not known.
fn spread_cell(times: &[f64]) -> String {
    known_spread(times).map_or_else(String::new, |spread| spread.to_string())
}
