//! Statistics: median, root mean square, slope of a fitted line, and standard error of a mean.

/// Returns the median of `values`, which need not be sorted. For an even number of values, this is
/// the mean of the middle two. Returns NaN if there are no values.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => sorted[odd / 2],
        even => f64::midpoint(sorted[even / 2 - 1], sorted[even / 2]),
    }
}

/// Returns the root mean square of `values`, or NaN if there are none.
pub fn root_mean_square(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|value| value * value).sum();
    (squares / values.len() as f64).sqrt()
}

/// Fits a power law y = c·x^b to the points (x, y), and returns its exponent b. In logarithms, b is
/// the slope of the line of least squares,
///
/// b = Σ(X − X̄)·(Y − Ȳ)/Σ(X − X̄)²,
///
/// where X and Y are the logarithms of x and y, and X̄ and Ȳ their means. Returns `None` if there
/// are fewer than two different values of x, or if a number has no logarithm.
pub fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let logs = points.iter().map(|&(x, y)| (libm::log(x), libm::log(y)));
    let logs: Vec<_> = logs.collect();
    let count = logs.len() as f64;
    let x_mean = logs.iter().map(|log| log.0).sum::<f64>() / count;
    let y_mean = logs.iter().map(|log| log.1).sum::<f64>() / count;
    let products = logs.iter().map(|(x, y)| (x - x_mean) * (y - y_mean));
    let squares = logs.iter().map(|(x, _)| (x - x_mean) * (x - x_mean));
    let slope = products.sum::<f64>() / squares.sum::<f64>();
    slope.is_finite().then_some(slope)
}

/// Returns the standard error of the mean of the n numbers in `values`. It is s/√n, where s is
/// their standard deviation with the divisor n − 1. Returns `None` for fewer than three numbers,
/// because their standard deviation is too uncertain.
pub fn standard_error(values: &[f64]) -> Option<f64> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    (values.len() >= 3).then(|| (squares / (count - 1.0) / count).sqrt())
}
