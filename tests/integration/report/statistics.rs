//! Tests of the statistics of reports: medians, slopes, the cost of reaching an error, and
//! verdicts.

use std::{cell::RefCell, time::Duration};

use pinhole::{
    area::Area,
    render::{Control, render_exact},
    report::speed::{
        Estimate, Machine, MeasuredScene, Measurement, MethodSeries, Mixture, Request, Run,
        SeriesPoint, measure,
        statistics::{median, root_mean_square, slope, standard_error},
        verdict,
    },
    scene::Method,
    tracer::World,
};

use super::SCENE;
use crate::{
    scenes::{one_thread, read},
    table::rows,
};

#[test]
fn median_and_root_mean_square_match_values_computed_by_hand() {
    assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
    assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
    assert!(median(&[]).is_nan());
    assert_eq!(root_mean_square(&[3.0, -4.0]), 12.5_f64.sqrt());
}

#[test]
fn slopes_and_standard_errors_match_values_computed_by_hand() {
    // In units of ln 2, the logarithms of samples and errors are x = 0, 1, 2, 3 and y = 0, −1, −1,
    // −2. Their means are x̄ = 1.5 and ȳ = −1. So Σ(x − x̄)·(y − ȳ) = −3 and Σ(x − x̄)² = 5, and
    // the slope is −3/5.
    let found = slope(&[(1.0, 1.0), (2.0, 0.5), (4.0, 0.5), (8.0, 0.25)]);
    assert!((found.unwrap() + 0.6).abs() < 1e-14);
    // A line needs more than one point, and an error of 0 has no logarithm.
    assert_eq!(slope(&[(1.0, 1.0), (4.0, 0.5)]), Some(-0.5));
    assert_eq!(slope(&[(4.0, 0.5)]), None);
    assert_eq!(slope(&[(1.0, 1.0), (4.0, 0.0)]), None);
    // The mean is 2, the sample variance s² is 1, and so the standard error is 1/√3.
    assert_eq!(
        standard_error(&[1.0, 2.0, 3.0]),
        Some((1.0f64 / 3.0).sqrt())
    );
    assert_eq!(standard_error(&[1.0, 2.0]), None);
}

/// Each row has the errors at 1, 4, 16, … samples, and after the arrow up to three expected
/// numbers. The first is the slope of the logarithm of the error over the logarithm of the number
/// of samples. The second is the factor by which the error falls if the number of samples is
/// multiplied by 4. The third is the factor by which the number of samples must be multiplied for a
/// tenth of the error.
#[test]
fn the_slope_is_that_of_the_last_three_points_and_says_what_it_means() {
    for [errors, expected] in rows(
        "
        0.4 0.2 0.1 0.05 -> -0.5 2 100
        -- What is steep at first ends like independent samples.
        3.2 0.8 0.2 0.1 0.05 -> -0.5 2 100
        0.8 0.1 -> -1.5 8 4.641588833612779
        -- Noise is no slope.
        0.4 0.4 0.4 -> 0
        0.1 0.2 0.4 -> 0.5
    ",
    ) {
        let (errors, expected) = (numbers(errors), numbers(expected));
        let power = |at: usize| f64::from(1 << (2 * at));
        let points = errors
            .iter()
            .enumerate()
            .map(|(at, &error)| [power(at), 1.0, error]);
        let found = series(Method::Random, &points.collect::<Vec<_>>())
            .slope()
            .unwrap();
        let means = [Some(found.slope), found.divisor(), found.cost_of_a_tenth()];
        for (at, found) in means.into_iter().enumerate() {
            let is_equal = match (found, expected.get(at)) {
                (Some(found), Some(expected)) => {
                    (found - expected).abs() <= 1e-13 * (1.0 + expected.abs())
                }
                (found, expected) => found.is_none() && expected.is_none(),
            };
            assert!(is_equal, "{errors:?}: {found:?}");
        }
    }
}

/// Each row has numbers of samples and errors, and after the arrow whether there is a slope.
#[test]
fn a_slope_needs_a_factor_of_four_and_a_line_that_does_not_bend() {
    for [points, expected] in rows(
        "
        16 0.1  17 0.09 -> none
        15 0.1  16 0.09  17 0.08 -> none
        4 0.2  15 0.1  16 0.09  17 0.08 -> none
        4 0.2  16 0.1 -> a slope
        4 0.2  16 0.1  64 0.05 -> a slope
        4 0.2  16 0.1  64 0.045 -> a slope
        -- At first like 1/n, then like 1/√n.
        4 0.4  16 0.1  64 0.05 -> bends
        -- Only the last three points count.
        1 1.6  4 0.4  16 0.2  64 0.1 -> a slope
    ",
    ) {
        let points = numbers(points);
        let points = points.as_chunks().0.iter().map(|&[n, error]| [n, n, error]);
        let slope = series(Method::Random, &points.collect::<Vec<_>>()).slope();
        let found = match slope {
            None => "none",
            Some(slope) if slope.bends => "bends",
            Some(_) => "a slope",
        };
        assert_eq!(found, expected, "{slope:?}");
        let means = slope.map(|slope| [slope.divisor(), slope.cost_of_a_tenth()]);
        assert_eq!(means.is_some_and(|it| it[0].is_some()), found == "a slope");
        assert_eq!(means.is_some_and(|it| it[1].is_some()), found == "a slope");
    }
}

/// The logarithm of the error over the logarithm of the number of samples is nearly a straight
/// line. A bend of this line is reported only if it is larger than the noise of the runs.
#[test]
fn noise_does_not_bend_a_line() {
    let run = |error| Run {
        cpu: 1.0,
        wall: 1.0,
        error,
    };
    let with_last = |last: [f64; 3]| MethodSeries {
        points: [(4, [0.2; 3]), (16, [0.1; 3]), (64, last)]
            .map(|(per_pixel, errors)| SeriesPoint {
                per_pixel,
                runs: errors.map(run).into(),
            })
            .into(),
        ..series(Method::Random, &[])
    };
    assert!(with_last([0.064, 0.065, 0.066]).slope().unwrap().bends);
    assert!(!with_last([0.04, 0.06, 0.09]).slope().unwrap().bends);
}

/// Returns a series of measurements with one run per point. A point is given by the samples per
/// pixel, the CPU time in seconds, and the error.
fn series(method: Method, points: &[[f64; 3]]) -> MethodSeries {
    let point = |&[per_pixel, cpu, error]: &[f64; 3]| SeriesPoint {
        per_pixel: per_pixel as u64,
        runs: vec![Run {
            cpu,
            wall: cpu / 2.0,
            error,
        }],
    };
    MethodSeries {
        method,
        points: points.iter().map(point).collect(),
        picture: None,
    }
}

fn estimate(points: &[[f64; 3]], error: f64) -> Option<Estimate> {
    series(Method::Random, points).estimate(error)
}

fn numbers(text: &str) -> Vec<f64> {
    let words = text.split_whitespace();
    words.map(|word| word.parse().unwrap()).collect()
}

/// Each row has measured points: samples, CPU time and error. After the arrow, the row has an error
/// and the expected cost of reaching it. The cost is a number of samples, a CPU time, and 1 if both
/// are extrapolated, or else 0. If the cost cannot be estimated, it is left out.
#[test]
fn cost_estimates_interpolate_between_points_and_extrapolate_beyond_the_last() {
    for [points, expected] in rows("
        -- Half-way in logarithms, and a third of the way in time.
        1 0.5 0.4  4 1 0.2  16 3 0.1 -> 0.1414213572373095 8 1.6666666666666667 0
        1 0.5 0.4  4 1 0.2  16 3 0.1 -> 0.2 4 1 0
        -- Beyond the last point the slope of −1/2 goes on; the time goes on from the first to the last.
        1 0.5 0.4  4 1 0.2  16 3 0.1 -> 0.050000001 64 11 1
        -- That slope b is the one of the last three points: ln(0.09/0.2) / 2 / ln 4, where 0.135 is between both; and 711 is above 64 · 2^(−1/b).
        1 1 0.4  4 4 0.2  16 16 0.134164079  64 64 0.09 -> 0.045 711 711 1
        -- Where the line bends, its last part goes on.
        1 1 0.4  4 4 0.2  16 16 0.1  64 64 0.09 -> 0.045 584818 584818 1
        -- Numbers of samples that are close to each other have no slope.
        15 15 0.2  16 16 0.19  17 17 0.18 -> 0.1
        -- Times that fall by chance do not fall on.
        1 1.2 0.4  4 1.1 0.2  16 1 0.1 -> 0.050000001 64 1 1
        -- The first number is enough, alone or not, whatever the others do.
        64 1 0.2 -> 0.4 64 1 0
        4 1 0  16 5 0 -> 0.4 4 1 0
        4 1 0.2  16 3 0.1 -> 0.399999999 4 1 0
        1 0.5 0.4  4 1 0.2  16 3 0.1 -> 0.9 1 0.5 0
        -- No error at all is one that is small enough.
        1 1 0.4  4 2 0 -> 0.1 4 2 0
        -- Nothing is known where more samples do not help.
        1 1 0.4  4 1 0.4 -> 0.1
        1 1 0.1  4 1 0.4 -> 0.01
        4 1 0.4 -> 0.1
        -- A slope that may be noise, and a last part of a bent line that is too short, predict nothing.
        4 4 0.4  16 16 0.399  64 64 0.398 -> 0.1
        15 15 0.4  60 60 0.1  61 61 0.09 -> 0.01
    ") {
        let (points, expected) = (numbers(points), numbers(expected));
        let found = estimate(points.as_chunks().0, expected[0]);
        let Some(found) = found else {
            assert_eq!(expected.len(), 1, "{points:?}");
            continue;
        };
        let is_extrapolated = f64::from(u8::from(found.is_extrapolated));
        let is = [found.per_pixel.unwrap(), found.cpu, is_extrapolated];
        let is_close = |(a, b): (f64, &f64)| (a - b).abs() < 1e-9;
        assert!(is.into_iter().zip(&expected[1..]).all(is_close), "{found:?}");
        assert!((found.wall - found.cpu / 2.0).abs() < 1e-9, "{found:?}");
        assert_eq!(found.cpu_runs, [found.cpu; 2]);
    }
    // The errors at 1 and 4 samples are low enough, but may be low by chance, because the error at
    // 16 samples is higher again. So the estimate must lie between 16 and 64 samples.
    let wave = [1.0, 4.0, 16.0, 64.0].map(|n| [n, n, if n == 16.0 { 0.2 } else { 0.05 }]);
    let found = estimate(&wave, 0.1).unwrap();
    let samples = found.per_pixel.unwrap();
    assert!((16.0..64.0).contains(&samples), "{found:?}");
    let series = series(
        Method::Random,
        &[[1.0, 1.0, 0.4], [4.0, 2.0, 0.2], [16.0, 6.0, 0.1]],
    );
    let times = [0.5, 1.0, 2.0, 4.0, 6.0, 100.0].map(|cpu| series.samples_in(cpu));
    assert_eq!(times, [1, 1, 4, 10, 16, 16].map(Some));
}

#[test]
fn multi_jittered_estimates_round_to_a_full_grid() {
    let points = [1.0, 4.0, 16.0, 64.0, 256.0, 1024.0].map(|n: f64| [n, n, 1.0 / n.sqrt()]);
    // The number of samples is rounded up to a square or a product of neighbouring integers, which
    // makes a full grid. It is at most the number at the last measured point.
    let samples = [401.0, 400.0, 419.0, 421.0, 1020.0, 1024.0];
    let grids = [420.0, 400.0, 420.0, 441.0, 1024.0, 1024.0];
    for (samples, grid) in samples.into_iter().zip(grids) {
        let error = 1.0 / f64::sqrt(samples) + 1e-12;
        let found = series(Method::MultiJittered, &points)
            .estimate(error)
            .unwrap();
        assert_eq!(found.per_pixel, Some(grid));
        assert!((found.cpu - grid).abs() < 1e-9, "{found:?}");
        let any = estimate(&points, error).unwrap();
        assert_eq!(any.per_pixel, Some(samples));
    }
}

fn subject() -> MeasuredScene {
    MeasuredScene {
        name: "a.scn".to_owned(),
        overrides: Vec::new(),
    }
}

#[test]
fn progress_reaches_1_when_a_sample_count_is_requested_twice() {
    let request = Request {
        methods: vec![Method::Sobol],
        samples: vec![4, 1, 4],
        runs: Some(2),
        errors: vec![0.1],
        budget: Duration::from_secs(1),
    };
    let told = RefCell::new(Vec::new());
    let tell = |share| told.borrow_mut().push(share);
    let control = Control::default();
    let measured = measure(&subject(), &read(SCENE), &request, &control, &tell).unwrap();
    assert!(measured.exact.is_none());
    // The request names 1 and 4 samples per pixel. Each of the two runs measures both, so the
    // progress is a fraction of 10 samples. The first run begins with 1 sample, so the progress is
    // 1/10 after the first measurement, and 5/10 after the second. The second run may begin with 4
    // samples.
    let told = told.into_inner();
    assert_eq!((told.len(), &told[..2]), (4, &[0.1, 0.5][..]));
    assert!(told[2] > 0.5 && told[3] == 1.0, "{told:?}");
}

/// Returns a measurement of methods whose runs take the given CPU times. Each method has two
/// points: 4 samples with an error of 0.2, and 16 samples with an error of 0.1.
fn measured(methods: &str) -> Measurement {
    let timed = |times: &str, share: f64, error: f64| -> Vec<_> {
        let run = |time: f64| Run {
            cpu: time * share,
            wall: time * share,
            error,
        };
        numbers(times).into_iter().map(run).collect()
    };
    let (mut sampled, mut exact) = (Vec::new(), None);
    for method in methods.split("; ") {
        let (name, times) = method.split_once(' ').unwrap();
        match Method::SAMPLED.into_iter().find(|m| m.name() == name) {
            None => exact = Some(timed(times, 1.0, f64::NAN)),
            Some(method) => sampled.push(MethodSeries {
                points: [(4, 0.25, 0.2), (16, 1.0, 0.1)]
                    .map(|(per_pixel, share, error)| SeriesPoint {
                        per_pixel,
                        runs: timed(times, share, error),
                    })
                    .into(),
                ..series(method, &[])
            }),
        }
    }
    let world = World::new(&read(SCENE));
    Measurement {
        subject: subject(),
        machine: Machine::here(),
        threads: 1,
        seed: 0,
        rungs: vec![4, 16],
        errors: Vec::new(),
        reference: render_exact(&world, Area::whole(48, 32), &one_thread()).unwrap(),
        mixture: Mixture {
            edges: 0.1,
            board: 0.2,
            is_complete: true,
        },
        exact,
        series: sampled,
        interrupted: false,
    }
}

#[test]
fn verdicts_state_ties_single_runs_and_extrapolation() {
    for [methods, error, expected] in rows("
        -- Apart, within the spread of one method's runs, and in a single run.
        sobol 1 1.1 1.2; halton 1.3 1.4 1.5 -> 0.1 -> Use sobol for an error of 0.1: it takes the least CPU time, 1.10 s, with 16 samples per pixel. For comparison, halton takes 1.40 s, with 16 samples per pixel.
        sobol 1 1.1 1.2; halton 1.11 1.12 1.3; random 4 4.1 4.2; exact 1.05 1.15 9 -> 0.1 -> Use sobol, halton or exact for an error of 0.1: they are about as fast, with 1.10 s to 1.15 s of CPU time, and exact has no sampling error. For comparison, random takes 4.10 s, with 16 samples per pixel.
        sobol 1; halton 1.3 -> 0.1 -> By one run alone, use sobol for an error of 0.1: it
        -- What is extrapolated decides only where there is nothing else.
        sobol 1 1.1 1.2; halton 1.3 1.4 1.5; exact 9 9.1 9.2 -> 0.051 -> Use exact for an error of 0.051: it takes 9.10 s of CPU time and has no sampling error. For comparison, sobol would take ~4.3 s, with ~62 samples per pixel.
        sobol 1 1.1 1.2; halton 1.3 1.4 1.5 -> 0.051 -> By extrapolation, use sobol for an error of 0.051: it
        sobol 1 1.1 1.2 -> 0.051 -> By extrapolation, use sobol for an error of 0.051, the only method that is known to reach it: sobol would take ~4.3 s, with ~62 samples per pixel.
        -- Times of a few milliseconds say little about a method.
        sobol 0.001 0.002 0.003; random 0.004 0.005 0.006; exact 0.05 -> 0.1 -> Use sobol or random for an error of 0.1: 16 samples per pixel are the fewest. Times below 10 ms are too short to compare. For comparison, exact takes 50.0 ms, without error.
        sobol 0.001 0.002 0.003; random 0.004 0.005 0.006 -> 0.051 -> By extrapolation, use sobol for an error of 0.051: it
        sobol 1 1.1 1.2; halton 1.3 1.4 1.5 -> 1e-17 -> No method is known to reach an error of 1e-17.
    ") {
        let said = verdict(&measured(methods), error.parse().unwrap());
        let is_whole = expected.ends_with('.');
        assert!(said.starts_with(expected), "{said}");
        assert!(!is_whole || said == expected, "{said}");
    }
}
