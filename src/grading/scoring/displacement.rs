//! Tests whether a picture is displaced against a prediction, or seen through pixels of another
//! width.
//!
//! To first order, a displaced picture differs by its gradient times the displacement. An affine
//! field of displacements, as a wrong place, size, turn or camera causes it, is fitted to the
//! pixels of each object by least squares. Sampling noise has no such field: the sums of the fit
//! have known variances, so the squared length in these units, which has six degrees of freedom, is
//! bounded for noise.

use glam::DVec3;

use super::{linear_system::solve, prediction::Prediction};

/// Greatest squared length that is taken for chance: 1 in 10^8 of normal sums exceeds this bound.
const CHANCE: f64 = 50.0;

/// Displacement that few samples at the same places in all pixels cause, in pixels, per share of a
/// sample's variance in an error. The mean of the n points (i/n, φ₂(i)) lies 1/(2n) off the middle,
/// and these points make less noise than as many random ones.
const OFF_MIDDLE: f64 = 0.75;
/// Greatest displacement, in pixels, that is attributed to the places of few samples.
const MOST_OFF_MIDDLE: f64 = 0.15;

/// Number of coefficients of an affine field of displacements.
const TERMS: usize = 6;

/// Standard deviations beyond which another width of pixels is not chance. Chosen by trial.
const SURE: f64 = 8.0;

/// Greatest squared width that is taken for a pixel's own, without noise.
const WIDE: f64 = 1.4;
/// Addition to `WIDE` per share of a sample's variance in an error: few samples at the same places
/// in all pixels make a picture less sharp.
const WIDER: f64 = 3.0;
/// Amount below 1 of a squared width that is taken for a pixel's own, without noise.
const NARROW: f64 = 0.25;
/// Addition to `NARROW` per share of a sample's variance in an error: few samples make a picture
/// sharper.
const NARROWER: f64 = 5.0;

/// Greatest squared width that is taken for a pixel's own in a JPEG, whose coding makes edges less
/// sharp: 80 correct ones of qualities from 75 to 100 have at most 4.7, and one seen through pixels
/// three times as wide has 7.
const WIDE_IN_CODED: f64 = 5.5;

/// Least width that is reported, in pixels.
const LEAST_WIDTH: f64 = 0.1;
/// Greatest width that is reported, in pixels.
const MOST_WIDTH: f64 = 6.0;

/// A displacement that is not chance.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    /// Root mean square of the displacement along the gradient, in pixels.
    pub length: f64,
    /// Displacement of the group's middle, in pixels to the right and down.
    pub by: [f64; 2],
    /// Squared length of the sums in units of their standard deviations.
    pub square: f64,
}

/// Normal equations of the displacement of a group of pixels.
#[derive(Clone)]
struct NormalEquations {
    normal: Vec<Vec<f64>>,
    variance: Vec<Vec<f64>>,
    right_side: Vec<f64>,
}

impl NormalEquations {
    /// Solves for the displacement, less what few samples cause. Returns `None` if it may be
    /// chance.
    fn displacement(&self, off_middle: f64) -> Option<Displacement> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        // A small diagonal: components that no edge determines become 0.
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
        // Along the gradient.
        let length = (product / (self.normal[0][0] + self.normal[3][3])).sqrt();
        (square > CHANCE).then_some(Displacement { length, by, square })
    }
}

impl Prediction<'_> {
    /// Returns whether the errors in pixels of several colours look like sampling noise. If most of
    /// them are exact, there is no noise, and inexact pixels show something else.
    pub fn is_noise_everywhere(&self) -> bool {
        /// Greatest share of a sample's variance in an error of an exact picture.
        const EXACT: f64 = 1e-4;
        /// Least share of a sample's variance in an error where something else is seen.
        const OTHER: f64 = 0.5;
        /// Number of such pixels that is not chance.
        const CHANCE: usize = 4;
        /// Variance above which rounding is negligible.
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
        // Three quarters of the pixels are exact.
        let is_exact = shares
            .get(shares.len() * 3 / 4)
            .is_some_and(|most| *most < EXACT);
        let others = shares.iter().rev().take_while(|share| **share > OTHER);
        !is_exact || others.count() < CHANCE
    }

    /// Returns the share of a sample's variance that the squared differences are, over the pixels
    /// of several colours.
    pub fn share(&self) -> f64 {
        let (mut squares, mut variances) = (0.0, 0.0);
        for at in (0..self.observed.len()).filter(|&at| !self.is_flat(at)) {
            squares += self.difference(at).length_squared();
            variances += self.moments.variance[at].element_sum();
        }
        f64::min(squares / f64::max(variances, 1e-12), 1.0)
    }

    /// Estimates the width of the pixel filter, in pixels. Returns `None` if it may be 1, given the
    /// share of a sample's variance in an error.
    ///
    /// To second order, a mean over a square of the width w differs from one over a pixel by (w² −
    /// 1)/24 times the Laplacian.
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

    /// Returns the displacement of each group of pixels, or `None` where it may be chance, given
    /// the share of a sample's variance in an error.
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
        // The bounding box of each group.
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
