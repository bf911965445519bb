//! Means and variances of cells.

use glam::DVec3;

use crate::{area::Area, color::Color, exact::ExactPixel, grading::hypotheses::Curve};

/// Means and variances of cells, in linear light.
#[derive(Clone, Debug, Default)]
pub struct Moments {
    /// Mean of each cell.
    pub mean: Vec<DVec3>,
    /// Variance of one sample in each cell.
    pub variance: Vec<DVec3>,
    /// Variance of the mean itself, if it is an estimate or was coded.
    pub mean_variance: Vec<DVec3>,
}

impl Moments {
    /// Returns black cells without variance.
    pub fn zero(cells: usize) -> Self {
        Self::exact((0..cells).map(|_| Default::default()))
    }

    /// Collects means and variances of exact pixels.
    pub fn exact(pixels: impl Iterator<Item = (DVec3, DVec3)>) -> Self {
        let (mean, variance): (Vec<_>, Vec<_>) = pixels.unzip();
        let mean_variance = vec![DVec3::ZERO; mean.len()];
        Self {
            mean,
            variance,
            mean_variance,
        }
    }

    /// Replaces the moments of an area; the cells are those of `part`.
    pub fn put(&mut self, part: Area, area: Area, own: &Self) {
        for (from, (x, y)) in area.iter().enumerate() {
            let at = part.index(x, y);
            (self.mean[at], self.variance[at]) = (own.mean[from], own.variance[from]);
            self.mean_variance[at] = own.mean_variance[from];
        }
    }

    /// Selects cells by their indices.
    pub fn select(&self, indices: &[usize]) -> Self {
        let select = |all: &[DVec3]| indices.iter().map(|&at| all[at]).collect();
        Self {
            mean: select(&self.mean),
            variance: select(&self.variance),
            mean_variance: select(&self.mean_variance),
        }
    }

    /// Adds to the variances of the means.
    pub fn add_mean_variance(&mut self, more: &[DVec3]) {
        for (own, more) in self.mean_variance.iter_mut().zip(more) {
            *own += more;
        }
    }
}

/// Returns the least and the greatest value within `around` columns and rows of a cell, channel by
/// channel, in rows of `width` cells.
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

/// Returns the function of a colour whose means give mean and variance: each channel, decoded by a
/// curve, and its square.
pub fn numbers(decoding: Curve) -> impl Fn(Color) -> [f64; 6] {
    move |color| {
        let [r, g, b] = color.to_linear().map(|light| decoding.light(light));
        [r, g, b, r * r, g * g, b * b]
    }
}

/// Returns the mean and the variance of an exact pixel.
pub fn moments(pixel: &ExactPixel<6>) -> (DVec3, DVec3) {
    let [mean, square] = [0, 3].map(|at| DVec3::from_slice(&pixel.mean[at..]));
    let variance = (square - mean * mean).max(DVec3::ZERO) + pixel.bound * pixel.bound;
    (mean, variance)
}
