//! Tests of the errors of sample points, and of how fast the errors fall with more samples.

use super::*;

/// Averaged over many pixels, the fraction of a pixel's points that lie in a box must be the area
/// of the box. Several boxes are tested.
#[test]
fn every_method_except_regular_and_scatter_is_unbiased() {
    for method in Method::SAMPLED {
        if matches!(method, Method::Regular | Method::Scatter) {
            continue;
        }
        for n in [1, 2, 3, 5, 7, 12, 17] {
            let sampling = sampling(method, n, 1);
            let pixels = Area::whole(64, 64).iter();
            let pixels = pixels.map(|(x, y)| points_at(&sampling, [x, y], 0..n));
            let pixels: Vec<_> = pixels.collect();
            for (min, max) in [
                (DVec2::new(-0.5, -0.5), DVec2::new(-0.2, 0.1)),
                (DVec2::new(0.13, -0.5), DVec2::new(0.5, 0.5)),
                (DVec2::new(-0.31, 0.22), DVec2::new(0.17, 0.41)),
            ] {
                let is_in = |point: &&DVec2| point.cmpge(min).all() && point.cmplt(max).all();
                let area = (max - min).element_product();
                let off = pixels
                    .iter()
                    .map(|points| points.iter().filter(is_in).count() as f64 / n as f64 - area);
                let (mean, error) = mean_and_error(off.collect());
                let most = 4.0 * error + 1e-12;
                assert!(mean.abs() <= most, "{method:?}, {n}: {mean} ± {error}");
            }
        }
    }
}

/// Returns the mean of `numbers` and the standard error of the mean.
fn mean_and_error(numbers: Vec<f64>) -> (f64, f64) {
    let count = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / count;
    let squares = numbers.iter().map(|one| (one - mean) * (one - mean));
    (mean, (squares.sum::<f64>() / (count - 1.0) / count).sqrt())
}

/// Edge of a half-plane in a pixel, given by its normal, its distance from the pixel's centre, and
/// the area of the part of the pixel that is in the half-plane.
///
/// Random edges are not parallel to the cells (strata) in which methods place points. Errors at
/// parallel edges would not tell the methods apart.
type Edge = (DVec2, f64, f64);

/// Returns the error at each edge: the fraction of the points in its half-plane, minus the area of
/// the half-plane's part of the pixel. The errors are independent, because each edge is tested with
/// the points of a different pixel.
fn errors(method: Method, n: u64, edges: &[Edge]) -> Vec<f64> {
    let sampling = sampling(method, n, n);
    let error = |(i, &(normal, distance, area)): (u32, &Edge)| {
        let points = points_at(&sampling, [i % 64, i / 64], 0..n);
        let inside = points.iter().filter(|point| point.dot(normal) < distance);
        inside.count() as f64 / n as f64 - area
    };
    (0..).zip(edges).map(error).collect()
}

/// Returns the mean of the differences between squared errors and their expected values, and the
/// standard error of this mean.
fn excess(errors: Vec<f64>, expected: impl Iterator<Item = f64>) -> (f64, f64) {
    let squares = errors.iter().map(|error| error * error);
    mean_and_error(
        squares
            .zip(expected)
            .map(|(square, e)| square - e)
            .collect(),
    )
}

/// Returns the area of the part of the pixel whose points p satisfy normal · p < distance.
///
/// The pixel is a combination of four infinite quadrants, one at each corner: two are added and two
/// are subtracted. The edge cuts a triangle off each quadrant, and the result is the sum of the
/// triangles' areas with the same signs.
fn area(normal: DVec2, distance: f64) -> f64 {
    let DVec2 { x, y } = normal.abs();
    let triangle = |height: f64| height.max(0.0) * height.max(0.0) / (2.0 * x * y);
    let [sum, difference] = [(x + y) / 2.0, (x - y) / 2.0];
    triangle(distance + sum) - triangle(distance + difference) - triangle(distance - difference)
        + triangle(distance - sum)
}

/// Returns edges at random angles through random points of a pixel.
fn edges() -> Vec<Edge> {
    let points = points(Method::Random, 4 * 900, 123, [1, 1]);
    let edge = |pair: &[DVec2]| {
        let (sin, cos) = libm::sincos((pair[0].x + 0.5) * std::f64::consts::TAU);
        let normal = DVec2::new(cos, sin);
        let distance = pair[1].dot(normal);
        (normal, distance, area(normal, distance))
    };
    points.chunks_exact(2).map(edge).collect()
}

/// Numbers of samples per pixel at which errors are measured. They are powers of 4, so that their
/// logarithms are equidistant and every method has full grids.
const COUNTS: [u64; 5] = [16, 64, 256, 1024, 4096];

/// Returns the variance of the fraction of points in an edge's half-plane, for `n` independent
/// points.
fn variance_of_independent_points(n: u64, (_, _, area): Edge) -> f64 {
    area * (1.0 - area) / n as f64
}

/// Returns the variance of the fraction of points in an edge's half-plane, if each of `n` square
/// cells contains one point. Only cells that the edge crosses contribute.
fn variance_of_one_point_per_cell(n: u64, (normal, distance, _): Edge) -> f64 {
    let side = n.isqrt();
    let middle = |i: u64| (i as f64 + 0.5) / side as f64 - 0.5;
    let cells = (0..n).map(|i| DVec2::new(middle(i % side), middle(i / side)));
    let distances = cells.map(|cell| (distance - cell.dot(normal)) * side as f64);
    let cut = distances.filter(|distance| distance.abs() < 0.75);
    let shares = cut.map(|distance| area(normal, distance));
    shares.map(|share| share * (1.0 - share)).sum::<f64>() / (n * n) as f64
}

#[test]
fn squared_errors_match_theory() {
    let edges = edges();
    for n in COUNTS {
        let beyond = |method, variance: &dyn Fn(Edge) -> f64| {
            let expected = edges.iter().map(|&edge| variance(edge));
            let (excess, error) = excess(errors(method, n, &edges), expected);
            excess / error
        };
        let off = beyond(Method::Random, &|edge| {
            variance_of_independent_points(n, edge)
        });
        assert!(off.abs() < 4.0, "{n}: {off}");
        let off = beyond(Method::Jittered, &|edge| {
            variance_of_one_point_per_cell(n, edge)
        });
        assert!(off.abs() < 4.0, "{n}: {off}");
        // For n points of a Latin hypercube, the variance of the fraction of points in the edge's
        // half-plane is at most that of n − 1 independent points (Owen 1997, "Monte Carlo variance
        // of scrambled net quadrature"). It may be much smaller, so `off` has only an upper limit.
        let off = beyond(Method::NRooks, &|edge| {
            variance_of_independent_points(n - 1, edge)
        });
        assert!(off < 4.0, "{n}: {off}");
    }
}

/// If each cell contains one point, the logarithm of the error falls with a slope of −3/4 (Mitchell
/// 1996). Scrambled nets have the same slope (He and Owen 2014).
#[test]
fn stratified_errors_fall_with_a_slope_of_minus_three_quarters() {
    let edges = edges();
    for method in [
        Method::MultiJittered,
        Method::Hammersley,
        Method::Halton,
        Method::Sobol,
    ] {
        // The loop fits a line through the logarithms of the errors at the five elements of
        // `COUNTS` by least squares. It computes the slope of the line and the standard error of
        // the slope. The weights are constant, because the logarithms of the counts are
        // equidistant.
        let (mut slope, mut variance) = (0.0, 0.0);
        for (weight, n) in [-0.2, -0.1, 0.0, 0.1, 0.2].into_iter().zip(COUNTS) {
            let nothing = std::iter::repeat(0.0);
            let (square, error) = excess(errors(method, n, &edges), nothing);
            let weight = weight / libm::log(4.0);
            slope += weight * libm::log(square) / 2.0;
            variance += (weight * error / square / 2.0) * (weight * error / square / 2.0);
        }
        let error = variance.sqrt();
        assert!(error < 0.01, "{method:?}: {error}");
        assert!(slope < -0.75 + 4.0 * error, "{method:?}: {slope} ± {error}");
    }
}
