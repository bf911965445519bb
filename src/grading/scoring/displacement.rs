//! Tests whether the edges of a picture lie elsewhere than predicted, or whether its pixels have
//! another width.
//!
//! To first order, a displaced picture differs from the original by the displacement times the
//! picture's gradient. The displacement of an object is fitted by least squares, as an affine
//! function of the position in the picture. An affine function can describe a wrong position, size
//! or rotation of the object, or a wrong camera. If there is only sampling noise, the squared
//! length of the fitted displacement, in standard deviations, has a χ² distribution with six
//! degrees of freedom. So a large value is not chance.

use glam::DVec3;

use super::{linear_system::solve, prediction::Prediction};

/// Greatest squared length of a fitted displacement that may be chance, in squared standard
/// deviations. The displacement has six coefficients. A χ² variable with six degrees of freedom
/// exceeds 50 with a probability below 10⁻⁸.
const CHANCE: f64 = 50.0;

/// Maximum displacement of edges, in pixels, that a correct program may cause if each pixel has one
/// sample. For n samples per pixel, it is divided by n. If a correct program uses the same sample
/// positions in all pixels, their mean may differ from the pixel's middle, for example by 1/(2n)
/// for a Hammersley set. The value is greater than 1/2 because n is estimated from noise, and is
/// overestimated for such a program.
const OFF_MIDDLE: f64 = 0.75;
/// Maximum displacement of edges, in pixels, that a correct program may cause by its sample
/// positions, even with very few samples. With a larger limit, mistakes in pictures with few
/// samples would be overlooked.
const MOST_OFF_MIDDLE: f64 = 0.15;

/// Number of coefficients of an affine displacement. For each of its two components, there are a
/// constant and the slopes in x and y.
const TERMS: usize = 6;

/// Threshold of an estimated change of the pixel width, in standard deviations. A greater change is
/// not chance. Chosen by trial.
const SURE: f64 = 8.0;

/// Greatest squared pixel width, in squared pixels, that is treated as correct in a picture without
/// noise. The correct value is 1. With a smaller limit, errors of the estimate would be reported as
/// mistakes. With a larger one, slight blurs would be overlooked.
const WIDE: f64 = 1.4;
/// Amount, in squared pixels, that is added to [`WIDE`] if each pixel has one sample. For n samples
/// per pixel, it is divided by n. The few sample positions may lie too far from the pixel's middle.
/// If all pixels share them, even a correct picture is less sharp. With a smaller amount, such
/// pictures would be reported as blurred. With a larger one, blurred pictures with few samples
/// would be overlooked.
const WIDER: f64 = 3.0;
/// Amount, in squared pixels, by which the squared pixel width may be below the correct value, 1,
/// in a picture without noise. With a larger amount, pixels that are slightly too narrow would be
/// overlooked.
const NARROW: f64 = 0.25;
/// Amount, in squared pixels, that is added to [`NARROW`] if each pixel has one sample. For n
/// samples per pixel, it is divided by n. The few sample positions may lie too close to the pixel's
/// middle. If all pixels share them, even a correct picture is too sharp. With a smaller amount,
/// such pictures would be reported as wrong. With a larger one, narrow pixels in pictures with few
/// samples would be overlooked.
const NARROWER: f64 = 5.0;

/// Greatest squared pixel width, in squared pixels, that is treated as correct in a JPEG. JPEG
/// coding makes edges less sharp, so the limit is large. By measurement, 80 correct JPEGs with
/// qualities from 75 to 100 have widths of at most 4.7, and a picture whose pixels are three times
/// too wide has 7.
const WIDE_IN_CODED: f64 = 5.5;

/// Least pixel width that is reported, in pixels. Smaller estimates, which may be 0, are raised to
/// this value.
const LEAST_WIDTH: f64 = 0.1;
/// Greatest pixel width that is reported, in pixels. Larger estimates are lowered to this value.
/// The estimate is a second-order approximation, so it is inexact for wide pixels.
const MOST_WIDTH: f64 = 6.0;

/// A displacement of edges that is too large to be chance.
#[derive(Clone, Copy, Debug)]
pub struct Displacement {
    /// Root mean square of the displacement perpendicular to the edges, in pixels.
    pub length: f64,
    /// Displacement at the middle of the fitted group of pixels, to the right and down, in pixels.
    pub by: [f64; 2],
    /// Squared length of the fitted displacement, in squared standard deviations. The greater it
    /// is, the less likely it is chance.
    pub square: f64,
}

/// A symmetric matrix. Only the entries on the diagonal and to the left of it are stored and used.
type Symmetric = [[f64; TERMS]; TERMS];

/// Normal equations by which a displacement is fitted to a group of pixels, by least squares.
#[derive(Clone, Default)]
struct NormalEquations {
    normal: Symmetric,
    variance: Symmetric,
    right_side: [f64; TERMS],
}

impl NormalEquations {
    /// Adds an equation to the fit, for one channel of a pixel. The six unknown coefficients, each
    /// multiplied by its factor in `row`, should add up to `difference`, which has the variance
    /// `variance`. `weight` is the weight of the equation.
    fn add(&mut self, row: &[f64; TERMS], difference: f64, weight: f64, variance: f64) {
        for (j, one) in row.iter().enumerate() {
            let weighted = weight * one;
            self.right_side[j] += weighted * difference;
            for (k, other) in row[..=j].iter().enumerate() {
                let product = weighted * other;
                self.normal[j][k] += product;
                self.variance[j][k] += weight * variance * product;
            }
        }
    }

    /// Solves for the displacement, which is an affine function of the position in the picture.
    /// Returns `None` if it may be chance. A correct program with few samples may displace all
    /// edges by up to `off_middle` pixels in each direction, so this distance is subtracted before
    /// the length of the displacement is computed. `noise` is the real variance of the errors
    /// divided by the assumed one.
    fn displacement(&self, off_middle: f64, noise: f64) -> Option<Displacement> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let full = |matrix: &Symmetric| -> Vec<Vec<f64>> {
            let row = |i: usize| (0..TERMS).map(move |j| matrix[i.max(j)][i.min(j)]);
            (0..TERMS).map(|i| row(i).collect()).collect()
        };
        // A small number is added to the diagonal. So a coefficient that no edge determines becomes
        // 0.
        let solved = |mut matrix: Vec<Vec<f64>>| {
            let most = (0..TERMS).map(|i| matrix[i][i]).fold(0.0, f64::max);
            (0..TERMS).for_each(|i| matrix[i][i] += 1e-3 * most + 1e-30);
            solve(matrix, self.right_side.to_vec())
        };
        let square = dot(&self.right_side, &solved(full(&self.variance))?);
        let normal = full(&self.normal);
        let mut fitted = solved(normal.clone())?;
        let by = [fitted[0], fitted[3]];
        for at in [0, 3] {
            fitted[at] -= fitted[at].clamp(-off_middle, off_middle);
        }
        let product = fitted.iter().zip(&normal);
        let product: f64 = product.map(|(x, row)| x * dot(&fitted, row)).sum();
        // A displacement along an edge is invisible, so `length` is the root mean square of the
        // part perpendicular to the edges, i.e. along the gradient.
        let length = (product / (normal[0][0] + normal[3][3])).sqrt();
        (square > CHANCE * noise).then_some(Displacement { length, by, square })
    }
}

impl Prediction<'_> {
    /// Returns whether the errors in pixels that mix several colours look like sampling noise. If
    /// most of these pixels are exact, the picture has no noise. Large errors in the other pixels
    /// then have another cause.
    pub fn is_noise_everywhere(&self) -> bool {
        /// Greatest squared error of a pixel that counts as exact, divided by the variance of one
        /// sample. The value is the mean squared error with 10 000 samples per pixel.
        const EXACT: f64 = 1e-4;
        /// Squared error, divided by the variance of one sample, above which a pixel is wrong if
        /// most pixels are exact. The value is the mean squared error with two samples per pixel,
        /// far above that of exact pixels.
        const OTHER: f64 = 0.5;
        /// Minimum number of wrong pixels at which a picture is wrong, if most of its pixels are
        /// exact. With a smaller number, a few odd pixels would make a picture wrong.
        const CHANCE: usize = 4;
        /// Variance of one sample in a pixel, in squared linear light, below which the pixel is not
        /// tested. In such a pixel, errors come mostly from rounding to bytes.
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
        // The picture is treated as exact if three quarters of the tested pixels are exact.
        let is_exact = shares
            .get(shares.len() * 3 / 4)
            .is_some_and(|most| *most < EXACT);
        let others = shares.iter().rev().take_while(|share| **share > OTHER);
        !is_exact || others.count() < CHANCE
    }

    /// Returns the sum of the squared differences divided by the sum of the variances of one
    /// sample, both over the pixels that mix several colours. With n independent samples per pixel,
    /// the ratio is about 1/n. It is at most 1.
    pub fn relative_variance(&self) -> f64 {
        let (mut squares, mut variances) = (0.0, 0.0);
        for at in (0..self.observed.len()).filter(|&at| !self.is_flat(at)) {
            squares += self.difference(at).length_squared();
            variances += self.moments.variance[at].element_sum();
        }
        f64::min(squares / f64::max(variances, 1e-12), 1.0)
    }

    /// Estimates the width of the pixel filter, in pixels. Returns `None` if it may be 1.
    /// `deviations` contains, for each channel of each pixel, the standard deviation of one sample.
    /// `relative_variance` is the variance of a pixel's error divided by that of one sample, i.e.
    /// 1/n for n samples per pixel. `is_coded` says whether the picture is a JPEG.
    ///
    /// The estimate is of second order: the mean light over a square of the width w differs from
    /// the mean over a correct pixel, of the width 1, by (w² − 1)/24 times the Laplacian of the
    /// picture.
    pub fn pixel_width(
        &self,
        deviations: &[f64],
        relative_variance: f64,
        is_coded: bool,
    ) -> Option<f64> {
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
                variance += (weighted * weighted).dot(self.error(at, relative_variance));
            }
        }
        let square = 1.0 + 24.0 * seen / all.max(1e-300);
        let is_sure = seen.abs() > SURE * variance.sqrt();
        let is_other = if is_coded {
            square > WIDE_IN_CODED
        } else {
            let is_narrow = square < 1.0 - NARROW - NARROWER * relative_variance;
            is_narrow || square > WIDE + WIDER * relative_variance
        };
        (is_sure && is_other).then(|| square.max(0.0).sqrt().clamp(LEAST_WIDTH, MOST_WIDTH))
    }

    /// Returns the displacement of each group of pixels, for example of the pixels that show one
    /// object. The result is `None` for a displacement that may be chance. `groups` contains the
    /// index of each pixel's group. `relative_variance` is the variance of a pixel's error divided
    /// by the variance of one sample, i.e. 1/n for n samples per pixel. `is_coded` says whether the
    /// picture is a JPEG.
    pub fn displacements(
        &self,
        deviations: &[f64],
        relative_variance: f64,
        groups: &[usize],
        is_coded: bool,
    ) -> Vec<Option<Displacement>> {
        let off_middle = (OFF_MIDDLE * relative_variance).min(MOST_OFF_MIDDLE);
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
        let mut sums = vec![NormalEquations::default(); all];
        let (mut observed, mut expected) = (0.0, 0.0);
        for (at, group) in groups.iter().enumerate() {
            let (x, y) = (at % width, at / width);
            let is_inside = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
            if !is_inside || self.observed[at].x.is_nan() {
                continue;
            }
            let gradient = |by: usize| (mean[at + by] - mean[at - by]) / 2.0;
            let [right, down] = [gradient(1), gradient(width)];
            if right == DVec3::ZERO && down == DVec3::ZERO {
                continue;
            }
            let (difference, error) = (self.difference(at), self.error(at, relative_variance));
            let [x0, x1, y0, y1] = boxes[*group];
            let reach = ((x1 - x0).max(y1 - y0) / 2.0).max(1.0);
            let [x, y] = place(at);
            let (x, y) = ((x - (x0 + x1) / 2.0) / reach, (y - (y0 + y1) / 2.0) / reach);
            for i in 0..3 {
                let (right, down) = (right[i], down[i]);
                let row = [right, right * x, right * y, down, down * x, down * y];
                let deviation = deviations[3 * at + i];
                let weight = 1.0 / (deviation * deviation);
                sums[*group].add(&row, difference[i], weight, error[i]);
                let weight = weight * (right * right + down * down);
                observed += weight * difference[i] * difference[i];
                expected += weight * error[i];
            }
        }
        // The errors that JPEG coding is expected to cause may be too large in the whole picture.
        // If so, they are scaled down by the ratio of the observed to the expected errors.
        let noise = if is_coded {
            f64::min(observed / f64::max(expected, 1e-300), 1.0)
        } else {
            1.0
        };
        sums.iter()
            .map(|sums| sums.displacement(off_middle, noise))
            .collect()
    }
}
