//! Means and variances of what pixels show.

use glam::DVec3;

use super::light::Curve;
use crate::{area::Area, color::Color, exact::ExactPixel};

/// What cells show.
#[derive(Clone, Debug, Default)]
pub struct Moments {
    /// The mean of each, in linear light.
    pub mean: Vec<DVec3>,
    /// The variance of one sample in it.
    pub variance: Vec<DVec3>,
    /// The variance of that mean itself: how far off it may be.
    pub doubt: Vec<DVec3>,
}

impl Moments {
    /// None yet of so many cells.
    pub fn zero(cells: usize) -> Self {
        Self::exact((0..cells).map(|_| Default::default()))
    }

    /// Those of exact pixels.
    pub fn exact(pixels: impl Iterator<Item = (DVec3, DVec3)>) -> Self {
        let (mean, variance): (Vec<_>, Vec<_>) = pixels.unzip();
        let doubt = vec![DVec3::ZERO; mean.len()];
        Self {
            mean,
            variance,
            doubt,
        }
    }

    /// Replaces those of an area of a part, whose cells these are.
    pub fn put(&mut self, part: Area, area: Area, own: &Self) {
        for (from, (x, y)) in area.iter().enumerate() {
            let at = part.index(x, y);
            (self.mean[at], self.variance[at]) = (own.mean[from], own.variance[from]);
            self.doubt[at] = own.doubt[from];
        }
    }

    /// The same of the cells of these indices.
    pub fn select(&self, indices: &[usize]) -> Self {
        let select = |all: &[DVec3]| indices.iter().map(|&at| all[at]).collect();
        Self {
            mean: select(&self.mean),
            variance: select(&self.variance),
            doubt: select(&self.doubt),
        }
    }

    /// Makes the means less certain.
    pub fn add_doubt(&mut self, more: &[DVec3]) {
        self.doubt
            .iter_mut()
            .zip(more)
            .for_each(|(doubt, more)| *doubt += more);
    }
}

/// The least and the greatest of a cell and those so far around it, channel by channel, in rows of
/// a width.
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

/// The numbers of a colour whose means tell the mean and the variance of what is averaged: each
/// channel, decoded by a curve, and its square.
pub fn numbers(averaged: Curve) -> impl Fn(Color) -> [f64; 6] {
    move |color| {
        let [r, g, b] = color.to_linear().map(|light| averaged.light(light));
        [r, g, b, r * r, g * g, b * b]
    }
}

/// The mean and the variance of an exact pixel.
pub fn moments(pixel: &ExactPixel<6>) -> (DVec3, DVec3) {
    let [mean, square] = [0, 3].map(|at| DVec3::from_slice(&pixel.mean[at..]));
    let variance = (square - mean * mean).max(DVec3::ZERO) + pixel.bound * pixel.bound;
    (mean, variance)
}
