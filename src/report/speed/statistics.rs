//! The median, the root mean square, and the line of least squares.

/// Returns the median of values in any order; for an even number of them, the mean of the middle
/// two. NaN if there are none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        odd if odd % 2 == 1 => sorted[odd / 2],
        even => f64::midpoint(sorted[even / 2 - 1], sorted[even / 2]),
    }
}

/// Returns the root of the mean of the squares; NaN if there are no values.
pub fn root_mean_square(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|value| value * value).sum();
    (squares / values.len() as f64).sqrt()
}

/// A power law y = c · x^b, fitted as the line of least squares through the logarithms.
///
/// With k points, x̄ and ȳ the means of the logarithms and S = Σ(x − x̄)², the slope is b = Σ(x −
/// x̄)(y − ȳ) / S and its standard error √(Σr² / (k − 2) / S), r being the residuals: Draper and
/// Smith, *Applied Regression Analysis*, 3rd ed. 1998, section 1.4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// The exponent b.
    pub slope: f64,
    /// The standard error of b; `None` for fewer than four points, since one residual more than
    /// the line has parameters means next to nothing.
    pub slope_error: Option<f64>,
}

impl PowerLaw {
    /// Fits points (x, y). Returns `None` if fewer than two points have different x, or a number
    /// has no logarithm.
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
