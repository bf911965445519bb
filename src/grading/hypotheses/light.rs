//! What a program may do to light: encode it by another curve, mix its channels, change its pixels.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, OnceLock},
};

use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    lock::lock,
};

/// Step of 8-bit sRGB. Nobody sees less, so files of more bits are treated as if they had 8.
pub const STEP: f64 = 1.0 / 255.0;

/// Curve by which light is encoded, described by the light that a correct decoder sees instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// The correct curve, sRGB: the same light is seen.
    Correct,
    /// No encoding: light is decoded once too often.
    Missing,
    /// Encoding twice.
    Twice,
    /// The power 1/2.2.
    Power22,
    /// A square root.
    Root,
}

impl Curve {
    /// All curves, in the order of their numbers.
    pub const ALL: [Self; 5] = [
        Self::Correct,
        Self::Missing,
        Self::Twice,
        Self::Power22,
        Self::Root,
    ];
    /// Number of curves.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns the light that was encoded, given the light that is seen.
    pub fn light(self, seen: f64) -> f64 {
        match self {
            Self::Correct => seen,
            // A film of floats may have negative numbers, which have no powers.
            _ if seen < 0.0 => 0.0,
            Self::Missing => linear_to_srgb(seen),
            Self::Twice => srgb_to_linear(seen),
            Self::Power22 => libm::pow(linear_to_srgb(seen), 2.2),
            Self::Root => linear_to_srgb(seen) * linear_to_srgb(seen),
        }
    }

    /// Returns the light that is seen, given the light that was encoded.
    pub fn seen(self, light: f64) -> f64 {
        let light = light.max(0.0);
        match self {
            Self::Correct => light,
            Self::Missing => srgb_to_linear(light),
            Self::Twice => linear_to_srgb(light),
            Self::Power22 => srgb_to_linear(libm::pow(light, 1.0 / 2.2)),
            Self::Root => srgb_to_linear(light.sqrt()),
        }
    }

    /// Returns the light of a step of 8 bits at some light that is encoded by the curve.
    pub fn step(self, light: f64) -> f64 {
        let at = (light.clamp(0.0, 1.0) * LIGHTS as f64).round() as usize;
        self.table()[at][0]
    }

    /// Interpolates `seen` in a table: fast, and accurate to a thousandth of white.
    pub fn seen_quickly(self, light: f64) -> f64 {
        let table = self.table();
        interpolated(light, |at| table[at][1])
    }

    /// Returns the step and the seen light for each of `LIGHTS` + 1 lights from 0 to 1.
    fn table(self) -> &'static [[f64; 2]] {
        static TABLES: [OnceLock<Vec<[f64; 2]>>; Curve::COUNT] =
            [const { OnceLock::new() }; Curve::COUNT];
        let of = |at: usize| {
            let seen = self.seen(at as f64 / LIGHTS as f64);
            let encoded = linear_to_srgb(seen);
            let [low, high] = [-0.5, 0.5].map(|by| (encoded + by * STEP).max(0.0));
            let step = self.light(srgb_to_linear(high)) - self.light(srgb_to_linear(low));
            [step, seen]
        };
        TABLES[self as usize].get_or_init(|| (0..=LIGHTS).map(of).collect())
    }
}

/// Number of intervals in a table of lights.
const LIGHTS: usize = 4096;

/// Interpolates a table of `LIGHTS` + 1 values for lights from 0 to 1.
fn interpolated(light: f64, value: impl Fn(usize) -> f64) -> f64 {
    let place = light.clamp(0.0, 1.0) * LIGHTS as f64;
    let at = (place as usize).min(LIGHTS - 1);
    let [low, high] = [at, at + 1].map(&value);
    low + (place - at as f64) * (high - low)
}

/// Encodes light from 0 to 1 as sRGB from 0 to 1, accurate to a hundredth of a step.
pub fn encoded_quickly(light: f64) -> f64 {
    // Light that was encoded twice is seen as its encoding.
    Curve::Twice.seen_quickly(light)
}

/// A tabulated function of light.
pub struct Tabulated(Arc<[f64]>);

impl Tabulated {
    /// Tabulates a function; each function's table is made once.
    pub fn new(curve: fn(f64) -> f64) -> Self {
        static TABLES: Mutex<BTreeMap<usize, Arc<[f64]>>> = Mutex::new(BTreeMap::new());
        let mut tables = lock(&TABLES);
        let table = tables.entry(curve as usize).or_insert_with(|| {
            let lights = (0..=LIGHTS).map(|at| at as f64 / LIGHTS as f64);
            lights.map(curve).collect()
        });
        Self(Arc::clone(table))
    }

    /// Interpolates the function at a light from 0 to 1.
    pub fn at(&self, light: f64) -> f64 {
        interpolated(light, |at| self.0[at])
    }
}

/// An effect on a picture's light.
#[derive(Clone, Copy, Debug)]
pub enum Effect {
    /// The channels are in another order.
    Channels([usize; 3]),
    /// All channels have a weighted mean of the channels.
    Gray([f64; 3]),
    /// Each channel goes through a function.
    PerChannel(fn(f64) -> f64),
    /// Each channel is multiplied by the factor that explains most of the picture, between these
    /// two functions.
    Gain([fn(f64) -> f64; 2]),
    /// Bytes are truncated instead of rounded.
    CutOff,
    /// The difference of a pixel from the mean of the 3 × 3 around it is added once more.
    Sharpened,
    /// Each pixel is averaged over its neighbourhood, as if it were seen through a pixel of this
    /// width, in pixels.
    Blur(f64),
    /// A rectangle's pixels of one colour are no part of the scene.
    Patch {
        /// The colour, in linear light.
        light: [f64; 3],
        /// The least and the greatest column and row.
        area: [[f64; 2]; 2],
    },
}

/// Returns whether two colours are within 1.5 steps of each other.
pub fn is_near(one: [f64; 3], other: [f64; 3]) -> bool {
    let step = |light| Curve::Correct.step(light);
    (0..3).all(|i| (one[i] - other[i]).abs() < 1.5 * f64::max(step(one[i]), step(other[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolated_light_is_near_the_function() {
        for curve in Curve::ALL {
            // Ends and inner points of the table's intervals.
            for light in (0..=16 * LIGHTS).map(|at| at as f64 / (16 * LIGHTS) as f64) {
                let off = (curve.seen_quickly(light) - curve.seen(light)).abs();
                assert!(off < 1e-3, "{curve:?} of {light}: {off}");
            }
        }
    }

    #[test]
    fn light_is_encoded_quickly_to_within_a_hundredth_of_a_step() {
        for light in (0..=16 * LIGHTS).map(|at| at as f64 / (16 * LIGHTS) as f64) {
            let off = (encoded_quickly(light) - linear_to_srgb(light)).abs();
            assert!(off < 0.01 * STEP, "{light}: {off}");
        }
    }
}
