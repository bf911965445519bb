//! What a program may do to light: average something else, encode it otherwise, mix its channels.

use crate::{
    color::{Color, linear_to_srgb, srgb_to_linear},
    exact::ExactPixel,
};

/// A step of 8-bit sRGB. Nobody sees less, so no file is taken for finer.
pub const STEP: f64 = 1.0 / 255.0;

/// What is averaged in place of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Average {
    /// Light, as it should be.
    Light,
    /// sRGB numbers.
    Encoded,
    /// The power 2.2 of sRGB numbers.
    Power22,
}

impl Average {
    /// Of light.
    pub fn of(self, light: f64) -> f64 {
        match self {
            Self::Light => light,
            Self::Encoded => linear_to_srgb(light),
            Self::Power22 => libm::pow(linear_to_srgb(light), 2.2),
        }
    }
}

/// How light is encoded, told by what light is seen in its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// As it should be: itself.
    Right,
    /// Not at all, so that it is decoded.
    Missing,
    /// Twice, so that it is encoded.
    Twice,
    /// By the power 1/2.2.
    Power22,
    /// By a square root.
    Root,
}

impl Curve {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Right,
        Self::Missing,
        Self::Twice,
        Self::Power22,
        Self::Root,
    ];

    /// The light that was encoded, where other light is seen.
    pub fn light(self, seen: f64) -> f64 {
        // A file of floats may have negative ones, of which there are no powers.
        let seen = if self != Self::Right && seen < 0.0 {
            0.0
        } else {
            seen
        };
        match self {
            Self::Right => seen,
            Self::Missing => linear_to_srgb(seen),
            Self::Twice => srgb_to_linear(seen),
            Self::Power22 => libm::pow(linear_to_srgb(seen), 2.2),
            Self::Root => linear_to_srgb(seen) * linear_to_srgb(seen),
        }
    }

    /// The light that is seen in the place of light.
    pub fn seen(self, light: f64) -> f64 {
        let light = light.max(0.0);
        match self {
            Self::Right => light,
            Self::Missing => srgb_to_linear(light),
            Self::Twice => linear_to_srgb(light),
            Self::Power22 => srgb_to_linear(libm::pow(light, 1.0 / 2.2)),
            Self::Root => srgb_to_linear(light.sqrt()),
        }
    }
}

/// What is done to a picture's light.
#[derive(Clone, Copy, Debug)]
pub enum Look {
    /// Its channels are in another order.
    Channels([usize; 3]),
    /// All channels are a mean of them.
    Gray([f64; 3]),
    /// Each channel goes through a curve.
    Curve(fn(f64) -> f64),
    /// Its bytes are cut off instead of rounded.
    CutOff,
    /// Pixels between two places that have a colour are no part of the scene.
    Patch {
        /// The colour in linear light.
        light: [f64; 3],
        /// The least and the greatest column and row.
        area: [[f64; 2]; 2],
    },
}

/// Whether two colours are within a step of each other.
pub fn is_near(one: [f64; 3], other: [f64; 3]) -> bool {
    /// The least and the greatest slope of sRGB, for light of 1 and of 0.
    const SLOPES: [f64; 2] = [1.055 / 2.4, 12.92];
    let is_near = |i: usize| {
        let difference = (one[i] - other[i]).abs();
        if difference * SLOPES[1] < 1.5 * STEP {
            return true;
        }
        let is_light = one[i] <= 1.0 && other[i] <= 1.0;
        if is_light && difference * SLOPES[0] > 1.5 * STEP {
            return false;
        }
        (linear_to_srgb(one[i]) - linear_to_srgb(other[i])).abs() < 1.5 * STEP
    };
    (0..3).all(is_near)
}

/// The numbers of a colour whose means tell the mean and the variance of what is averaged: each channel and its square.
pub fn numbers(average: Average) -> impl Fn(Color) -> [f64; 6] {
    move |color| {
        let [r, g, b] = color.to_linear().map(|light| average.of(light));
        [r, g, b, r * r, g * g, b * b]
    }
}

/// The mean and the variance of an exact pixel.
pub fn moments(pixel: &ExactPixel<6>) -> ([f64; 3], [f64; 3]) {
    let [r, g, b, rr, gg, bb] = pixel.mean;
    let doubt = pixel.bound * pixel.bound;
    let variance = |mean: f64, square: f64| (square - mean * mean).max(0.0) + doubt;
    let variances = [variance(r, rr), variance(g, gg), variance(b, bb)];
    ([r, g, b], variances)
}
