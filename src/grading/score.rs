//! How likely a picture is if a model of it is right.
//!
//! A pixel shows the mean of n samples, rounded: its error has the variance v/n + r², v being that of one sample within it and r² that of rounding to a step,
//! a twelfth of its square. Or it shows something else, any colour as likely as any other. The share of such pixels and n are fitted. Of two
//! models that one is taken which has the greater likelihood, less half a logarithm of the number of pixels for each number that was fitted: Schwarz, Estimating the
//! dimension of a model, 1978. It is the only rule of significance here.

use super::textbook::Moments;
use crate::color::{linear_to_srgb, srgb_to_linear};

/// A step of 8-bit sRGB. Nobody sees less, so no file is taken for finer.
pub const STEP: f64 = 1.0 / 255.0;

/// Fitting goes on for so many rounds: each leaves less than half of what is missing.
const ROUNDS: usize = 12;

/// The variance below which a pixel shows one colour: a part of 1e-9 of it may be another.
pub const FLAT: f64 = 1e-9;

/// What a picture should show, if something is right.
#[derive(Clone, Debug)]
pub struct Model {
    /// Means and variances.
    pub moments: Moments,
    /// How many samples the means were computed from; none if they are exact.
    pub from: Option<usize>,
    /// By how much bytes are cut off on an average, in steps.
    pub cut: f64,
}

/// How well a model fits.
#[derive(Clone, Debug)]
pub struct Score {
    /// The logarithm of the likelihood.
    pub likelihood: f64,
    /// The number of independent samples in a pixel that make as much noise.
    pub samples: f64,
    /// The share of pixels that show something else.
    pub outliers: f64,
    /// For each pixel whether it is likelier one of those.
    pub is_outlier: Vec<bool>,
    /// The squared difference.
    pub squares: f64,
    /// The part of it that noise of so many samples makes.
    pub noise: f64,
}

impl Score {
    /// What is to be small, with so many numbers fitted to so many pixels.
    pub fn cost(&self, fitted: usize, pixels: usize) -> f64 {
        0.5 * fitted as f64 * libm::log(pixels as f64) - self.likelihood
    }
}

/// The standard deviation of rounding a light's encoding to a step.
fn rounding(light: f64) -> f64 {
    let encoded = linear_to_srgb(light.clamp(0.0, 1.0));
    // The steps on both sides: the curve is bent, and white has none above.
    (srgb_to_linear(encoded + STEP / 2.0) - srgb_to_linear((encoded - STEP / 2.0).max(0.0)))
        / libm::sqrt(12.0)
}

/// What is known of a pixel: its difference, its variance and that of rounding.
#[derive(Clone, Copy)]
struct Known {
    difference: [f64; 3],
    variance: [f64; 3],
    rounding: [f64; 3],
}

/// Judges a model of a picture of so many pixels in a row.
pub fn score(seen: &[[f64; 3]], model: &Model, width: usize) -> Score {
    let variances = model.variances(width);
    let mut last = ([f64::NAN; 3], [0.0; 3]);
    let known = |at: usize| {
        let (mean, variance) = (model.moments.mean[at], variances[at]);
        if last.0 != mean {
            last = (mean, mean.map(|light| rounding(light) * rounding(light)));
        }
        Known {
            difference: [0, 1, 2].map(|i| model.difference(seen[at][i], mean[i], variance)),
            variance,
            rounding: last.1,
        }
    };
    let known: Vec<Known> = (0..seen.len()).map(known).collect();
    // What all pixels have that are of one colour and right is counted once.
    let is_plain = |one: &Known| {
        one.variance == [0.0; 3]
            && one
                .difference
                .iter()
                .zip(one.rounding)
                .all(|(d, r)| d * d <= r)
    };
    let others: Vec<(usize, Known)> = known
        .iter()
        .copied()
        .enumerate()
        .filter(|(_, one)| !is_plain(one))
        .collect();
    let plain: f64 = known
        .iter()
        .filter(|one| is_plain(one))
        .map(|one| one.density(0.0))
        .sum();
    let plain_count = known.len() - others.len();

    // 1/n, which is 1 at most, and the share of outliers.
    let (mut noise, mut share) = (1.0, 0.01);
    let mut weights = vec![1.0; others.len()];
    for _ in 0..ROUNDS {
        let (mut above, mut below, mut inside) = (0.0, 0.0, plain_count as f64);
        for ((_, one), weight) in others.iter().zip(&mut weights) {
            let right = (1.0 - share) * libm::exp(one.density(noise).min(300.0));
            *weight = right / (right + share);
            inside += *weight;
            for i in 0..3 {
                let total = one.variance[i] * noise + one.rounding[i];
                let part = *weight * one.variance[i] / (total * total);
                above += part * (one.difference[i] * one.difference[i] - total);
                below += part * one.variance[i];
            }
        }
        if below > 0.0 {
            noise = (noise + above / below).clamp(1e-6, 1.0);
        }
        let count = known.len() as f64;
        share = ((count - inside) / count).clamp(1e-9, 0.999);
    }
    let mut likelihood = plain + plain_count as f64 * libm::log(1.0 - share);
    let mut is_outlier = vec![false; known.len()];
    let (mut squares, mut expected) = (0.0, 0.0);
    for ((at, one), weight) in others.iter().zip(&weights) {
        let density = one.density(noise);
        let (right, other) = (libm::log(1.0 - share) + density, libm::log(share));
        let most = right.max(other);
        likelihood += most + libm::log(libm::exp(right - most) + libm::exp(other - most));
        is_outlier[*at] = *weight < 0.5;
        for i in 0..3 {
            squares += one.difference[i] * one.difference[i];
            expected += one.variance[i] * noise + one.rounding[i];
        }
    }
    Score {
        likelihood,
        samples: 1.0 / noise,
        outliers: share,
        is_outlier,
        squares,
        noise: expected.min(squares),
    }
}

impl Known {
    /// The logarithm of the density, if a sample has this share of its variance.
    fn density(&self, noise: f64) -> f64 {
        let channel = |i: usize| {
            let total = self.variance[i] * noise + self.rounding[i];
            let square = self.difference[i] * self.difference[i] / total;
            square + libm::log(2.0 * std::f64::consts::PI * total)
        };
        -0.5 * (0..3).map(channel).sum::<f64>()
    }
}

impl Model {
    /// The variances of one sample, with what the model's own few samples may have missed beside an edge.
    fn variances(&self, width: usize) -> Vec<[f64; 3]> {
        let own = &self.moments.variance;
        let Some(samples) = self.from else {
            return own
                .iter()
                .map(|one| one.map(|one| if one < FLAT { 0.0 } else { one }))
                .collect();
        };
        let around = around(own, width);
        let count = samples as f64;
        own.iter()
            .zip(around)
            .map(|(own, most)| [0, 1, 2].map(|i| own[i] + most[i] / count))
            .collect()
    }

    /// The difference in light of what is seen from what is expected.
    pub fn difference(&self, seen: f64, mean: f64, variance: [f64; 3]) -> f64 {
        if self.cut == 0.0 {
            return seen - mean;
        }
        let steps = (linear_to_srgb(seen) - linear_to_srgb(mean)) / STEP;
        // A colour alone is cut off or not, by the last bit of its number; mixtures lose half a step.
        let is_alone = variance == [0.0; 3];
        let from = if is_alone {
            steps.clamp(2.0 * self.cut, 0.0)
        } else {
            self.cut
        };
        (steps - from) * rounding(mean) * libm::sqrt(12.0)
    }
}

/// The greatest variance of each cell and its eight neighbours.
pub fn around(variances: &[[f64; 3]], width: usize) -> Vec<[f64; 3]> {
    let most = |one: [f64; 3], other: [f64; 3]| [0, 1, 2].map(|i| f64::max(one[i], other[i]));
    let in_rows: Vec<_> = variances
        .chunks_exact(width)
        .flat_map(|row| {
            (0..width).map(move |x| {
                let near = &row[x.saturating_sub(1)..(x + 2).min(width)];
                near.iter().copied().fold([0.0; 3], most)
            })
        })
        .collect();
    let height = variances.len() / width;
    (0..variances.len())
        .map(|at| {
            let (x, y) = (at % width, at / width);
            let rows = y.saturating_sub(1)..(y + 2).min(height);
            rows.map(|y| in_rows[y * width + x]).fold([0.0; 3], most)
        })
        .collect()
}
