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
        rays: 0,
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
    // Half-way between two: twice (½ + ½) · 0.01 by a slope of ½; and what the line may sag there, 0.8 of log 2 twice.
    let (noise, sag) = (0.04, 0.8 * libm::log(2.0) * libm::log(2.0));
    let factor = libm::exp(libm::hypot(noise, sag));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-6, "{needed:?}");
    // As far beyond the last one: twice (1 + 2) · 0.01 by ½, and with a slope of −3/4 it would be 4/3 of log 2 in place of twice that; the
    // time on the line from the first to the last.
    let needed = straight.needed(0.0500001).unwrap();
    assert_eq!((needed.per_pixel, needed.is_extrapolated), (64.0, true));
    assert!((needed.seconds - 11.0).abs() < 1e-12, "{needed:?}");
    let (noise, bend) = (0.12, 2.0 / 3.0 * libm::log(2.0));
    let factor = libm::exp(libm::hypot(noise, bend));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-5, "{needed:?}");

    // A line that flattens is followed where it ends, and doubted as far as the steepest slope is away: 1 here, by which half would do.
    let mut bent = series(&[(1, 1.0, 0.4), (4, 1.0, 0.1), (16, 1.0, 0.05)]);
    let needed = bent.needed(0.0250001).unwrap();
    assert_eq!((needed.per_pixel, needed.seconds), (64.0, 1.75));
    let factor = libm::exp(libm::hypot(0.12, libm::log(2.0)));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-5, "{needed:?}");
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
    // A grid wants counts that are nearly squares: not 7 rows of one.
    let mut grid = series(&[(1, 1.0, 0.4), (16, 1.0, 0.1)]);
    grid.method = Method::MultiJittered;
    for (error, count) in [(0.1513, 9.0), (0.13, 12.0), (0.11, 16.0), (0.4 / 6.2, 42.0)] {
        assert_eq!(grid.needed(error).unwrap().per_pixel, count, "{error}");
    }
    // Where more samples do not help nothing is promised.
    assert_eq!(series(&[(1, 1.0, 0.4), (4, 1.0, 0.4)]).needed(0.1), None);
    // No error at all is one that is small enough, and fewer samples that were not measured may leave none, either.
    for (per_pixel, is_at_most) in [(4, true), (2, false)] {
        let clean = series(&[(1, 1.0, 0.4), (per_pixel, 2.0, 0.0)]);
        let needed = clean.needed(0.1).unwrap();
        assert_eq!(needed.per_pixel, per_pixel as f64);
        assert_eq!(needed.is_at_most, is_at_most);
        assert_eq!((needed.factor, needed.seconds), (None, 2.0));
    }
}

#[test]
fn two_points_know_nothing_of_a_bend() {
    // The slope is −3/4, and may be −1/2 further on.
    let two = series(&[(1, 1.0, 0.8), (16, 2.0, 0.1)]);
    let needed = two.needed(0.0125).unwrap();
    assert!(needed.is_extrapolated);
    let more = libm::log(0.1 / 0.0125) * (2.0 - 4.0 / 3.0);
    let factor = needed.factor.unwrap();
    assert!(factor >= libm::exp(more), "{needed:?}");
    assert!(factor < 1.05 * libm::exp(more), "{needed:?}");
    // Of independent samples theory knows: −1/2, and not −3/4.
    let mut random = series(&[(1, 1.0, 0.4), (16, 2.0, 0.1)]);
    random.method = Method::Random;
    let factor = random.needed(0.05).unwrap().factor.unwrap();
    assert!(factor < 1.2, "{factor}");
    // Nor do single runs know of noise: there is no factor, and no method is said to be the fastest by it.
    let mut single = two;
    for point in &mut single.points {
        point.rmse.truncate(1);
        point.times.truncate(1);
    }
    let needed = single.needed(0.0125).unwrap();
    assert_eq!((needed.factor, needed.is_extrapolated), (None, true));
    // Nor is it known of a grid, which falls into step with the picture, however close it was tried.
    let mut grid = series(&[(1, 1.0, 0.4), (4, 1.0, 0.2), (16, 3.0, 0.1)]);
    grid.method = Method::Regular;
    assert_eq!(grid.needed(0.05).unwrap().factor, None);
    assert_eq!(grid.needed(0.15).unwrap().factor, None);
    assert_eq!(grid.needed(0.1999).unwrap().factor, None);
    // A curve that once rose may do so again.
    let rising = series(&[(1, 1.0, 0.1), (4, 1.0, 0.2), (16, 2.0, 0.1)]);
    assert_eq!(rising.needed(0.05).unwrap().factor, None);
}

#[test]
fn a_slopes_uncertainty_covers_all_slopes_of_its_curve() {
    // Slopes of −1, −1/2 and −1/2 …
    let mut bent = series(&[
        (1, 1.0, 0.4),
        (4, 1.0, 0.1),
        (16, 1.0, 0.05),
        (64, 1.0, 0.025),
    ]);
    let fit = bent.fit().unwrap();
    let bend = 1.0 + fit.slope;
    assert!((fit.bend.unwrap() - bend).abs() < 1e-12, "{fit:?}");
    assert!(bend > fit.residual_error.unwrap() && bend > fit.measured_error.unwrap());
    assert_eq!(fit.slope_error, fit.bend);
    // … and, where more samples are tried, of none at all.
    bent.checks.push(Check {
        wanted: 0.01,
        point: series(&[(256, 1.0, 0.025)]).points[0].clone(),
    });
    let tried = bent.fit().unwrap();
    assert_eq!((tried.slope, tried.points), (fit.slope, fit.points));
    assert!(
        (tried.slope_error.unwrap() + fit.slope).abs() < 1e-12,
        "{tried:?}"
    );
    // What lies close to another point shows its noise rather than a slope.
    bent.checks[0].point.per_pixel = 65;
    bent.checks[0].point.rmse = vec![0.03];
    let close = bent.fit().unwrap();
    assert!(close.slope_error.unwrap() < 0.4, "{close:?}");
}

#[test]
fn what_has_no_slope_has_no_fit() {
    assert_eq!(Fit::of(&[]), None);
    assert_eq!(Fit::of(&[(1.0, 1.0)]), None);
    assert_eq!(Fit::of(&[(2.0, 1.0), (2.0, 3.0)]), None);
    assert_eq!(Fit::of(&[(1.0, 1.0), (2.0, 0.0)]), None);
    let two = Fit::of(&[(1.0, 1.0), (4.0, 0.5)]).unwrap();
    assert_eq!(two.slope_error, None);
    assert_eq!(two.bent(&[-0.4]).slope_error, None);
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
