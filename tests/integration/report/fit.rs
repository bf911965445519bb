//! Numbers about numbers: slopes, quantiles, and what an error takes.

use pinhole::{
    report::speed::{
        Point, Series, Try,
        fit::{Fit, certainty, log_error, median, quantile, root_mean_square},
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
    let fit = Fit::of_measured(&points, &errors).unwrap();
    assert_eq!(
        (fit.slope_error, fit.bent(&[-0.2]).slope_error),
        (None, None)
    );
    assert_eq!(fit.residual_error, Fit::of(&points).unwrap().residual_error);
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
        method: Method::Random,
        points: points.iter().map(point).collect(),
        picture: None,
        tries: Vec::new(),
    }
}

#[test]
fn what_an_error_takes_lies_between_the_points_on_either_side() {
    let straight = series(&[(1, 0.5, 0.4), (4, 1.0, 0.2), (16, 3.0, 0.1)]);
    let needed = straight.needed(0.1414214).unwrap();
    assert_eq!((needed.per_pixel, needed.is_extrapolated), (8.0, false));
    assert!((needed.seconds - 5.0 / 3.0).abs() < 1e-12, "{needed:?}");
    // Half-way between two, of two runs: Student's quantile of one degree of freedom times what a run differs from the next, √2 · 0.01, and with it
    // (½ + ½) · 0.01, by a slope of ½; and what the line may sag, 0.8 of log 2 twice.
    let noise = |line: f64| certainty(1) * libm::hypot(line, 2.0f64.sqrt() * 0.01) / 0.5;
    let sag = 0.8 * libm::log(2.0) * libm::log(2.0);
    let factor = libm::exp(libm::hypot(noise(0.01), sag));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-6, "{needed:?}");
    // Close to a point that may sag no less: what lies next to a count that a method likes is none.
    let needed = straight.needed(0.1001).unwrap();
    let beside = libm::exp(libm::hypot(noise(0.01), sag));
    assert!((needed.factor.unwrap() - beside).abs() < 1e-3, "{needed:?}");
    // As far beyond the last one: (1 + 2) · 0.01, where theory has the same slope; the time on the line from the first to the last.
    let needed = straight.needed(0.0500001).unwrap();
    assert_eq!((needed.per_pixel, needed.is_extrapolated), (64.0, true));
    assert!((needed.seconds - 11.0).abs() < 1e-12, "{needed:?}");
    let factor = libm::exp(noise(0.03));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-5, "{needed:?}");

    // A line that flattens is followed where it ends, and doubted as far as the steepest slope is away: 1 here, by which half would do.
    let bent = series(&[(1, 1.0, 0.4), (4, 1.0, 0.1), (16, 1.0, 0.05)]);
    let needed = bent.needed(0.0250001).unwrap();
    assert_eq!((needed.per_pixel, needed.seconds), (64.0, 1.75));
    let factor = libm::exp(libm::hypot(noise(0.03), libm::log(2.0)));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-4, "{needed:?}");
    // Where more samples do not help nothing is promised.
    assert_eq!(series(&[(1, 1.0, 0.4), (4, 1.0, 0.4)]).needed(0.1), None);
    // No error at all is one that is small enough, and fewer samples that were not measured may leave none, either.
    for (per_pixel, is_at_most) in [(4, true), (2, false)] {
        let clean = series(&[(1, 1.0, 0.4), (per_pixel, 2.0, 0.0)]);
        let needed = clean.needed(0.1).unwrap();
        assert_eq!(needed.per_pixel, per_pixel as f64);
        assert_eq!(needed.is_at_most, is_at_most);
        let factor = (!is_at_most).then_some(1.0);
        assert_eq!((needed.factor, needed.seconds), (factor, 2.0));
    }
}

/// A series with single runs that tried 0.025: the straight line says that it takes 256 samples.
fn tried(tries: &[(u64, f64)]) -> Series {
    let mut series = series(&[(1, 0.5, 0.4), (4, 1.0, 0.2), (16, 3.0, 0.1)]);
    let to_try = |&(per_pixel, error): &(u64, f64)| Try {
        wanted: 0.025,
        seed: 0,
        point: Point {
            rmse: vec![error],
            times: vec![per_pixel as f64 / 100.0],
            per_pixel,
            ..series.points[0].clone()
        },
    };
    series.tries = tries.iter().map(to_try).collect();
    series
}

#[test]
fn tries_say_where_an_error_lies() {
    // The truth is 399.5 samples and a slope of ½: a single try finds it, and is doubted: by what runs of a point differ, √2 · 0.01 of the logarithm and that
    // of the mean of one; and by the way from the try to the answer.
    let error = |samples: f64| 0.025 * (399.5 / samples).sqrt();
    let one = tried(&[(256, error(256.0))]).needed(0.025).unwrap();
    assert_eq!((one.per_pixel, one.tries), (400.0, 1));
    assert!(
        one.is_extrapolated && (one.seconds - 4.0).abs() < 1e-12,
        "{one:?}"
    );
    let render = certainty(1) * 2.0f64.sqrt() * 0.01 * 2.0f64.sqrt() / 0.5;
    let doubt = libm::hypot(render, libm::log(399.5 / 256.0));
    assert!(
        (libm::log(one.factor.unwrap()) - doubt).abs() < 1e-3,
        "{one:?}"
    );
    // Three near it tell how much one differs from the next: with squares of 1 + q, 1 and 1 − q, moved along the slope, the deviation of the logarithm is q/2.
    let q = 0.08;
    let counts = [(360u64, 1.0 + q), (400, 1.0), (444, 1.0 - q)];
    let mut tries = vec![(256, error(256.0))];
    tries.extend(counts.map(|(n, square): (u64, f64)| (n, error(n as f64) * square.sqrt())));
    let three = tried(&tries).needed(0.025).unwrap();
    assert_eq!((three.per_pixel, three.tries), (400.0, 3));
    assert!(!three.is_extrapolated);
    let doubt = certainty(2) * q / 2.0 * (4.0f64 / 3.0).sqrt() / 0.5;
    assert!(
        (libm::log(three.factor.unwrap()) - doubt).abs() < 1e-4,
        "{three:?}"
    );
    // Of tries that are alike the answer is as sure as it is near to them.
    let alike = tried(&[400, 400, 400].map(|n| (n, 0.0250001)))
        .needed(0.025)
        .unwrap();
    assert!(
        alike.factor.unwrap() < 1.0001 && alike.per_pixel == 401.0,
        "{alike:?}"
    );
    // One that hit the exact picture by luck is doubted, and does not lead astray.
    let mut tries = vec![(256, 1e-9)];
    for count in [64, 200, 220, 270, 330, 300, 360] {
        tries.push((count, error(count as f64)));
        let lucky = tried(&tries).needed(0.025).unwrap();
        let off = (lucky.per_pixel / 399.5).max(399.5 / lucky.per_pixel);
        assert!(lucky.factor.unwrap() > off, "{lucky:?}");
    }
}

#[test]
fn counts_beside_those_that_a_method_likes_are_not_known_untried() {
    for method in Method::SAMPLED {
        let is_independent = [Method::Random, Method::Scatter].contains(&method);
        let mut untried = series(&[(1, 1.0, 0.4), (4, 1.0, 0.2), (16, 3.0, 0.1)]);
        untried.method = method;
        let factors = [0.15, 0.05].map(|error| untried.needed(error).unwrap().factor);
        assert_eq!(factors.map(|factor| factor.is_some()), [is_independent; 2]);
        let mut once = tried(&[(256, 0.03)]);
        once.method = method;
        let factor = once.needed(0.025).unwrap().factor;
        assert_eq!(factor.is_some(), is_independent);
        // Tries at several counts tell, but not of one that falls into step with the picture.
        let mut often = tried(&[(230, 0.026), (256, 0.025), (280, 0.024)]);
        often.method = method;
        let factor = often.needed(0.025).unwrap().factor;
        assert_eq!(factor.is_none(), method == Method::Regular);
    }
}

#[test]
fn the_fewest_samples_may_be_enough_by_luck() {
    // Two runs with squares of 1 ± 0.04 around the error's: the logarithm of the next one differs by √3 · 0.01 times Student's quantile.
    let margin = libm::exp(certainty(1) * 3.0f64.sqrt() * 0.01);
    let first = series(&[(1, 1.0, 0.1), (4, 1.0, 0.05)]);
    for (error, is_sure) in [
        (0.1001, false),
        (0.999 * 0.1 * margin, false),
        (1.001 * 0.1 * margin, true),
    ] {
        let needed = first.needed(error).unwrap();
        assert_eq!((needed.per_pixel, needed.is_at_most), (1.0, false));
        assert_eq!(needed.factor, is_sure.then_some(1.0), "{error} {needed:?}");
    }
    // Of a single run nothing is known, unless all are alike.
    let mut single = series(&[(1, 1.0, 0.1)]);
    single.points[0].rmse.truncate(1);
    assert_eq!(single.needed(0.2).unwrap().factor, None);
    single.method = Method::Regular;
    assert_eq!(single.needed(0.2).unwrap().factor, Some(1.0));
}

#[test]
fn two_points_know_nothing_of_a_bend() {
    // The slope is −3/4, and may be −1/2 further on.
    let two = series(&[(1, 1.0, 0.8), (16, 2.0, 0.1)]);
    let needed = two.needed(0.0125).unwrap();
    assert!(needed.is_extrapolated);
    let more = libm::log(0.1 / 0.0125) * (2.0 - 4.0 / 3.0);
    let noise = |line: f64, slope| certainty(1) * libm::hypot(line, 2.0f64.sqrt() * 0.01) / slope;
    let factor = libm::exp(libm::hypot(noise(0.03, 0.75), more));
    assert!((needed.factor.unwrap() - factor).abs() < 1e-9, "{needed:?}");
    // Of a slope of −1/2 theory knows no other.
    let straight = series(&[(1, 1.0, 0.4), (16, 2.0, 0.1)]);
    let factor = straight.needed(0.05).unwrap().factor.unwrap();
    assert!(
        (factor - libm::exp(noise(0.02, 0.5))).abs() < 1e-9,
        "{factor}"
    );
    // Nor do single runs know of noise: there is no factor, and no method is said to be the fastest by it.
    let mut single = two;
    for point in &mut single.points {
        point.rmse.truncate(1);
        point.times.truncate(1);
    }
    let needed = single.needed(0.0125).unwrap();
    assert_eq!((needed.factor, needed.is_extrapolated), (None, true));
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
    bent.tries.push(Try {
        wanted: 0.01,
        seed: 0,
        point: series(&[(256, 1.0, 0.025)]).points[0].clone(),
    });
    let tried = bent.fit().unwrap();
    assert_eq!((tried.slope, tried.points), (fit.slope, fit.points));
    assert!(
        (tried.slope_error.unwrap() + fit.slope).abs() < 1e-12,
        "{tried:?}"
    );
    // What lies close to another point shows its noise rather than a slope.
    bent.tries[0].point.per_pixel = 65;
    bent.tries[0].point.rmse = vec![0.03];
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
    assert_eq!(
        (root_mean_square(&[0.0]), root_mean_square(&[0.1; 7])),
        (0.0, 0.1)
    );
    assert!(root_mean_square(&[]).is_nan());
}
