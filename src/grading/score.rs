//! How likely a picture is if a model of it is right.
//!
//! A pixel shows the mean of n samples, rounded: its error has the variance v/n + r², v being that of one sample within it and r² that of rounding to a step,
//! a twelfth of its square. n is fitted. As no sampling but a random one has just that variance everywhere, and as something else may be wrong in some pixels, too,
//! errors are taken to have Student's distribution with two degrees of freedom (Lange, Little and Taylor, Robust statistical modeling using the t distribution,
//! 1989). Of two models that one is taken which has the greater likelihood, less half a logarithm of the number of pixels for each number that was fitted: Schwarz,
//! Estimating the dimension of a model, 1978. Where no pixel is wrong for certain, the likelihoods have to differ by the errors that noise alone may make (`gain`). `Strays` are the
//! pixels that no sampling of a model explains.

use std::{
    collections::HashMap,
    sync::{Arc, OnceLock},
};

use super::{
    light::{Curve, STEP},
    textbook::Moments,
};
use crate::color::{linear_to_srgb, srgb_to_linear};

/// Degrees of freedom of errors.
const FREEDOM: f64 = 2.0;

/// Fitting goes on for so many rounds: each leaves less than half of what is missing.
const ROUNDS: usize = 8;

/// The variance below which a pixel shows one colour: a part of 1e-9 of it may be another.
pub const FLAT: f64 = 1e-9;

/// Means are the same that differ by less, which is what rounding leaves of them.
const SAME: f64 = 1e-9;

/// What a picture should show, if something is right.
#[derive(Clone, Debug)]
pub struct Model {
    /// Means and variances.
    pub moments: Arc<Moments>,
    /// The variances of the means themselves; empty if they are exact.
    pub doubt: Vec<[f64; 3]>,
    /// By how much bytes are cut off on an average, in steps.
    pub cut: f64,
    /// How light is encoded: what is seen is compared as the light that was encoded so.
    pub curve: Curve,
}

/// How well a model fits.
#[derive(Clone, Debug)]
pub struct Score {
    /// The logarithm of the likelihood.
    pub likelihood: f64,
    /// The number of independent samples in a pixel that make as much noise.
    pub samples: Option<f64>,
    /// How far each pixel is off, in standard deviations of its error: the sum of the squares of its channels.
    pub off: Vec<f64>,
    /// The squared difference.
    pub squares: f64,
    /// The part of it that noise of so many samples makes.
    pub noise: f64,
    /// The share of a sample's variance that a pixel's error has: 1/n.
    share: f64,
}

impl Score {
    /// What is to be small, with so many numbers fitted to so many pixels.
    pub fn cost(&self, fitted: usize, pixels: f64) -> f64 {
        0.5 * fitted as f64 * libm::log(pixels) - self.likelihood
    }
}

/// The standard deviation of light that a step of the encoding of what is seen in its place rounds off.
fn rounding(light: f64, curve: Curve) -> f64 {
    /// So many lights are told apart.
    const LIGHTS: usize = 4096;
    static ROUNDINGS: [OnceLock<Vec<f64>>; Curve::ALL.len()] =
        [const { OnceLock::new() }; Curve::ALL.len()];
    let of = |at: usize| {
        let encoded = linear_to_srgb(curve.seen(at as f64 / LIGHTS as f64));
        let light = |encoded: f64| curve.light(srgb_to_linear(encoded.max(0.0)));
        (light(encoded + STEP / 2.0) - light(encoded - STEP / 2.0)) / libm::sqrt(12.0)
    };
    let roundings = ROUNDINGS[curve as usize].get_or_init(|| (0..=LIGHTS).map(of).collect());
    roundings[(light.clamp(0.0, 1.0) * LIGHTS as f64).round() as usize]
}

/// What is known of a pixel: its difference, its variance, and that of rounding and of the model itself.
#[derive(Clone, Copy)]
struct Known {
    difference: [f64; 3],
    variance: [f64; 3],
    rounding: [f64; 3],
}

/// Judges a model of a picture of so many pixels in a row.
pub fn score(seen: &[[f64; 3]], model: &Model) -> Score {
    let mut last = ([f64::NAN; 3], [0.0; 3]);
    let known = |at: usize| {
        let (mean, variance) = (model.moments.mean[at], model.moments.variance[at]);
        // Nothing is known of a pixel that is empty.
        let is_empty = seen[at][0].is_nan();
        let variance = variance.map(|one| if one < FLAT || is_empty { 0.0 } else { one });
        if last.0 != mean {
            last = (
                mean,
                mean.map(|light| {
                    let deviation = rounding(light, model.curve);
                    deviation * deviation
                }),
            );
        }
        Known {
            difference: [0, 1, 2].map(|i| model.difference(seen[at][i], mean[i], variance)),
            variance,
            rounding: match model.doubt.get(at) {
                Some(doubt) => [0, 1, 2].map(|i| last.1[i] + doubt[i]),
                None => last.1,
            },
        }
    };
    let known: Vec<Known> = (0..seen.len()).map(known).collect();
    // 1/n, which is 1 at most.
    let mut noise: f64 = 1.0;
    for _ in 0..ROUNDS {
        let (mut above, mut below) = (0.0, 0.0);
        for one in &known {
            let weight = (FREEDOM + 3.0) / (FREEDOM + one.off(noise));
            for i in 0..3 {
                let total = one.variance[i] * noise + one.rounding[i];
                let part = one.variance[i] / (total * total);
                above += part * (weight * one.difference[i] * one.difference[i] - total);
                below += part * one.variance[i];
            }
        }
        if below > 0.0 {
            noise = (noise + above / below).clamp(1e-6, 1.0);
        }
    }
    // Densities are told of the picture's own light.
    let stretch = |light: &f64| {
        let own = rounding(model.curve.seen(*light), Curve::Right);
        libm::log(own / rounding(*light, model.curve))
    };
    let mut likelihood = match model.curve {
        Curve::Right => 0.0,
        _ => -seen.iter().flatten().map(stretch).sum::<f64>(),
    };
    let mut off = vec![0.0; known.len()];
    let (mut squares, mut expected) = (0.0, 0.0);
    // Of pixels of several colours: the variances of a sample, and the squared differences beyond rounding.
    let (mut of_samples, mut beyond) = (0.0, 0.0);
    for (at, one) in known.iter().enumerate() {
        likelihood += one.density(noise);
        off[at] = one.off(noise);
        for i in 0..3 {
            let square = one.difference[i] * one.difference[i];
            squares += square;
            expected += one.variance[i] * noise + one.rounding[i];
            if one.variance[i] > 0.0 {
                of_samples += one.variance[i];
                beyond += square - one.rounding[i];
            }
        }
    }
    // What is left of less than a sample in a hundred thousand is rounding.
    let is_known = beyond > 1e-5 * of_samples;
    let samples = is_known.then(|| (of_samples / beyond).max(1.0));
    Score {
        likelihood,
        samples,
        off,
        squares,
        noise: expected.min(squares),
        share: noise,
    }
}

/// How much likelier a picture is by the means of another model than by those of a null model, of which this is the score, if errors have the variances of the
/// null model. A model with variances of its own gains by those alone where few samples happen to show one colour. An error of so many standard deviations has
/// the probability 1/(1 + deviations²) at most, whatever its distribution (Cantelli's inequality), and just that one if it has two values, as one sample has.
///
/// Pixels in which the null model has the same mean of several colours count as one: along an edge that is parallel to the pixels any sampling but a random one
/// errs by the same in all of them.
pub fn gain(seen: &[[f64; 3]], [null, other]: [&Model; 2], score: &Score) -> f64 {
    let mut mixed: HashMap<[i64; 3], (f64, f64)> = HashMap::new();
    let mut gain = 0.0;
    for (at, light) in seen.iter().enumerate() {
        let (mean, variance) = (null.moments.mean[at], null.moments.variance[at]);
        let doubt = null.doubt.get(at).copied().unwrap_or_default();
        let own = other.moments.mean[at];
        let off = |difference: [f64; 3]| -> f64 {
            let channel = |i: usize| {
                let rounding = rounding(mean[i], null.curve);
                difference[i] * difference[i]
                    / (variance[i] * score.share + rounding * rounding + doubt[i])
            };
            (0..3).map(channel).fold(0.0, f64::max)
        };
        let before = [0, 1, 2].map(|i| null.difference(light[i], mean[i], variance));
        let after = [0, 1, 2].map(|i| match other.curve {
            Curve::Right => other.difference(light[i], own[i], other.moments.variance[at]),
            curve => light[i] - curve.seen(own[i]),
        });
        if before == after || light[0].is_nan() {
            continue;
        }
        let more = libm::log1p(off(before)) - libm::log1p(off(after));
        if variance.iter().all(|one| *one < FLAT) {
            gain += more;
        } else {
            let (sum, count) = mixed
                .entry(mean.map(|light| (light / SAME).round() as i64))
                .or_default();
            (*sum, *count) = (*sum + more, *count + 1.0);
        }
    }
    gain + mixed.values().map(|(sum, count)| sum / count).sum::<f64>()
}

impl Known {
    /// The sum of the squares in standard deviations, if an error has this share of a sample's variance.
    fn off(&self, noise: f64) -> f64 {
        let channel = |i: usize| {
            self.difference[i] * self.difference[i] / (self.variance[i] * noise + self.rounding[i])
        };
        (0..3).map(channel).sum()
    }

    /// The logarithm of the density, but for a number that all have.
    fn density(&self, noise: f64) -> f64 {
        let volume: f64 = (0..3)
            .map(|i| self.variance[i] * noise + self.rounding[i])
            .product();
        -0.5 * libm::log(volume) - (FREEDOM + 3.0) / 2.0 * libm::log1p(self.off(noise) / FREEDOM)
    }
}

impl Model {
    /// The differences in light of what is seen from what is expected, of each channel of each pixel.
    pub fn differences(&self, seen: &[[f64; 3]]) -> Vec<f64> {
        let Moments { mean, variance } = &*self.moments;
        let pixels = seen.iter().zip(mean).zip(variance);
        let differences = pixels.flat_map(|((seen, mean), variance)| {
            [0, 1, 2].map(|i| self.difference(seen[i], mean[i], *variance))
        });
        differences.collect()
    }

    /// The standard deviations that these may have, as the mean of a single sample: an edge may be one pixel off.
    pub fn deviations(&self, width: usize) -> Vec<f64> {
        let variances = &self.moments.variance;
        let deviations = (0..variances.len()).flat_map(|at| {
            let [_, variance] = range(variances, width, at);
            let doubt = self.doubt.get(at).copied().unwrap_or_default();
            [0, 1, 2].map(|i| (variance[i] + doubt[i] + STEP * STEP).sqrt())
        });
        deviations.collect()
    }

    fn difference(&self, seen: f64, mean: f64, variance: [f64; 3]) -> f64 {
        if seen.is_nan() {
            return 0.0;
        }
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
        (steps - from) * rounding(mean, self.curve) * libm::sqrt(12.0)
    }
}

/// The least and the greatest in a cell and its eight neighbours, channel by channel.
fn range(values: &[[f64; 3]], width: usize, at: usize) -> [[f64; 3]; 2] {
    let (x, y) = (at % width, at / width);
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for y in y.saturating_sub(1)..(y + 2).min(values.len() / width) {
        for one in &values[y * width + x.saturating_sub(1)..y * width + (x + 2).min(width)] {
            for i in 0..3 {
                (least[i], most[i]) = (least[i].min(one[i]), most[i].max(one[i]));
            }
        }
    }
    [least, most]
}

/// How much a difference may be, in standard deviations, where that is known of what is random in it: of a million normal errors one is greater.
pub const DEVIATIONS: f64 = 5.0;

/// In steps: half of one is rounding, and half of that another way to decode.
pub const WRONG: f64 = 0.75;

impl Model {
    /// How much the light of a pixel may change if edges move by half a pixel: half of how much the pixels around it differ, or the standard deviation of a
    /// sample in one of them, which half of each of two colours make half of their difference.
    fn reach(&self, width: usize, at: usize) -> [f64; 3] {
        let [least, most] = range(&self.moments.mean, width, at);
        let [_, variance] = range(&self.moments.variance, width, at);
        [0, 1, 2].map(|i| f64::max((most[i] - least[i]) / 2.0, variance[i].sqrt()))
    }

    /// What a pixel may differ by for its rounding and for what is not known of it.
    fn allowed(&self, at: usize, i: usize) -> f64 {
        // The root of 12 standard deviations of rounding are a step.
        let step = libm::sqrt(12.0) * rounding(self.moments.mean[at][i], self.curve);
        let doubt = self.doubt.get(at).map_or(0.0, |doubt| doubt[i]);
        WRONG * step + DEVIATIONS * doubt.sqrt()
    }

    /// Whether this and another model differ by something that can be seen, where a pixel shows so many samples: in a pixel by more than edges that move by half
    /// a pixel. A few samples move them themselves: a regular grid of n by up to half of 1/√n, so that a pixel with a corner changes by up to three quarters with one.
    pub fn is_seen_beside(&self, other: &Self, width: usize, samples: f64) -> bool {
        let more = 1.0 + 0.5 / samples.sqrt();
        let shown =
            |model: &Self, at: usize| model.moments.mean[at].map(|light| model.curve.seen(light));
        (0..self.moments.mean.len()).any(|at| {
            if self.moments.mean[at] == other.moments.mean[at] && self.curve == other.curve {
                return false;
            }
            let (one, two) = (shown(self, at), shown(other, at));
            let reaches = [self, other].map(|model| model.reach(width, at));
            (0..3).any(|i| {
                let reach = f64::max(
                    more * reaches[0][i] + self.allowed(at, i),
                    more * reaches[1][i] + other.allowed(at, i),
                );
                (one[i] - two[i]).abs() > reach
            })
        })
    }
}

/// What is wrong in a picture for certain, however it was sampled.
#[derive(Debug, Default)]
pub struct Strays {
    /// The pixels of one colour that show another, by more than an edge brings into them that is half a pixel off.
    pub pixels: Vec<usize>,
    /// The pixels of several colours, their squared difference, and that which is expected of one sample in each.
    edges: Vec<(usize, f64, f64)>,
}

impl Strays {
    /// Those of a picture.
    pub fn new(seen: &[[f64; 3]], model: &Model, width: usize) -> Self {
        let variances = &model.moments.variance;
        let mut strays = Self::default();
        for at in 0..seen.len() {
            let difference = [0, 1, 2]
                .map(|i| model.difference(seen[at][i], model.moments.mean[at][i], variances[at]));
            if variances[at].iter().all(|one| *one < FLAT) {
                let beyond = |i: usize| difference[i].abs() - model.allowed(at, i);
                if (0..3).any(|i| beyond(i) > 0.0) {
                    let reach = model.reach(width, at);
                    if (0..3).any(|i| beyond(i) > reach[i]) {
                        strays.pixels.push(at);
                    }
                }
            } else {
                let square = |i: usize| {
                    let allowed = model.allowed(at, i);
                    (difference[i] * difference[i] - allowed * allowed).max(0.0)
                };
                let squares = (0..3).map(square).sum();
                let expected = variances[at].iter().sum();
                strays.edges.push((at, squares, expected));
            }
        }
        strays
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.are_empty(1, |_| Some(0)) == [true]
    }

    /// Whether there are none in each of some groups of pixels.
    pub fn are_empty(&self, groups: usize, group: impl Fn(usize) -> Option<usize>) -> Vec<bool> {
        let mut is_right = vec![true; groups];
        for group in self.pixels.iter().filter_map(|at| group(*at)) {
            is_right[group] = false;
        }
        let mut sums = vec![(0.0, 0.0); groups];
        for (at, square, variance) in &self.edges {
            if let Some(group) = group(*at) {
                let (squares, expected) = &mut sums[group];
                (*squares, *expected) = (*squares + square, *expected + variance);
            }
        }
        // Light is 1 at most, so the square of a pixel's sum over three channels is expected to be no more than three times the sum, and its variance no more
        // than that.
        let is_noise = |(squares, expected): (f64, f64)| {
            squares - expected <= DEVIATIONS * libm::sqrt(3.0 * expected)
        };
        let pairs = is_right.into_iter().zip(sums);
        pairs
            .map(|(is_right, sums)| is_right && is_noise(sums))
            .collect()
    }
}
