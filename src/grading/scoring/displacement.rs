//! Tests whether edges of a picture are displaced against a prediction, or whether its pixels have
//! another width.
//!
//! To first order, a displaced picture differs from the original by its gradient times the
//! displacement. The displacement of an object is fitted by least squares, as an affine function of
//! the place in the picture; this covers a wrong place, size, turn or camera. If there is only
//! sampling noise, the squared length of the fitted displacement, in standard deviations, has a χ²
//! distribution with six degrees of freedom. So a large value is not chance.

use glam::DVec3;

use super::{linear_system::solve, prediction::Prediction};

/// Greatest squared length of a fitted displacement that counts as chance, in squared standard
/// deviations. A χ² variable with six degrees of freedom exceeds 50 with a probability below 10⁻⁸.
const CHANCE: f64 = 50.0;

/// Displacement that one sample per pixel may seem to cause, in pixels. With n samples it is an nth
/// of this. Samples at the same places in all pixels may lie off the pixels' middles together;
/// those of a Hammersley set do by 1/(2n). The value is greater than 1/2 because n is estimated
/// from the noise, and the estimate is too large for such samples.
const OFF_MIDDLE: f64 = 0.75;
/// Maximum displacement that is attributed to few samples per pixel, in pixels. A larger one counts
/// as a mistake, however few the samples are. The value is a choice.
const MOST_OFF_MIDDLE: f64 = 0.15;

/// Number of coefficients of an affine displacement: a constant and the slopes in x and y, for each
/// of the two directions.
const TERMS: usize = 6;

/// Number of standard deviations from 0 beyond which an estimated change of the pixel width is not
/// chance. Chosen by trial.
const SURE: f64 = 8.0;

/// Greatest squared width of a pixel, in squared pixels, that counts as correct in a picture
/// without noise. The correct value is 1; the margin is a choice.
const WIDE: f64 = 1.4;
/// Addition to the greatest squared pixel width that counts as correct ([`WIDE`]), for one sample
/// per pixel, in squared pixels. For n samples per pixel, an nth of it is added. Few samples at the
/// same places in all pixels make a correct picture less sharp. The value is a choice.
const WIDER: f64 = 3.0;
/// Difference from 1 by which a squared pixel width may be too small and still count as correct in
/// a picture without noise, in squared pixels. The value is a choice.
const NARROW: f64 = 0.25;
/// Addition to the amount by which a squared pixel width may be too small ([`NARROW`]), for one
/// sample per pixel, in squared pixels. For n samples per pixel, an nth of it is added. Few samples
/// make a correct picture sharper. The value is a choice.
const NARROWER: f64 = 5.0;

/// Greatest squared width of a pixel, in squared pixels, that counts as correct in a JPEG, whose
/// coding makes edges less sharp. It was measured: 80 correct JPEGs with qualities from 75 to 100
/// have at most 4.7, and a picture whose pixels are three times too wide has 7.
const WIDE_IN_CODED: f64 = 5.5;

/// Least pixel width that is reported, in pixels. A smaller estimate, which may be 0, is raised to
/// it.
const LEAST_WIDTH: f64 = 0.1;
/// Greatest pixel width that is reported, in pixels. A larger estimate is lowered to it. The value
/// is a choice.
const MOST_WIDTH: f64 = 6.0;

/// A displacement of edges that is too large to be chance.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    /// Root mean square of the displacement perpendicular to the edges, in pixels.
    pub length: f64,
    /// Displacement in the middle of the group of pixels, in pixels to the right and down.
    pub by: [f64; 2],
    /// Squared length of the fitted displacement, in squared standard deviations.
    pub square: f64,
}

/// Normal equations of the least-squares fit of a displacement to a group of pixels.
#[derive(Clone)]
struct NormalEquations {
    normal: Vec<Vec<f64>>,
    variance: Vec<Vec<f64>>,
    right_side: Vec<f64>,
}

impl NormalEquations {
    /// Solves for the displacement. `off_middle` is subtracted: the displacement, in pixels, that
    /// few samples may cause. Returns `None` if the displacement may be chance.
    fn displacement(&self, off_middle: f64) -> Option<Displacement> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        // Adds a small diagonal, so that a coefficient that no edge determines becomes 0.
        let solved = |matrix: &[Vec<f64>]| {
            let mut matrix = matrix.to_vec();
            let most = (0..TERMS).map(|i| matrix[i][i]).fold(0.0, f64::max);
            (0..TERMS).for_each(|i| matrix[i][i] += 1e-3 * most + 1e-30);
            solve(matrix, self.right_side.clone())
        };
        let square = dot(&self.right_side, &solved(&self.variance)?);
        let mut fitted = solved(&self.normal)?;
        let by = [fitted[0], fitted[3]];
        for at in [0, 3] {
            fitted[at] -= fitted[at].clamp(-off_middle, off_middle);
        }
        let product = fitted.iter().zip(&self.normal);
        let product: f64 = product.map(|(x, row)| x * dot(&fitted, row)).sum();
        // Only the part of a displacement along the gradient is visible.
        let length = (product / (self.normal[0][0] + self.normal[3][3])).sqrt();
        (square > CHANCE).then_some(Displacement { length, by, square })
    }
}

impl Prediction<'_> {
    /// Returns whether the errors in pixels that mix several colours look like sampling noise. If
    /// most of these pixels are exact, there is no noise, so large errors in the others have
    /// another cause.
    pub fn is_noise_everywhere(&self) -> bool {
        /// Greatest squared error of a pixel that counts as exact, relative to the variance of one
        /// sample. The value corresponds to 10 000 samples per pixel; it is a choice.
        const EXACT: f64 = 1e-4;
        /// Squared error, relative to the variance of one sample, above which a pixel counts as
        /// wrong if most pixels are exact. The value is a choice.
        const OTHER: f64 = 0.5;
        /// Number of wrong pixels among exact ones that is too large to be chance. The value is a
        /// choice.
        const CHANCE: usize = 4;
        /// Variance of one sample in a pixel, in squared linear light, below which the pixel is not
        /// tested. Rounding to bytes would dominate its error.
        const LEAST: f64 = 1e-3;
        let share = |at: usize| {
            let variance = self.moments.variance[at].element_sum();
            let is_known = self.moments.mean_variance[at] == DVec3::ZERO;
            let is_tested = variance > LEAST && is_known && !self.observed[at].x.is_nan();
            let (difference, rounding) = (self.difference(at), self.error(at, 0.0));
            let beyond = difference * difference - rounding;
            is_tested.then(|| beyond.element_sum() / variance)
        };
        let mut shares: Vec<f64> = (0..self.observed.len()).filter_map(share).collect();
        shares.sort_by(f64::total_cmp);
        // The picture counts as exact if three quarters of the pixels are.
        let is_exact = shares
            .get(shares.len() * 3 / 4)
            .is_some_and(|most| *most < EXACT);
        let others = shares.iter().rev().take_while(|share| **share > OTHER);
        !is_exact || others.count() < CHANCE
    }

    /// Returns the squared differences in pixels that mix several colours, relative to the variance
    /// of one sample in each. For n independent samples per pixel this is about 1/n.
    pub fn share(&self) -> f64 {
        let (mut squares, mut variances) = (0.0, 0.0);
        for at in (0..self.observed.len()).filter(|&at| !self.is_flat(at)) {
            squares += self.difference(at).length_squared();
            variances += self.moments.variance[at].element_sum();
        }
        f64::min(squares / f64::max(variances, 1e-12), 1.0)
    }

    /// Estimates the width of the pixel filter, in pixels. Returns `None` if it may be 1. `share`
    /// is the variance of a pixel's error relative to that of one sample: 1/n for n samples per
    /// pixel.
    ///
    /// To second order, the mean over a square of the width w differs from the mean over a pixel by
    /// (w² − 1)/24 times the Laplacian of the picture.
    pub fn pixel_width(&self, deviations: &[f64], share: f64, is_coded: bool) -> Option<f64> {
        let (width, height) = (self.width, self.observed.len() / self.width);
        let mean = &self.moments.mean;
        let (mut seen, mut all, mut variance) = (0.0, 0.0, 0.0);
        for y in 1..height.max(2) - 1 {
            for at in y * width + 1..(y + 1) * width - 1 {
                let around = [at - 1, at + 1, at - width, at + width];
                let is_empty = |at: &usize| self.observed[*at].x.is_nan();
                if around.iter().chain([&at]).any(is_empty) {
                    continue;
                }
                let neighbours: DVec3 = around.iter().map(|&near| mean[near]).sum();
                let laplacian = neighbours - 4.0 * mean[at];
                if laplacian == DVec3::ZERO {
                    continue;
                }
                let deviation = DVec3::from_slice(&deviations[3 * at..]);
                let weighted = laplacian / (deviation * deviation);
                seen += weighted.dot(self.difference(at));
                all += weighted.dot(laplacian);
                variance += (weighted * weighted).dot(self.error(at, share));
            }
        }
        let square = 1.0 + 24.0 * seen / all.max(1e-300);
        let is_sure = seen.abs() > SURE * variance.sqrt();
        let is_other = if is_coded {
            square > WIDE_IN_CODED
        } else {
            let is_narrow = square < 1.0 - NARROW - NARROWER * share;
            is_narrow || square > WIDE + WIDER * share
        };
        (is_sure && is_other).then(|| square.max(0.0).sqrt().clamp(LEAST_WIDTH, MOST_WIDTH))
    }

    /// Returns the displacement of each group of pixels, or `None` if it may be chance. `groups`
    /// has the group of each pixel. `share` is the variance of a pixel's error relative to that of
    /// one sample: 1/n for n samples per pixel.
    pub fn displacements(
        &self,
        deviations: &[f64],
        share: f64,
        groups: &[usize],
    ) -> Vec<Option<Displacement>> {
        let off_middle = (OFF_MIDDLE * share).min(MOST_OFF_MIDDLE);
        let (width, count) = (self.width, self.observed.len());
        let height = count / width;
        let mean = &self.moments.mean;
        let all = groups.iter().max().map_or(0, |most| most + 1);
        // Bounding box of each group: its least and greatest column, and its least and greatest
        // row.
        let mut boxes = vec![[f64::INFINITY, -f64::INFINITY, f64::INFINITY, -f64::INFINITY]; all];
        let place = |at: usize| [(at % width) as f64, (at / width) as f64];
        for (at, group) in groups.iter().enumerate() {
            let ([x, y], own) = (place(at), &mut boxes[*group]);
            *own = [own[0].min(x), own[1].max(x), own[2].min(y), own[3].max(y)];
        }
        let empty = NormalEquations {
            normal: vec![vec![0.0; TERMS]; TERMS],
            variance: vec![vec![0.0; TERMS]; TERMS],
            right_side: vec![0.0; TERMS],
        };
        let mut sums = vec![empty; all];
        for (at, group) in groups.iter().enumerate() {
            let (x, y) = (at % width, at / width);
            let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            if !is_inside || self.observed[at].x.is_nan() {
                continue;
            }
            let difference = self.difference(at);
            let error = self.error(at, share);
            let [x0, x1, y0, y1] = boxes[*group];
            let reach = ((x1 - x0).max(y1 - y0) / 2.0).max(1.0);
            let [x, y] = place(at);
            let (x, y) = ((x - (x0 + x1) / 2.0) / reach, (y - (y0 + y1) / 2.0) / reach);
            for i in 0..3 {
                let right = (mean[at + 1][i] - mean[at - 1][i]) / 2.0;
                let down = (mean[at + width][i] - mean[at - width][i]) / 2.0;
                if right == 0.0 && down == 0.0 {
                    continue;
                }
                let row = [right, right * x, right * y, down, down * x, down * y];
                let deviation = deviations[3 * at + i];
                let weight = 1.0 / (deviation * deviation);
                let own = &mut sums[*group];
                for j in 0..TERMS {
                    own.right_side[j] += weight * row[j] * difference[i];
                    for k in 0..TERMS {
                        let product = weight * row[j] * row[k];
                        own.normal[j][k] += product;
                        own.variance[j][k] += weight * product * error[i];
                    }
                }
            }
        }
        sums.iter()
            .map(|sums| sums.displacement(off_middle))
            .collect()
    }
}
