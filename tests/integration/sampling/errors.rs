//! How far means of points are from the truth, and how fast that falls.

use super::*;

#[test]
fn all_but_regular_are_unbiased() {
    // For each of some boxes, the mean share of the points within it over many pixels is its area.
    let boxes = [
        (DVec2::new(-0.5, -0.5), DVec2::new(-0.2, 0.1)),
        (DVec2::new(0.13, -0.5), DVec2::new(0.5, 0.5)),
        (DVec2::new(-0.31, 0.22), DVec2::new(0.17, 0.41)),
    ];
    for method in Method::SAMPLED {
        if matches!(method, Method::Regular | Method::Scatter) {
            continue;
        }
        for n in [1, 2, 3, 5, 7, 12, 17] {
            let sampling = sampling(method, n, 1);
            let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
            let mut points = Vec::new();
            for (x, y) in Area::whole(64, 64).iter() {
                points.clear();
                sampling.points(x, y, n, 0..n, &mut points);
                for (i, (min, max)) in boxes.iter().enumerate() {
                    let inside = points
                        .iter()
                        .filter(|point| point.cmpge(*min).all() && point.cmplt(*max).all())
                        .count();
                    let share = inside as f64 / n as f64;
                    sums[i] += share;
                    squares[i] += share * share;
                }
            }
            for (i, (min, max)) in boxes.iter().enumerate() {
                let pixels = 4096.0;
                let area = (*max - *min).element_product();
                let mean = sums[i] / pixels;
                let error = ((squares[i] / pixels - mean * mean) / pixels).sqrt();
                assert!(
                    (mean - area).abs() <= 4.0 * error + 1e-12,
                    "{method:?}, {n}: {mean} for {area} ± {error}"
                );
            }
        }
    }
}

/// The root mean square error of the share of points on one side of a random edge, over many edges and pixels.
fn errors(method: Method, n: u64, edges: &[(DVec2, f64, f64)]) -> f64 {
    let sampling = sampling(method, n, n);
    let mut points = Vec::new();
    let mut sum = 0.0;
    for (i, &(normal, distance, area)) in (0_u32..).zip(edges) {
        points.clear();
        sampling.points(i % 64, i / 64, n, 0..n, &mut points);
        let inside = points
            .iter()
            .filter(|point| point.dot(normal) < distance)
            .count();
        let error = inside as f64 / n as f64 - area;
        sum += error * error;
    }
    (sum / edges.len() as f64).sqrt()
}

/// The area of the part of the pixel where normal · p < distance, by clipping.
fn area(normal: DVec2, distance: f64) -> f64 {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(DVec2::from);
    let mut clipped = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % 4];
        let (da, db) = (a.dot(normal) - distance, b.dot(normal) - distance);
        if da < 0.0 {
            clipped.push(a);
        }
        if (da < 0.0) != (db < 0.0) {
            clipped.push(a + (b - a) * (da / (da - db)));
        }
    }
    let next = clipped.iter().cycle().skip(1);
    clipped
        .iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
        / 2.0
}

/// Edges at random angles through a random point of the pixel, or parallel to an axis.
fn edges(parallel: bool) -> Vec<(DVec2, f64, f64)> {
    let points = points(Method::Random, 4 * 900, 123, [1, 1]);
    points
        .chunks_exact(2)
        .enumerate()
        .take(if parallel { 1200 } else { 1800 })
        .map(|(i, pair)| {
            let normal = match (parallel, i % 2) {
                (true, 0) => DVec2::X,
                (true, _) => DVec2::Y,
                (false, _) => {
                    let angle = (pair[0].x + 0.5) * std::f64::consts::TAU;
                    DVec2::new(libm::cos(angle), libm::sin(angle))
                }
            };
            let distance = pair[1].dot(normal);
            (normal, distance, area(normal, distance))
        })
        .collect()
}

#[test]
fn errors_fall_as_fast_as_they_should() {
    // The error at 16, 256 and 4096 points and the slope of its logarithm, for edges at random angles and for edges parallel to an axis:
    // −1/2 for independent points, −3/4 where cells hold one point each (Mitchell 1996; He and Owen 2014), −1 where rows and columns do and
    // the edge is parallel to them (Singh and Jarosz 2017). The constants are measured; those of `random` are √(area·(1 − area)/n).
    #[rustfmt::skip]
    let table = [
        (Method::Random, [1.0e-1, 2.6e-2, 6.4e-3], -0.50, [1.0e-1, 2.6e-2, 6.4e-3], -0.50),
        (Method::Regular, [3.4e-2, 4.6e-3, 5.0e-4], -0.76, [7.1e-2, 1.8e-2, 4.5e-3], -0.50),
        (Method::Jittered, [5.1e-2, 6.1e-3, 7.7e-4], -0.76, [5.2e-2, 6.2e-3, 7.9e-4], -0.75),
        (Method::NRooks, [5.1e-2, 1.2e-2, 3.0e-3], -0.53, [2.5e-2, 1.6e-3, 1.0e-4], -1.00),
        (Method::MultiJittered, [4.0e-2, 4.7e-3, 5.9e-4], -0.76, [2.5e-2, 1.6e-3, 1.0e-4], -1.00),
        (Method::Hammersley, [4.9e-2, 5.5e-3, 6.2e-4], -0.79, [2.8e-2, 1.8e-3, 1.1e-4], -1.00),
        (Method::Halton, [4.9e-2, 6.3e-3, 8.2e-4], -0.74, [2.9e-2, 2.2e-3, 1.5e-4], -0.96),
        (Method::Sobol, [4.3e-2, 5.3e-3, 6.6e-4], -0.76, [2.5e-2, 1.6e-3, 1.0e-4], -1.00),
    ];
    for (method, slanted, slanted_slope, parallel, parallel_slope) in table {
        for (edges, expected, expected_slope) in [
            (edges(false), slanted, slanted_slope),
            (edges(true), parallel, parallel_slope),
        ] {
            let found = [16, 64, 256, 1024, 4096].map(|n| errors(method, n, &edges));
            // The slope of the least squares line through five equidistant logarithms.
            let weights = [-2.0, -1.0, 0.0, 1.0, 2.0];
            let slope: f64 = weights
                .iter()
                .zip(found)
                .map(|(weight, error)| weight * libm::log(error) / libm::log(4.0))
                .sum::<f64>()
                / 10.0;
            let case = format!("{method:?}: {found:?} for {expected:?}, slope {slope}");
            assert!((slope - expected_slope).abs() < 0.05, "{case}");
            for (found, expected) in [found[0], found[2], found[4]].into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 0.2, "{case}");
            }
        }
    }
}
