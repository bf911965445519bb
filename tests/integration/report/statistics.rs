//! Numbers about numbers: medians, slopes, and what an error takes.

use pinhole::{
    report::speed::{
        Needed, Point, Series, Times,
        statistics::{PowerLaw, median, root_mean_square},
    },
    scene::Method,
};

#[test]
fn the_median_is_the_middle_one() {
    assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
    assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
    assert!(median(&[]).is_nan());
    assert_eq!(root_mean_square(&[3.0, -4.0]), 12.5_f64.sqrt());
}

#[test]
fn a_power_law_is_fitted_exactly() {
    let points = [1.0, 4.0, 16.0, 64.0].map(|n: f64| (n, 0.3 / (n * n.sqrt()).sqrt()));
    let fit = PowerLaw::fit(&points).unwrap();
    assert!((fit.slope + 0.75).abs() < 1e-14, "{}", fit.slope);
    assert!(fit.slope_error.unwrap() < 1e-14);
    assert_eq!(fit.points, 4);
}

#[test]
fn the_slopes_standard_error_is_that_of_the_textbook() {
    // In units of ln 2: x = 0, 1, 2, 3 and y = 0, −1, −1, −2 has x̄ = 1.5, ȳ = −1, S = 5, b = −3/5, residuals −0.1, 0.3, −0.3, 0.1
    // but for signs, Σr² = 0.2, and the standard error √(0.2 / 2 / 5) = √0.02.
    let fit = PowerLaw::fit(&[(1.0, 1.0), (2.0, 0.5), (4.0, 0.5), (8.0, 0.25)]).unwrap();
    assert!((fit.slope + 0.6).abs() < 1e-14);
    assert!((fit.slope_error.unwrap() - 0.02f64.sqrt()).abs() < 1e-14);
    // Two points have a line and nothing to judge it by, one has none, and an error of 0 has no logarithm.
    let two = PowerLaw::fit(&[(1.0, 1.0), (4.0, 0.5)]).unwrap();
    assert_eq!((two.slope, two.slope_error), (-0.5, None));
    assert_eq!(PowerLaw::fit(&[(4.0, 0.5)]), None);
    assert_eq!(PowerLaw::fit(&[(1.0, 1.0), (4.0, 0.0)]), None);
}

/// Numbers of samples with their seconds and errors.
fn series(points: &[(u64, f64, f64)]) -> Series {
    let point = |&(per_pixel, seconds, error): &(u64, f64, f64)| Point {
        per_pixel,
        rays: 0,
        times: Times {
            cpu: vec![seconds],
            wall: vec![seconds / 2.0],
        },
        rmse: vec![error],
    };
    Series {
        method: Method::Random,
        points: points.iter().map(point).collect(),
        picture: None,
    }
}

fn needed(points: &[(u64, f64, f64)], error: f64) -> Option<Needed> {
    series(points).needed(error)
}

/// Samples, CPU time, and whether they are extrapolated.
fn is(needed: Option<Needed>, samples: f64, cpu: f64, is_extrapolated: bool) {
    let needed = needed.unwrap();
    let found = (needed.per_pixel, needed.is_extrapolated);
    assert_eq!(found, (Some(samples), is_extrapolated), "{needed:?}");
    assert!((needed.cpu - cpu).abs() < 1e-9, "{needed:?}");
    assert!((needed.wall - cpu / 2.0).abs() < 1e-9, "{needed:?}");
}

#[test]
fn what_an_error_takes_lies_on_the_line_between_the_points_on_either_side() {
    let straight = [(1, 0.5, 0.4), (4, 1.0, 0.2), (16, 3.0, 0.1)];
    // Half-way in logarithms, and a third of the way in time.
    is(
        needed(&straight, 0.02f64.sqrt() + 1e-9),
        8.0,
        5.0 / 3.0,
        false,
    );
    is(needed(&straight, 0.2), 4.0, 1.0, false);
    // Beyond the last point the slope of −1/2 goes on; the time goes on from the first to the last.
    is(needed(&straight, 0.05 + 1e-9), 64.0, 0.5 + 63.0 / 6.0, true);
    // Times that fall by chance do not fall on.
    let falling = [(1, 1.2, 0.4), (4, 1.1, 0.2), (16, 1.0, 0.1)];
    is(needed(&falling, 0.05 + 1e-9), 64.0, 1.0, true);
    // The first number is enough, alone or not, whatever the others do.
    is(needed(&[(64, 1.0, 0.2)], 0.4), 64.0, 1.0, false);
    is(
        needed(&[(4, 1.0, 0.0), (16, 5.0, 0.0)], 0.4),
        4.0,
        1.0,
        false,
    );
    let few = [(4, 1.0, 0.2), (16, 3.0, 0.1)];
    is(needed(&few, 0.4 - 1e-9), 4.0, 1.0, false);
    is(needed(&straight, 0.9), 1.0, 0.5, false);
}

#[test]
fn an_error_that_comes_back_was_not_reached() {
    // A grid that falls into step with the picture.
    let wave = [
        (1, 1.0, 0.4),
        (4, 4.0, 0.05),
        (16, 16.0, 0.2),
        (64, 64.0, 0.05),
    ];
    let found = needed(&wave, 0.1).unwrap();
    assert!(
        (16.0..64.0).contains(&found.per_pixel.unwrap()),
        "{found:?}"
    );
}

#[test]
fn nothing_is_known_where_more_samples_do_not_help() {
    assert_eq!(needed(&[(1, 1.0, 0.4), (4, 1.0, 0.4)], 0.1), None);
    assert_eq!(needed(&[(1, 1.0, 0.1), (4, 1.0, 0.4)], 0.01), None);
    assert_eq!(needed(&[(4, 1.0, 0.4)], 0.1), None);
    // No error at all is one that is small enough.
    is(
        needed(&[(1, 1.0, 0.4), (4, 2.0, 0.0)], 0.1),
        4.0,
        2.0,
        false,
    );
}

#[test]
fn a_time_has_its_samples() {
    let series = series(&[(1, 1.0, 0.4), (4, 2.0, 0.2), (16, 6.0, 0.1)]);
    for (cpu, samples) in [
        (0.5, 1),
        (1.0, 1),
        (2.0, 4),
        (4.0, 10),
        (6.0, 16),
        (100.0, 16),
    ] {
        assert_eq!(series.samples_in(cpu), Some(samples), "{cpu}");
    }
}
