//! The median, the root mean square, and the line of least squares.

/// Returns the median of `values`, which may be in any order. For an even number of values, it is
/// the mean of the middle two. Returns NaN if there are none.
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

/// A power law y = c·x^b, fitted by least squares as a line through the logarithms of the points.
///
/// With k points, x̄ and ȳ the means of the logarithms, r the residuals, and S = Σ(x − x̄)², the
/// slope and its standard error are
///
/// slope: b = Σ(x − x̄)·(y − ȳ)/S, standard error: √(Σr²/(k − 2)/S)
///
/// (Draper and Smith, *Applied Regression Analysis*, 3rd ed. 1998, section 1.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// Exponent b, the slope of the line.
    pub slope: f64,
    /// Standard error of b; `None` for fewer than four points. With three points and two fitted
    /// parameters, only one degree of freedom is left, and the standard error would mean next to
    /// nothing.
    pub slope_error: Option<f64>,
}

impl PowerLaw {
    /// Fits a power law to the points (x, y). Returns `None` if there are not at least two
    /// different x, or if a number has no logarithm.
    pub fn fit(points: &[(f64, f64)]) -> Option<Self> {
        let logs: Vec<_> = points
            .iter()
            .map(|&(x, y)| (libm::log(x), libm::log(y)))
            .collect();
        let k = logs.len() as f64;
        let mean = |pick: fn(&(f64, f64)) -> f64| logs.iter().map(pick).sum::<f64>() / k;
        let (x_mean, y_mean) = (mean(|log| log.0), mean(|log| log.1));
        let centered = || logs.iter().map(|(x, y)| (x - x_mean, y - y_mean));
        let spread: f64 = centered().map(|(x, _)| x * x).sum();
        let slope = centered().map(|(x, y)| x * y).sum::<f64>() / spread;
        let residuals: f64 = centered()
            .map(|(x, y)| (y - slope * x) * (y - slope * x))
            .sum();
        slope.is_finite().then_some(Self {
            slope,
            slope_error: (logs.len() > 3).then(|| (residuals / (k - 2.0) / spread).sqrt()),
        })
    }
}
