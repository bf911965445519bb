//! How likely a picture is, given a prediction.
//!
//! A pixel shows the mean of n samples, rounded: its error has the variance v/n + r², where v is
//! the variance of one sample in the pixel, and r² that of rounding, a twelfth of a step's square.
//! n is fitted. Only random sampling has just this variance everywhere, and some pixels may be
//! wrong for other reasons, so errors are modelled by Student's distribution with two degrees of
//! freedom (Lange, Little and Taylor, Robust statistical modeling using the t distribution, 1989).
//! Of two candidates the one is chosen that has the greater likelihood, less half a logarithm of
//! the number of pixels for each fitted number (Schwarz, Estimating the dimension of a model,
//! 1978).

use glam::DVec3;

use super::prediction::{FLAT, Prediction};
use crate::grading::hypotheses::Curve;

/// Degrees of freedom of the errors' distribution.
const FREEDOM: f64 = 2.0;

/// Rounds of fitting 1/n; each more than halves the remaining error.
const ROUNDS: usize = 8;

/// How well a prediction fits a picture.
#[derive(Clone, Debug)]
pub struct Score {
    /// Logarithm of the likelihood.
    pub likelihood: f64,
    /// Number of independent samples in a pixel that cause as much noise; `None` if there is no
    /// noise.
    pub samples: Option<f64>,
    /// Squared error of each pixel in standard deviations, summed over its channels.
    pub chi_squares: Vec<f64>,
    /// Sum of the squared differences.
    pub squares: f64,
    /// Part of the squared differences that noise explains.
    pub noise: f64,
    /// Share of a sample's variance that a pixel's error has: 1/n.
    pub share: f64,
}

/// The difference of a pixel, with the variances of one sample and of everything else: rounding and
/// the uncertainty of the expected mean.
struct PixelError {
    difference: DVec3,
    variance: DVec3,
    rounding: DVec3,
}

impl PixelError {
    fn of(prediction: &Prediction, at: usize) -> Self {
        let variance = prediction.moments.variance[at];
        // An empty pixel has no information.
        let is_empty = prediction.observed[at].x.is_nan();
        Self {
            difference: prediction.difference(at),
            variance: variance.map(|one| if one < FLAT || is_empty { 0.0 } else { one }),
            rounding: rounding(prediction, at),
        }
    }

    /// Returns the variance of the error, given its share of a sample's variance.
    fn total(&self, share: f64) -> DVec3 {
        self.variance * share + self.rounding
    }

    /// Returns the sum of the squares in standard deviations, given the share of a sample's
    /// variance.
    fn chi_square(&self, share: f64) -> f64 {
        (self.difference * self.difference / self.total(share)).element_sum()
    }

    /// Returns the logarithm of the density, up to a constant.
    fn density(&self, share: f64) -> f64 {
        let volume = self.total(share).element_product();
        -0.5 * libm::log(volume)
            - (FREEDOM + 3.0) / 2.0 * libm::log1p(self.chi_square(share) / FREEDOM)
    }
}

/// Returns the variances of rounding and of the expected mean.
fn rounding(prediction: &Prediction, at: usize) -> DVec3 {
    let steps = prediction.steps(at);
    steps * steps / 12.0 + prediction.moments.mean_variance[at]
}

impl Prediction<'_> {
    /// Scores the prediction.
    pub fn score(&self) -> Score {
        let errors = (0..self.observed.len()).map(|at| PixelError::of(self, at));
        let errors: Vec<PixelError> = errors.collect();
        // 1/n, which is at most 1.
        let mut share: f64 = 1.0;
        for _ in 0..ROUNDS {
            let (mut above, mut below) = (0.0, 0.0);
            for one in &errors {
                let weight = (FREEDOM + 3.0) / (FREEDOM + one.chi_square(share));
                let total = one.total(share);
                let part = one.variance / (total * total);
                above += part.dot(weight * one.difference * one.difference - total);
                below += part.dot(one.variance);
            }
            if below > 0.0 {
                share = (share + above / below).clamp(1e-6, 1.0);
            }
        }
        // Densities refer to the light of the picture itself.
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
        // Over pixels of several colours: variances of a sample, and squared differences beyond
        // rounding.
        let (mut of_samples, mut beyond) = (0.0, 0.0);
        for one in &errors {
            likelihood += one.density(share);
            let square = one.difference * one.difference;
            squares += square.element_sum();
            expected += one.total(share).element_sum();
            of_samples += one.variance.element_sum();
            let has_several = one.variance.cmpgt(DVec3::ZERO);
            beyond += DVec3::select(has_several, square - one.rounding, DVec3::ZERO).element_sum();
        }
        // Less noise than of 100 000 samples is rounding.
        let is_known = beyond > 1e-5 * of_samples;
        Score {
            likelihood,
            samples: is_known.then(|| (of_samples / beyond).max(1.0)),
            chi_squares: errors.iter().map(|one| one.chi_square(share)).collect(),
            squares,
            noise: expected.min(squares),
            share,
        }
    }

    /// Returns the observed share of the change from this prediction, whose score is given, to
    /// another one, and that share in standard deviations, with the greater of the two predictions'
    /// variances.
    pub fn observed_share(&self, score: &Score, other: &Self) -> [f64; 2] {
        let mut deviations = self.deviations();
        // Light that is encoded by another curve has variances of its own.
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
            let mut error = self.error(at, score.share);
            if is_alike {
                error = error.max(other.error(at, score.share));
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

    /// Returns the variances of a pixel's error, given its share of a sample's variance.
    pub fn error(&self, at: usize, share: f64) -> DVec3 {
        PixelError::of(self, at).total(share)
    }
}
