//! How likely a picture is if a prediction of it is right.
//!
//! A pixel shows the mean of n samples, rounded: its error has the variance v/n + r², v being that
//! of one sample within it and r² that of rounding to a step, a twelfth of its square. n is fitted.
//! As no sampling but a random one has just that variance everywhere, and as something else may be
//! wrong in some pixels, too, errors are taken to have Student's distribution with two degrees of
//! freedom (Lange, Little and Taylor, Robust statistical modeling using the t distribution, 1989).
//! Of two candidates that one is taken which has the greater likelihood, less half a logarithm of
//! the number of pixels for each number that was fitted: Schwarz, Estimating the dimension of a
//! model, 1978.

use glam::DVec3;

use super::{
    light::Curve,
    prediction::{FLAT, Prediction},
};

/// Degrees of freedom of errors.
const FREEDOM: f64 = 2.0;

/// Fitting goes on for so many rounds: each leaves less than half of what is missing.
const ROUNDS: usize = 8;

/// How well a prediction fits.
#[derive(Clone, Debug)]
pub struct Score {
    /// The logarithm of the likelihood.
    pub likelihood: f64,
    /// The number of independent samples in a pixel that make as much noise.
    pub samples: Option<f64>,
    /// How far each pixel is off, in standard deviations of its error: the sum of the squares of
    /// its channels.
    pub off: Vec<f64>,
    /// The squared difference.
    pub squares: f64,
    /// The part of it that noise of so many samples makes.
    pub noise: f64,
    /// The share of a sample's variance that a pixel's error has: 1/n.
    pub share: f64,
}

/// The error of a pixel, the variance of a sample in it, and that of rounding and of what is
/// expected itself.
struct Error {
    difference: DVec3,
    variance: DVec3,
    rounding: DVec3,
}

impl Error {
    fn of(prediction: &Prediction, at: usize) -> Self {
        let variance = prediction.moments.variance[at];
        // Nothing is known of a pixel that is empty.
        let is_empty = prediction.seen[at].x.is_nan();
        Self {
            difference: prediction.difference(at),
            variance: variance.map(|one| if one < FLAT || is_empty { 0.0 } else { one }),
            rounding: rounding(prediction, at),
        }
    }

    /// Its variance, if it has this share of a sample's.
    fn total(&self, share: f64) -> DVec3 {
        self.variance * share + self.rounding
    }

    /// The sum of the squares in standard deviations, if an error has this share of a sample's
    /// variance.
    fn off(&self, share: f64) -> f64 {
        (self.difference * self.difference / self.total(share)).element_sum()
    }

    /// The logarithm of the density, but for a number that all have.
    fn density(&self, share: f64) -> f64 {
        let volume = self.total(share).element_product();
        -0.5 * libm::log(volume) - (FREEDOM + 3.0) / 2.0 * libm::log1p(self.off(share) / FREEDOM)
    }
}

/// The variances of rounding and of what is expected itself.
fn rounding(prediction: &Prediction, at: usize) -> DVec3 {
    let steps = prediction.steps(at);
    steps * steps / 12.0 + prediction.moments.doubt[at]
}

impl Prediction<'_> {
    /// How likely what is seen is.
    pub fn score(&self) -> Score {
        let errors = (0..self.seen.len()).map(|at| Error::of(self, at));
        let errors: Vec<Error> = errors.collect();
        // 1/n, which is 1 at most.
        let mut share: f64 = 1.0;
        for _ in 0..ROUNDS {
            let (mut above, mut below) = (0.0, 0.0);
            for one in &errors {
                let weight = (FREEDOM + 3.0) / (FREEDOM + one.off(share));
                let total = one.total(share);
                let part = one.variance / (total * total);
                above += part.dot(weight * one.difference * one.difference - total);
                below += part.dot(one.variance);
            }
            if below > 0.0 {
                share = (share + above / below).clamp(1e-6, 1.0);
            }
        }
        // Densities are told of the picture's own light.
        let stretch = |light: &f64| {
            let own = Curve::Right.step(self.curve.seen(*light));
            libm::log(own / self.curve.step(*light))
        };
        let mut likelihood = match self.curve {
            Curve::Right => 0.0,
            _ => -self
                .seen
                .iter()
                .flat_map(DVec3::as_ref)
                .map(stretch)
                .sum::<f64>(),
        };
        let (mut squares, mut expected) = (0.0, 0.0);
        // Of pixels of several colours: the variances of a sample, and the squared differences
        // beyond rounding.
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
        // What is left of less than a sample in a hundred thousand is rounding.
        let is_known = beyond > 1e-5 * of_samples;
        Score {
            likelihood,
            samples: is_known.then(|| (of_samples / beyond).max(1.0)),
            off: errors.iter().map(|one| one.off(share)).collect(),
            squares,
            noise: expected.min(squares),
            share,
        }
    }

    /// The part that is seen of what another prediction changes, and of how many standard
    /// deviations that part is, where errors have the greater variances of the two; this is the
    /// score of this one.
    pub fn part_seen(&self, score: &Score, other: &Self) -> [f64; 2] {
        let mut deviations = self.deviations();
        // Light that is encoded otherwise has variances of its own.
        let is_alike = self.curve == other.curve;
        if is_alike {
            let others = deviations.iter_mut().zip(other.deviations());
            others.for_each(|(one, other)| *one = one.max(other));
        }
        let (mut seen, mut all, mut variance) = (0.0, 0.0, 0.0);
        for (at, light) in self.seen.iter().enumerate() {
            let before = self.difference(at);
            let after = match other.curve {
                curve if is_alike || curve == Curve::Right => other.difference(at),
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

    /// The variances of the errors of a pixel that have this share of a sample's.
    pub fn error(&self, at: usize, share: f64) -> DVec3 {
        Error::of(self, at).total(share)
    }
}
