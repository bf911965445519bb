//! Finds errors in a picture that sampling cannot explain.

use glam::DVec3;

use super::{moments::range, prediction::Prediction};

/// Greatest error that counts as random, in standard deviations. Less than one in a million
/// normally distributed errors is greater.
pub const DEVIATIONS: f64 = 5.0;

/// Greatest difference, in 8-bit steps, that is ignored in a pixel that should show one colour.
/// Rounding causes differences of up to half a step. Another quarter of a step is allowed, because
/// programs decode colours in slightly different ways.
pub const WRONG: f64 = 0.75;

/// Number of pixels in a block of a JPEG. Coding errors of these pixels depend on each other, so
/// they are counted as one independent error instead of 64.
const PIXELS_PER_BLOCK: f64 = 64.0;

/// Errors that a hypothesis about the program leaves in a picture, and that sampling cannot
/// explain.
#[derive(Debug, Default)]
pub struct UnexplainedErrors {
    /// Indices of the pixels that should show one colour, but show a different one. Pixels are not
    /// included if an edge that is displaced by half a pixel can explain the difference.
    pub pixels: Vec<usize>,
    /// Sum of the squared differences of the pixels in `pixels`.
    square: f64,
    /// Pixels that should mix several colours. An entry contains three values. The first is the
    /// pixel's index. The second is the part of its squared error that rounding and the variance of
    /// the predicted mean cannot explain. The third is the expected variance of one sample.
    edges: Vec<(usize, f64, f64)>,
}

impl UnexplainedErrors {
    /// Returns the sum of the squared differences that sampling cannot explain. A pixel that should
    /// show one colour contributes its whole squared difference. A pixel that mixes several colours
    /// contributes its squared difference minus the variance of one sample.
    pub fn square(&self) -> f64 {
        let beyond = |(_, square, variance): &(usize, f64, f64)| square - variance;
        let beyond: f64 = self.edges.iter().map(beyond).sum();
        self.square + beyond.max(0.0)
    }

    /// Returns whether sampling may explain all errors, except for `missed` pixels: at most
    /// `missed` of the pixels that should show one colour are wrong, and the errors of pixels that
    /// mix several colours may be noise.
    pub fn are_no_more(&self, missed: usize) -> bool {
        let sum = |(squares, expected), edge: &(_, f64, f64)| (squares + edge.1, expected + edge.2);
        self.pixels.len() <= missed && is_noise(self.edges.iter().fold((0.0, 0.0), sum))
    }

    /// Returns for each group of pixels whether sampling may explain its errors. `group` returns
    /// the group of a pixel, or `None` if the pixel is ignored.
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
        let pairs = is_right.into_iter().zip(sums);
        pairs.map(|(is, sums)| is && is_noise(sums)).collect()
    }
}

/// Returns whether sampling may explain a sum of squared errors. `expected` is the mean of this sum
/// if the errors come from sampling.
fn is_noise((squares, expected): (f64, f64)) -> bool {
    // Light is at most 1, so the squared error of a pixel, summed over three channels, is at most
    // 3. Therefore the variance of the squared error is at most three times its expected value.
    squares - expected <= DEVIATIONS * libm::sqrt(3.0 * expected)
}

impl Prediction<'_> {
    /// Finds the errors of the picture that sampling cannot explain.
    pub fn unexplained_errors(&self) -> UnexplainedErrors {
        let mut unexplained_errors = UnexplainedErrors::default();
        for at in 0..self.observed.len() {
            let (difference, allowed) = (self.difference(at), self.allowed(at));
            let squares = difference * difference;
            if self.is_flat(at) {
                let beyond = difference.abs() - allowed;
                if beyond.max_element() > 0.0 && beyond.cmpgt(self.reach(at)).any() {
                    unexplained_errors.pixels.push(at);
                    unexplained_errors.square += squares.element_sum();
                }
            } else {
                let beyond = (squares - allowed * allowed).max(DVec3::ZERO);
                let expected = self.moments.variance[at].element_sum();
                unexplained_errors
                    .edges
                    .push((at, beyond.element_sum(), expected));
            }
        }
        unexplained_errors
    }

    /// Returns whether the pixels of some group in a JPEG are too bright or too dark on average.
    /// JPEG coding may change single pixels a lot, but it hardly changes their mean. Only pixels
    /// that should show one colour are compared. `groups` contains the index of each pixel's group.
    pub fn is_tinted(&self, groups: &[usize]) -> bool {
        let all = groups.iter().max().map_or(0, |most| most + 1);
        // For each group, the sum of the differences divided by their variances, and the sum of the
        // reciprocal variances.
        let mut sums = vec![[DVec3::ZERO; 2]; all];
        for (at, group) in groups.iter().enumerate() {
            if self.is_flat(at) && !self.observed[at].x.is_nan() {
                let weight = self.error(at, 0.0).recip();
                let [differences, weights] = &mut sums[*group];
                *differences += weight * self.difference(at);
                *weights += weight;
            }
        }
        let is_beyond = |[differences, weights]: &[DVec3; 2]| {
            let deviations = (PIXELS_PER_BLOCK * *weights).map(f64::sqrt);
            differences.abs().cmpgt(DEVIATIONS * deviations).any()
        };
        sums.iter().any(is_beyond)
    }

    /// Returns for each channel how much the light of a pixel may change if edges move by half a
    /// pixel. An edge that moves this far into the pixel changes it by half the difference of the
    /// colours on its two sides. So the result is half the range of the means of the pixel and its
    /// neighbours. If the greatest standard deviation of one sample in these pixels is greater, it
    /// is returned instead.
    fn reach(&self, at: usize) -> DVec3 {
        let [least, most] = range(&self.moments.mean, self.width, at, 1);
        let [_, variance] = range(&self.moments.variance, self.width, at, 1);
        ((most - least) / 2.0).max(variance.map(f64::sqrt))
    }

    /// Returns for each channel the greatest difference of a pixel that rounding and the variance
    /// of the predicted mean can explain.
    fn allowed(&self, at: usize) -> DVec3 {
        WRONG * self.steps(at) + DEVIATIONS * self.moments.mean_variance[at].map(f64::sqrt)
    }
}
