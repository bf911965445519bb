//! Numbers about numbers: slopes, quantiles, and what an error takes.

use pinhole::{
    report::speed::{
        Check, Point, Series,
        fit::{Fit, log_error, median, quantile, root_mean_square},
    },
    scene::Method,
};

#[test]
fn a_power_law_is_fitted_exactly() {
    let points = [1.0, 4.0, 16.0, 64.0].map(|n: f64| (n, 0.3 / (n * n.sqrt()).sqrt()));
    let fit = Fit::of(&points).unwrap();
    assert!((fit.slope + 0.75).abs() < 1e-14, "{}", fit.slope);
    assert!(fit.slope_error.unwrap() < 1e-14);
    assert_eq!(fit.points, 4);
    assert!((fit.at(16.0) - 0.0375).abs() < 1e-14);
    assert!((fit.reaches(0.0375).unwrap() - 16.0).abs() < 1e-11);
}

#[test]
fn the_slopes_uncertainty_is_that_of_the_textbook() {
    // In units of ln 2: x = 0, 1, 2, 3 and y = 0, −1, −1, −2 has x̄ = 1.5, ȳ = −1, S = 5, b = −3/5, residuals −0.1, 0.3, −0.3, 0.1
    // but for signs, Σr² = 0.2, and the standard error √(0.2 / 2 / 5) = √0.02.
    let fit = Fit::of(&[(1.0, 1.0), (2.0, 0.5), (4.0, 0.5), (8.0, 0.25)]).unwrap();
    assert!((fit.slope + 0.6).abs() < 1e-14);
    assert!((fit.slope_error.unwrap() - 0.02f64.sqrt()).abs() < 1e-14);
}

#[test]
fn points_on_a_line_by_luck_have_the_uncertainty_of_their_runs() {
    // Squares 1 and 3: mean 2, variance 2, so √(2/2) / (2 · 2).
    let error = log_error(&[1.0, 3.0f64.sqrt()]).unwrap();
    assert!((error - 0.25).abs() < 1e-15, "{error}");
    assert_eq!((log_error(&[1.0]), log_error(&[])), (None, None));
    assert_eq!(log_error(&[0.5, 0.5, 0.5]), Some(0.0));
    // No residuals, and every ln y known to 0.1: 0.1/√S, S = 5 ln² 2.
    let points = [1.0, 2.0, 4.0, 8.0].map(|n: f64| (n, 0.3 / n));
    let fit = Fit::of_measured(&points, &[Some(0.1); 4]).unwrap();
    let expected = 0.1 / (5.0f64.sqrt() * std::f64::consts::LN_2);
    assert!((fit.slope_error.unwrap() - expected).abs() < 1e-14);
    assert!(fit.residual_error.unwrap() < 1e-14);
    // One point of which nothing is known; and residuals that say more.
    let errors = [Some(0.1), None, Some(0.1), Some(0.1)];
    assert_eq!(Fit::of_measured(&points, &errors), Fit::of(&points));
    let bent = [(1.0, 1.0), (2.0, 0.5), (4.0, 0.5), (8.0, 0.25)];
    let fit = Fit::of_measured(&bent, &[Some(1e-3); 4]).unwrap();
    assert_eq!(fit.slope_error, fit.residual_error);
}

/// Numbers of samples with their seconds and errors, each of two runs with a standard error of ε ln e = 0.01.
fn series(points: &[(u64, f64, f64)]) -> Series {
    let point = |&(per_pixel, seconds, error): &(u64, f64, f64)| Point {
        per_pixel,
        samples: 100 * per_pixel,
        times: vec![seconds; 2],
        // Squares of 1 ± q have a variance of 2q² and a mean of 1: an error of √(2q²/2)/2.
        rmse: [1.02, 0.98]
            .map(|square: f64| error * square.sqrt())
            .to_vec(),
        largest: 1.0,
    };
    Series {
        method: Method::Sobol,
        points: points.iter().map(point).collect(),
        picture: None,
        checks: Vec::new(),
    }
}

#[test]
fn what_an_error_takes_lies_between_the_points_on_either_side() {
    let straight = series(&[(1, 0.5, 0.4), (4, 1.0, 0.2), (16, 3.0, 0.1)]);
    let needed = straight.needed(0.1414214).unwrap();
    assert_eq!((needed.per_pixel, needed.is_extrapolated), (8.0, false));
    assert!((needed.seconds - 5.0 / 3.0).abs() < 1e-12, "{needed:?}");
    // Half-way between two: √(¼ + ¼) · 0.01 by a slope of ½; and what the line may sag there, 0.2 of log 2 twice.
    let (noise, sag) = (0.02 * 0.5f64.sqrt(), 0.2 * libm::log(2.0) * libm::log(2.0));
    let factor = libm::exp(libm::hypot(noise, sag));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-6, "{needed:?}");
    // As far beyond the last one: √(1 + 4) · 0.01 by ½; the time on the line from the first to the last.
    let needed = straight.needed(0.0500001).unwrap();
    assert_eq!((needed.per_pixel, needed.is_extrapolated), (64.0, true));
    assert!((needed.seconds - 11.0).abs() < 1e-12, "{needed:?}");
    let factor = libm::exp(0.02 * 5.0f64.sqrt());
    assert!((needed.factor.unwrap() - factor).abs() < 1e-5, "{needed:?}");

    // A line that flattens is followed where it ends, and doubted as far as the straight one is away.
    let mut bent = series(&[(1, 1.0, 0.4), (4, 1.0, 0.1), (16, 1.0, 0.05)]);
    let needed = bent.needed(0.0250001).unwrap();
    assert_eq!((needed.per_pixel, needed.seconds), (64.0, 1.75));
    let straight = bent.fit().unwrap().reaches(0.0250001).unwrap();
    assert!((needed.factor.unwrap() - 64.0 / straight).abs() < 1e-3);
    assert!(straight < 50.0);
    // What was tried is a point as well.
    let tried = |per_pixel, error| Check {
        wanted: 0.0250001,
        point: Point {
            rmse: vec![error],
            times: vec![2.0],
            ..series(&[(per_pixel, 2.0, error)]).points[0].clone()
        },
    };
    bent.checks.push(tried(64, 0.03));
    let needed = bent.needed(0.0250001).unwrap();
    assert!(needed.is_extrapolated && needed.per_pixel > 64.0);
    bent.checks.push(tried(100, 0.02));
    let needed = bent.needed(0.0250001).unwrap();
    assert!(!needed.is_extrapolated && (64.0..100.0).contains(&needed.per_pixel));
    assert!(needed.factor.unwrap() > libm::exp(0.01) && needed.seconds == 2.0);
    // Where more samples do not help nothing is promised.
    assert_eq!(series(&[(1, 1.0, 0.4), (4, 1.0, 0.4)]).needed(0.1), None);
    // No error at all is one that is small enough.
    let clean = series(&[(1, 1.0, 0.4), (4, 2.0, 0.0)]);
    assert_eq!(clean.needed(0.1).unwrap().per_pixel, 4.0);
}

#[test]
fn what_has_no_slope_has_no_fit() {
    assert_eq!(Fit::of(&[]), None);
    assert_eq!(Fit::of(&[(1.0, 1.0)]), None);
    assert_eq!(Fit::of(&[(2.0, 1.0), (2.0, 3.0)]), None);
    assert_eq!(Fit::of(&[(1.0, 1.0), (2.0, 0.0)]), None);
    let two = Fit::of(&[(1.0, 1.0), (4.0, 0.5)]).unwrap();
    assert_eq!(two.slope_error, None);
    let flat = Fit::of(&[(1.0, 1.0), (4.0, 1.0)]).unwrap();
    assert_eq!(flat.reaches(0.5), None);
}

#[test]
fn quantiles_lie_between_values() {
    let values = [4.0, 1.0, 3.0, 2.0];
    assert_eq!(median(&values), 2.5);
    assert_eq!(quantile(&values, 0.0), 1.0);
    assert_eq!(quantile(&values, 0.25), 1.75);
    assert_eq!(quantile(&values, 1.0), 4.0);
    assert_eq!(median(&[7.0]), 7.0);
    assert!(median(&[]).is_nan());
    assert_eq!(root_mean_square(&[3.0, 4.0, 0.0, 0.0]), 2.5);
}
