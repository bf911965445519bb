//! What a program may do to light: encode it otherwise, mix its channels.

use std::sync::OnceLock;

use crate::color::{linear_to_srgb, srgb_to_linear};

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
    /// How many there are.
    pub const COUNT: usize = Self::Root as usize + 1;

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
        let place = light.clamp(0.0, 1.0) * LIGHTS as f64;
        let at = (place as usize).min(LIGHTS - 1);
        let [low, high] = [at, at + 1].map(|at| self.table()[at][1]);
        low + (place - at as f64) * (high - low)
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
    let step = |light| Curve::Right.step(light);
    (0..3).all(|i| (one[i] - other[i]).abs() < 1.5 * f64::max(step(one[i]), step(other[i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_seen_quickly_is_near_what_is_seen() {
        let curves = [
            Curve::Right,
            Curve::Missing,
            Curve::Twice,
            Curve::Power22,
            Curve::Root,
        ];
        assert_eq!(curves.len(), Curve::COUNT);
        for curve in curves {
            // Ends and inner points of the table's intervals.
            for light in (0..=16 * LIGHTS).map(|at| at as f64 / (16 * LIGHTS) as f64) {
                let off = (curve.seen_quickly(light) - curve.seen(light)).abs();
                assert!(off < 1e-3, "{curve:?} of {light}: {off}");
            }
        }
    }
}
