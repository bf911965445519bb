//! Means and variances of the light in cells of a picture.

use glam::DVec3;

use crate::{area::Area, color::Color, exact::ExactPixel, grading::hypotheses::Curve};

/// Means and variances of the light in cells of a picture. Light is linear.
#[derive(Clone, Debug, Default)]
pub struct Moments {
    /// Mean light of each cell.
    pub mean: Vec<DVec3>,
    /// Variance of one sample in each cell.
    pub variance: Vec<DVec3>,
    /// Variance of the mean itself. It is 0 unless the mean is estimated from samples or changed by
    /// JPEG coding.
    pub mean_variance: Vec<DVec3>,
}

impl Moments {
    /// Returns black cells without variance.
    pub fn zero(cells: usize) -> Self {
        Self::exact((0..cells).map(|_| Default::default()))
    }

    /// Collects the mean of each cell and the variance of one sample in it. The means are exact, so
    /// their own variances are set to 0.
    pub fn exact(pixels: impl Iterator<Item = (DVec3, DVec3)>) -> Self {
        let (mean, variance): (Vec<_>, Vec<_>) = pixels.unzip();
        let mean_variance = vec![DVec3::ZERO; mean.len()];
        Self {
            mean,
            variance,
            mean_variance,
        }
    }

    /// Replaces the means and variances of the cells in `area` by those in `own`. `self` contains
    /// the cells of `part`, row by row, and `own` contains the cells of `area`.
    pub fn put(&mut self, part: Area, area: Area, own: &Self) {
        for (from, (x, y)) in area.iter().enumerate() {
            let at = part.index(x, y);
            (self.mean[at], self.variance[at]) = (own.mean[from], own.variance[from]);
            self.mean_variance[at] = own.mean_variance[from];
        }
    }

    /// Returns the cells with these indices, in this order.
    pub fn select(&self, indices: &[usize]) -> Self {
        let select = |all: &[DVec3]| indices.iter().map(|&at| all[at]).collect();
        Self {
            mean: select(&self.mean),
            variance: select(&self.variance),
            mean_variance: select(&self.mean_variance),
        }
    }

    /// Adds `more` to the variances of the means.
    pub fn add_mean_variance(&mut self, more: &[DVec3]) {
        for (own, more) in self.mean_variance.iter_mut().zip(more) {
            *own += more;
        }
    }
}

/// Returns for each channel the least and the greatest value near the cell `at`, i.e. in all cells
/// that are at most `around` columns and rows away. A row of `values` contains `width` cells.
pub fn range(values: &[DVec3], width: usize, at: usize, around: usize) -> [DVec3; 2] {
    let (x, y) = (at % width, at / width);
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for y in y.saturating_sub(around)..(y + around + 1).min(values.len() / width) {
        let row = &values[y * width..][..width];
        for one in &row[x.saturating_sub(around)..(x + around + 1).min(width)] {
            (least, most) = (least.min(*one), most.max(*one));
        }
    }
    [least, most]
}

/// Returns a function that maps a colour to six numbers: its three channels, decoded by `decoding`,
/// and their squares. From the means of these numbers over a pixel, [`moments`] computes the mean
/// and the variance of a sample.
pub fn numbers(decoding: Curve) -> impl Fn(Color) -> [f64; 6] {
    move |color| {
        let [r, g, b] = color.to_linear().map(|light| decoding.light(light));
        [r, g, b, r * r, g * g, b * b]
    }
}

/// Returns the mean of an exact pixel and the variance of one sample in it. `pixel` contains the
/// means of the six numbers that [`numbers`] returns.
pub fn moments(pixel: &ExactPixel<6>) -> (DVec3, DVec3) {
    let [mean, square] = [0, 3].map(|at| DVec3::from_slice(&pixel.mean[at..]));
    let variance = (square - mean * mean).max(DVec3::ZERO) + pixel.bound * pixel.bound;
    (mean, variance)
}
