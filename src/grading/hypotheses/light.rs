//! What a program may do to the light of its picture: encode it by a wrong curve, mix its channels,
//! or change pixels.

use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, OnceLock},
};

use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    lock::lock,
};

/// Difference between neighbouring values of 8-bit sRGB, on a scale where 1 is white. Files with
/// more bits are treated as if they had 8, because nobody sees smaller differences.
pub const STEP: f64 = 1.0 / 255.0;

/// Curve by which a program encodes light in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curve {
    /// The sRGB curve, which is correct.
    Correct,
    /// No encoding: linear light is written to the file. Viewers decode it as sRGB, so it looks too
    /// dark.
    Missing,
    /// The sRGB curve, applied twice.
    Twice,
    /// The power function with the exponent 1/2.2.
    Power22,
    /// The square root.
    Root,
}

impl Curve {
    /// All curves, in the order of their discriminants.
    pub const ALL: [Self; 5] = [
        Self::Correct,
        Self::Missing,
        Self::Twice,
        Self::Power22,
        Self::Root,
    ];
    /// Number of curves.
    pub const COUNT: usize = Self::ALL.len();

    /// Returns the light that the program computed, given the light `seen` that a viewer of its
    /// file sees. The program encoded its light by this curve, and the viewer decodes the file as
    /// sRGB.
    pub fn light(self, seen: f64) -> f64 {
        match self {
            Self::Correct => seen,
            // A file of floating-point numbers may contain negative light. It is treated as 0,
            // because it cannot be raised to a power.
            _ if seen < 0.0 => 0.0,
            Self::Missing => linear_to_srgb(seen),
            Self::Twice => srgb_to_linear(seen),
            Self::Power22 => libm::pow(linear_to_srgb(seen), 2.2),
            Self::Root => linear_to_srgb(seen) * linear_to_srgb(seen),
        }
    }

    /// Returns the light that a viewer of the program's file sees, given the light that the program
    /// computed. The program encodes its light by this curve, and the viewer decodes the file as
    /// sRGB.
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

    /// Returns the difference in light between neighbouring 8-bit values near `light`, if light is
    /// encoded by this curve.
    pub fn step(self, light: f64) -> f64 {
        let at = (light.clamp(0.0, 1.0) * LIGHTS as f64).round() as usize;
        self.table()[at][0]
    }

    /// Approximates [`Self::seen`] by a table. This is fast, and accurate to a thousandth of white.
    pub fn seen_quickly(self, light: f64) -> f64 {
        let table = self.table();
        interpolated(light, |at| table[at][1])
    }

    /// Returns a table with a row for each of `LIGHTS` + 1 lights from 0 to 1. The first entry of a
    /// row is the difference in light between neighbouring 8-bit values. The second is the light
    /// that a viewer sees if the program encodes the row's light by this curve.
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

/// Number of intervals in a table of a function of light. With 4096 intervals, all interpolated
/// curves are accurate to a thousandth of white, and sRGB to a hundredth of an 8-bit step. Tests
/// check this.
const LIGHTS: usize = 4096;

/// Interpolates a function of light from 0 to 1 linearly in a table. `value(i)` is the function's
/// value at the light i / `LIGHTS`.
fn interpolated(light: f64, value: impl Fn(usize) -> f64) -> f64 {
    let place = light.clamp(0.0, 1.0) * LIGHTS as f64;
    let at = (place as usize).min(LIGHTS - 1);
    let [low, high] = [at, at + 1].map(&value);
    low + (place - at as f64) * (high - low)
}

/// Encodes light from 0 to 1 as sRGB from 0 to 1, accurate to a hundredth of an 8-bit step.
pub fn encoded_quickly(light: f64) -> f64 {
    // Light that was encoded twice is decoded only once by a viewer. So the viewer sees the sRGB
    // encoding of the light.
    Curve::Twice.seen_quickly(light)
}

/// A function of light from 0 to 1, interpolated in a table.
pub struct Tabulated(Arc<[f64]>);

impl Tabulated {
    /// Tabulates a function. The table is computed at the first call for this function, and then
    /// shared.
    pub fn new(curve: fn(f64) -> f64) -> Self {
        static TABLES: Mutex<BTreeMap<usize, Arc<[f64]>>> = Mutex::new(BTreeMap::new());
        let mut tables = lock(&TABLES);
        let table = tables.entry(curve as usize).or_insert_with(|| {
            let lights = (0..=LIGHTS).map(|at| at as f64 / LIGHTS as f64);
            lights.map(curve).collect()
        });
        Self(Arc::clone(table))
    }

    /// Returns the interpolated value of the function at a light from 0 to 1.
    pub fn at(&self, light: f64) -> f64 {
        interpolated(light, |at| self.0[at])
    }
}

/// Index of a channel that does not exist. The channels 0, 1 and 2 are red, green and blue.
pub const NONE: usize = 3;

/// An effect of a program on the light of its picture.
#[derive(Clone, Copy, Debug)]
pub enum Effect {
    /// The colour channels are in another order. The first number is the channel that is shown as
    /// red, the second as green, the third as blue. The number [`NONE`] means that the channel is 0
    /// everywhere.
    Channels([usize; 3]),
    /// Each channel shows the weighted mean of all channels, with these weights.
    Gray([f64; 3]),
    /// A function is applied to each channel.
    PerChannel(fn(f64) -> f64),
    /// Each channel is multiplied by one factor, which is fitted to the picture. The first function
    /// is applied before the multiplication, the second after it.
    Gain([fn(f64) -> f64; 2]),
    /// Channels are truncated to bytes instead of rounded.
    CutOff,
    /// The sRGB-encoded picture is sharpened: the difference of a pixel from the mean of the 3 × 3
    /// pixels around it is added to the pixel.
    Sharpened,
    /// The picture is blurred, as if each pixel averaged light over a square of this width, in
    /// pixels.
    Blur(f64),
    /// The picture has an area of one colour that is not in the scene.
    Patch {
        /// Colour of the area, in linear light.
        light: [f64; 3],
        /// Bounding rectangle of the area, in pixels: first the least column and row, then the
        /// greatest column and row.
        area: [[f64; 2]; 2],
    },
}

/// Returns whether two colours differ by less than 1.5 steps of 8-bit sRGB in each channel.
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
            // The tested lights are the ends of the table's intervals, and 15 points inside each
            // interval.
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
