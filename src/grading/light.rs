//! What a program may do to light: encode it otherwise, mix its channels.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, OnceLock},
};

use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    lock::lock,
};

/// A step of 8-bit sRGB. Nobody sees less, so no file is taken for finer.
pub const STEP: f64 = 1.0 / 255.0;

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
    /// All of them, in order.
    pub const ALL: [Self; 5] = [
        Self::Right,
        Self::Missing,
        Self::Twice,
        Self::Power22,
        Self::Root,
    ];
    /// How many there are.
    pub const COUNT: usize = Self::ALL.len();

    /// The light that was encoded, where other light is seen.
    pub fn light(self, seen: f64) -> f64 {
        match self {
            Self::Right => seen,
            // A file of floats may have negative ones, of which there are no powers.
            _ if seen < 0.0 => 0.0,
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

    /// The light of a step of the encoding of what is seen in its place.
    pub fn step(self, light: f64) -> f64 {
        let at = (light.clamp(0.0, 1.0) * LIGHTS as f64).round() as usize;
        self.table()[at][0]
    }

    /// Interpolates `seen` in a table: fast, and to within a thousandth of the light of white.
    pub fn seen_quickly(self, light: f64) -> f64 {
        let table = self.table();
        interpolated(light, |at| table[at][1])
    }

    /// The step of each of `LIGHTS` + 1 lights from 0 to 1, and what is seen in its place.
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

/// Intervals between the lights of a table.
const LIGHTS: usize = 4096;

/// Interpolates a table of `LIGHTS` + 1 values, which belong to lights from 0 to 1.
fn interpolated(light: f64, value: impl Fn(usize) -> f64) -> f64 {
    let place = light.clamp(0.0, 1.0) * LIGHTS as f64;
    let at = (place as usize).min(LIGHTS - 1);
    let [low, high] = [at, at + 1].map(&value);
    low + (place - at as f64) * (high - low)
}

/// Encodes light from 0 to 1 as sRGB from 0 to 1, to within a hundredth of a step.
pub fn encoded_quickly(light: f64) -> f64 {
    // Light that was encoded twice is seen as the encoding of light.
    Curve::Twice.seen_quickly(light)
}

/// A function of light, and its values in a table.
pub struct Tabulated(Arc<[f64]>);

impl Tabulated {
    /// Tabulates a function; the table is made once.
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
    /// What a pixel has more than the mean of the 3 × 3 around it is added once more.
    Sharpened,
    /// Each pixel is a mean over a neighbourhood: as if seen through a pixel so many times as wide.
    Blur(f64),
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
    let step = |light| Curve::Right.step(light);
    (0..3).all(|i| (one[i] - other[i]).abs() < 1.5 * f64::max(step(one[i]), step(other[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_seen_quickly_is_near_what_is_seen() {
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
