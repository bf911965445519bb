//! Computes how likely a picture is, given a prediction.
//!
//! A pixel shows the mean of n samples, rounded. Its error has the variance v/n + s²/12, where v is
//! the variance of one sample in the pixel, and s is the step to which values are rounded. The
//! number n is fitted. The formula is exact only for random sampling, and some pixels may be wrong
//! for other reasons. So errors are modelled by Student's t distribution with two degrees of
//! freedom, which allows large errors (Lange, Little and Taylor, Robust statistical modeling using
//! the t distribution, 1989).
//!
//! Of two hypotheses about the program, the one under which the picture is more likely is chosen.
//! Each fitted number reduces the logarithm of the likelihood by a penalty: half the logarithm of
//! the number of pixels (Schwarz, Estimating the dimension of a model, 1978).

use glam::DVec3;

use super::prediction::{FLAT, Prediction};
use crate::grading::hypotheses::Curve;

/// Number of degrees of freedom of Student's t distribution, by which errors are modelled. With a
/// larger number, a few large errors would change a fit more.
const FREEDOM: f64 = 2.0;

/// Number of rounds in which 1/n is fitted, where n is the number of samples per pixel. Each round
/// reduces the error of 1/n to less than half, so 8 rounds reduce it to less than 1/256.
const ROUNDS: usize = 8;

/// How well a prediction fits a picture.
#[derive(Clone, Debug)]
pub struct Score {
    /// Logarithm of the picture's likelihood, up to a constant.
    pub likelihood: f64,
    /// Number of independent samples per pixel that would cause as much noise as the picture has;
    /// `None` if it has no noise.
    pub samples: Option<f64>,
    /// Squared error of each pixel divided by its variance, summed over the channels.
    pub chi_squares: Vec<f64>,
    /// Sum of the squared differences between the picture and the prediction.
    pub squares: f64,
    /// Part of `squares` that noise and rounding explain.
    pub noise: f64,
    /// Variance of a pixel's error divided by the variance of one sample, i.e. 1/n for n samples
    /// per pixel.
    pub relative_variance: f64,
}

/// Difference between a pixel and its prediction, with two variances from which its own is
/// computed. `variance` is the variance of one sample. `rounding` is the variance of rounding plus
/// the variance of the predicted mean.
struct PixelError {
    difference: DVec3,
    variance: DVec3,
    rounding: DVec3,
}

impl PixelError {
    fn of(prediction: &Prediction, at: usize) -> Self {
        let (variance, steps) = (prediction.moments.variance[at], prediction.steps(at));
        // A pixel that is NaN gives no information.
        let is_empty = prediction.observed[at].x.is_nan();
        Self {
            difference: prediction.difference(at),
            variance: variance.map(|one| if one < FLAT || is_empty { 0.0 } else { one }),
            rounding: steps * steps / 12.0 + prediction.moments.mean_variance[at],
        }
    }

    /// Returns the variance of the error. `relative_variance` is 1/n for n samples per pixel.
    fn total(&self, relative_variance: f64) -> DVec3 {
        self.variance * relative_variance + self.rounding
    }

    /// Returns the squared error divided by its variance, summed over the channels.
    /// `relative_variance` is 1/n for n samples per pixel.
    fn chi_square(&self, relative_variance: f64) -> f64 {
        (self.difference * self.difference / self.total(relative_variance)).element_sum()
    }

    /// Returns the logarithm of the error's probability density, up to a constant.
    /// `relative_variance` is 1/n for n samples per pixel.
    fn density(&self, relative_variance: f64) -> f64 {
        let volume = self.total(relative_variance).element_product();
        -0.5 * libm::log(volume)
            - (FREEDOM + 3.0) / 2.0 * libm::log1p(self.chi_square(relative_variance) / FREEDOM)
    }
}

impl Prediction<'_> {
    /// Scores how well the prediction fits the picture.
    pub fn score(&self) -> Score {
        let errors = (0..self.observed.len()).map(|at| PixelError::of(self, at));
        let errors: Vec<PixelError> = errors.collect();
        // Pixels of one colour have no sampling error, so `relative_variance` is fitted to the
        // other pixels.
        let has_several = |one: &&PixelError| one.variance != DVec3::ZERO;
        let mixed: Vec<&PixelError> = errors.iter().filter(has_several).collect();
        // Estimate of 1/n, where n is the number of samples per pixel: the variance of a pixel's
        // error divided by the variance of one sample.
        let mut relative_variance: f64 = 1.0;
        for _ in 0..ROUNDS {
            let (mut above, mut below) = (0.0, 0.0);
            for one in &mixed {
                let weight = (FREEDOM + 3.0) / (FREEDOM + one.chi_square(relative_variance));
                let total = one.total(relative_variance);
                let part = one.variance / (total * total);
                above += part.dot(weight * one.difference * one.difference - total);
                below += part.dot(one.variance);
            }
            if below > 0.0 {
                relative_variance = (relative_variance + above / below).clamp(1e-6, 1.0);
            }
        }
        // Hypotheses with different encodings decode a picture to different light, so likelihoods
        // of the decoded light cannot be compared. They are converted to likelihoods of the light
        // that viewers see, which is the same for all hypotheses.
        let stretch = |light: &f64| {
            let own = Curve::Correct.step(self.curve.seen(*light));
            libm::log(own / self.curve.step(*light))
        };
        let stretches = self.observed.iter().flat_map(DVec3::as_ref).map(stretch);
        let mut likelihood = match self.curve {
            Curve::Correct => 0.0,
            _ => -stretches.sum::<f64>(),
        };
        let (mut squares, mut expected) = (0.0, 0.0);
        // Sums over the pixels that mix several colours. `of_samples` sums the variances of one
        // sample. `beyond` sums the parts of the squared differences that rounding does not
        // explain.
        let (mut of_samples, mut beyond) = (0.0, 0.0);
        for one in &errors {
            likelihood += one.density(relative_variance);
            let square = one.difference * one.difference;
            squares += square.element_sum();
            expected += one.total(relative_variance).element_sum();
            of_samples += one.variance.element_sum();
            let has_several = one.variance.cmpgt(DVec3::ZERO);
            beyond += DVec3::select(has_several, square - one.rounding, DVec3::ZERO).element_sum();
        }
        // With more than 100 000 samples per pixel, noise cannot be distinguished from rounding, so
        // the number of samples is unknown.
        let is_known = beyond > 1e-5 * of_samples;
        Score {
            likelihood,
            samples: is_known.then(|| (of_samples / beyond).max(1.0)),
            chi_squares: errors
                .iter()
                .map(|one| one.chi_square(relative_variance))
                .collect(),
            squares,
            noise: expected.min(squares),
            relative_variance,
        }
    }

    /// Tests whether the picture fits the prediction `self` or the prediction `other`. The first
    /// result is the observed fraction of the change from `self` to `other`: 0 if the picture fits
    /// `self`, and 1 if it fits `other`. The second result is this fraction divided by its standard
    /// deviation. `score` is the score of `self`.
    pub fn observed_share(&self, score: &Score, other: &Self) -> [f64; 2] {
        let mut deviations = self.deviations();
        // For each pixel, the greater of the two predictions' variances is used. If the predictions
        // assume different encodings, their variances cannot be compared, so those of `self` are
        // used.
        let is_alike = self.curve == other.curve;
        if is_alike {
            let others = deviations.iter_mut().zip(other.deviations());
            others.for_each(|(one, other)| *one = one.max(other));
        }
        let (mut seen, mut all, mut variance) = (0.0, 0.0, 0.0);
        for (at, light) in self.observed.iter().enumerate() {
            let before = self.difference(at);
            let after = match other.curve {
                curve if is_alike || curve == Curve::Correct => other.difference(at),
                curve => light - other.moments.mean[at].map(|mean| curve.seen(mean)),
            };
            if before == after || light.x.is_nan() {
                continue;
            }
            let mut error = self.error(at, score.relative_variance);
            if is_alike {
                error = error.max(other.error(at, score.relative_variance));
            }
            let change = before - after;
            let deviation = DVec3::from_slice(&deviations[3 * at..]);
            let weighted = change / (deviation * deviation);
            seen += weighted.dot(before);
            all += weighted.dot(change);
            variance += (weighted * weighted).dot(error);
        }
        [seen / all.max(1e-300), seen / variance.max(1e-300).sqrt()]
    }

    /// Returns the variance of a pixel's error for each channel. `relative_variance` is 1/n
    /// for n samples per pixel.
    pub fn error(&self, at: usize, relative_variance: f64) -> DVec3 {
        PixelError::of(self, at).total(relative_variance)
    }
}
