//! Numbers about numbers: quantiles, and the straight line through logarithms.

/// The quantile of values in any order, `share` from 0 to 1: 0.5 is the median. Between two values it is interpolated linearly
/// (definition 7 of Hyndman and Fan 1996, "Sample quantiles in statistical packages", the one of R and NumPy). NaN of no values.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share.clamp(0.0, 1.0) * last as f64;
    let below = place.floor();
    let (low, high) = (sorted[below as usize], sorted[last.min(below as usize + 1)]);
    low + (high - low) * (place - below)
}

/// The median of values in any order; NaN of no values.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// The root of the mean of the squares; NaN of no values. Of equal values it is that value, to the bit.
pub fn root_mean_square(values: &[f64]) -> f64 {
    let greatest = values
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    if greatest == 0.0 && !values.is_empty() {
        return 0.0;
    }
    let squares: f64 = values.iter().map(|value| square(value / greatest)).sum();
    greatest * (squares / values.len() as f64).sqrt()
}

/// So many standard errors are exceeded once in 20 times, if a deviation comes from a sum of squares with so many degrees of freedom: quantiles
/// of Student's distribution at 0.975 ("Student" 1908, "The probable error of a mean"; NIST/SEMATECH e-Handbook of Statistical Methods, section 1.3.6.7.2). Infinite for none, and
/// as of ten for more.
pub fn certainty(freedom: usize) -> f64 {
    const QUANTILES: [f64; 10] = [
        12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
    ];
    match freedom.checked_sub(1) {
        None => f64::INFINITY,
        Some(at) => QUANTILES[at.min(QUANTILES.len() - 1)],
    }
}

/// The standard error of the logarithm of the root mean square of some independent values, by the spread of their squares: with n squares, m
/// their mean and v their variance (by n − 1), √(v/n)/2m to first order. None of fewer than two.
pub fn log_error(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    let mean = values.iter().map(|&value| square(value)).sum::<f64>() / n;
    let off: f64 = values
        .iter()
        .map(|&value| square(square(value) - mean))
        .sum();
    let is_known = values.len() > 1 && mean > 0.0;
    is_known.then(|| (off / (n - 1.0) / n).sqrt() / (2.0 * mean))
}

/// The line ln y = ln c + b · ln x of least squares.
///
/// With k points, x̄ and ȳ their means (of the logarithms) and S = Σ(x − x̄)², the slope is b = Σ(x − x̄)(y − ȳ) / S and its standard
/// error √(Σr² / (k − 2) / S), r being the residuals: Draper and Smith, *Applied Regression Analysis*, 3rd ed. 1998, section 1.4.
/// That takes the residuals for independent and alike. But a few points may lie on a line by luck. So where points are measured, standard errors e of the
/// ln y have to be known, and the slope has at least the error that they give it, √(Σ(x − x̄)²e²) / S: of the two the greater one counts. That is the rule by
/// which the Particle Data Group scales the errors of means, up where points scatter more than their own errors say and never down (Review of
/// Particle Physics 2024, section 5.2.2 of its introduction).
///
/// And where the true curve bends, its residuals are neither independent nor alike: the standard error tells how well the mean slope is known, while
/// a reader takes it for that of the curve. So the error is no less than what the slopes within the curve are apart from the line's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// The exponent b of y ∝ x^b.
    pub slope: f64,
    /// How far it may be off, if there are more points than two, and their errors are known if they were measured: the greatest one of the three below.
    pub slope_error: Option<f64>,
    /// The standard error that the residuals give it.
    pub residual_error: Option<f64>,
    /// The standard error that those of the points give it, if they are known.
    pub measured_error: Option<f64>,
    /// The greatest difference between it and the slopes within the curve, if they are known.
    pub bend: Option<f64>,
    /// How many points it goes through.
    pub points: usize,
    /// x̄.
    center: f64,
    /// S.
    spread: f64,
}

impl Fit {
    /// The line through these points, all of whose numbers are positive; none if fewer than two have different x, or a number
    /// has no logarithm.
    pub fn of(points: &[(f64, f64)]) -> Option<Self> {
        let has_logarithm = |number: f64| number > 0.0 && number.is_finite();
        if !points
            .iter()
            .all(|&(x, y)| has_logarithm(x) && has_logarithm(y))
        {
            return None;
        }
        let logs: Vec<_> = points
            .iter()
            .map(|&(x, y)| (libm::log(x), libm::log(y)))
            .collect();
        let k = logs.len() as f64;
        let (x_sum, y_sum) = logs
            .iter()
            .fold((0.0, 0.0), |(a, b), (x, y)| (a + x, b + y));
        let center = (x_sum / k, y_sum / k);
        let spread: f64 = logs.iter().map(|(x, _)| square(x - center.0)).sum();
        if logs.len() < 2 || spread == 0.0 {
            return None;
        }
        let both: f64 = logs
            .iter()
            .map(|(x, y)| (x - center.0) * (y - center.1))
            .sum();
        let slope = both / spread;
        let residuals: f64 = logs
            .iter()
            .map(|(x, y)| square(y - center.1 - slope * (x - center.0)))
            .sum();
        let residual_error = (logs.len() > 2).then(|| (residuals / (k - 2.0) / spread).sqrt());
        Some(Self {
            slope,
            slope_error: residual_error,
            residual_error,
            measured_error: None,
            bend: None,
            points: logs.len(),
            center: center.0,
            spread,
        })
    }

    /// The same line, where the standard error of each ln y is known. If it is not known of all points, neither is how far the slope may be off: the
    /// residuals alone may be small by luck.
    pub fn of_measured(points: &[(f64, f64)], errors: &[Option<f64>]) -> Option<Self> {
        let fit = Self::of(points)?;
        let part = |(&(x, _), error): (&(f64, f64), &Option<f64>)| {
            error.map(|error| square((libm::log(x) - fit.center) * error))
        };
        let variance: Option<f64> = points.iter().zip(errors).map(part).sum();
        let measured_error = variance.map(|variance| variance.sqrt() / fit.spread);
        Some(Self {
            slope_error: fit
                .residual_error
                .zip(measured_error)
                .map(|(a, b)| a.max(b)),
            measured_error,
            ..fit
        })
    }

    /// The same line, where these are the slopes within the curve: if there is an error, it covers them.
    pub fn bent(self, slopes: &[f64]) -> Self {
        let apart = slopes.iter().map(|slope| (slope - self.slope).abs());
        let bend = apart.reduce(f64::max);
        Self {
            slope_error: self.slope_error.map(|error| error.max(bend.unwrap_or(0.0))),
            bend,
            ..self
        }
    }
}

pub(super) fn square(number: f64) -> f64 {
    number * number
}
