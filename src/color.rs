//! Colours in sRGB, as in the scene language, and in linear light, in which samples are averaged.

use std::fmt;

use dashu_int::UBig;

use crate::math::{Double, Real};

/// An sRGB colour; each channel is a number from 0 to 255, and may have a fraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// Red, green and blue, encoded as sRGB, 0 to 255.
    pub srgb: [f64; 3],
}

impl Color {
    /// Black.
    pub const BLACK: Self = Self::from_bytes([0, 0, 0]);

    /// Makes a colour from the bytes of red, green and blue.
    pub const fn from_bytes([r, g, b]: [u8; 3]) -> Self {
        Self {
            srgb: [r as f64, g as f64, b as f64],
        }
    }

    /// Returns the channels rounded to the nearest bytes; halves are rounded up.
    pub fn to_bytes(self) -> [u8; 3] {
        // A channel lies in 0..=255, so the rounded channel always fits into a `u8`.
        self.srgb.map(|channel| channel.round() as u8)
    }

    /// Returns the channels in linear light, from 0 to 1 (IEC 61966-2-1).
    pub fn to_linear(self) -> [f64; 3] {
        self.srgb.map(|channel| {
            if channel.fract() == 0.5 {
                // This channel lies halfway between two bytes. `to_bytes` rounds it up, so its
                // light must be rounded up, too. The result of `srgb_to_linear` might be slightly
                // too dark and be rounded down. `half_byte` returns the least light that is rounded
                // up.
                half_byte(channel as u8)
            } else {
                srgb_to_linear(channel / 255.0)
            }
        })
    }
}

/// Writes the nearest hex code, `#rrggbb` in lower case.
impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.to_bytes();
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// Decodes one sRGB channel, from 0 to 1, to linear light, from 0 to 1 (IEC 61966-2-1).
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// Returns the least linear light that is rounded to the byte `k` + 1 of sRGB, for `k` < 255. This
/// is the light whose sRGB value is `k` + 1/2 in 8-bit steps, rounded up to an `f64`.
///
/// Integers suffice to decide whether an `f64` is below this light. The curve of sRGB raises a
/// rational number x to the power 2.4. A positive light L is less than x^2.4 exactly if L^5 is less
/// than x^12.
pub fn half_byte(k: u8) -> f64 {
    let mut light = srgb_to_linear((f64::from(k) + 0.5) / 255.0);
    while !is_below_half(light.next_down(), k) {
        light = light.next_down();
    }
    while is_below_half(light, k) {
        light = light.next_up();
    }
    light
}

/// Returns whether `light`, in linear light, is darker than the light whose sRGB value is `k` +
/// 1/2, in 8-bit steps. `light` must be positive and not subnormal.
fn is_below_half(light: f64, k: u8) -> bool {
    // Bound on the relative rounding error of `difference` below. The difference is computed in
    // double-doubles (sums of two `f64`), which decide most cases. Integers could decide all cases,
    // but this would take half the time of rendering a small picture.
    //
    // In multiples of the unit roundoff of a double-double, the relative errors are at most 4 for
    // light^5, 11 for scale^12, 1 for the product of these two powers, 11 for x^12, and 1 for the
    // difference. The sum of these errors is 28, which is less than 32.
    const ERROR: f64 = 32.0 * Double::UNIT;
    let squared = |x: Double| x.times(&x);
    let power_12 = |x: Double| squared(squared(squared(x).times(&x)));
    let halves = 2.0 * f64::from(k) + 1.0;
    let [light, x, scale] = [light, 1000.0 * halves + 28_050.0, 538_050.0].map(Double::from_f64);
    let left = squared(squared(light))
        .times(&light)
        .times(&power_12(scale));
    let right = power_12(x);
    let difference = left.minus(&right).hi;
    if halves > 20.0 && difference.abs() > ERROR * right.hi {
        difference < 0.0
    } else {
        is_below_half_exactly(light.hi, k)
    }
}

/// Returns the result of [`is_below_half`], computed with integers and therefore without rounding
/// errors.
fn is_below_half_exactly(light: f64, k: u8) -> bool {
    let exponent = (light.to_bits() >> 52) as usize;
    let significand = UBig::from(light.to_bits() & ((1 << 52) - 1) | 1 << 52);
    // Here, light = significand / 2^shift.
    let shift = 1075 - exponent;
    // Twice the 8-bit value `k` + 1/2: the sRGB value on a scale from 0 (black) to 510 (white).
    let halves = 2 * u32::from(k) + 1;
    // The straight piece of the curve ends at 0.04045 on a scale from 0 to 1, i.e. at 20.6 on the
    // scale of `halves`. The whole number `halves` therefore lies on the straight piece if it is at
    // most 20.
    if halves <= 20 {
        // On the straight piece, the test is L < c/12.92. Here L is the light, and c = halves/510
        // is the sRGB value. Multiplied by 65892 = 5100·12.92, it becomes 65892·L < 10·halves.
        significand * 65_892u32 < UBig::from(10 * halves) << shift
    } else {
        // On the curved piece, the test is L < x^2.4, i.e. L^5 < x^12. Here L is the light, x = (c
        // + 0.055)/1.055 = (1000·halves + 28050)/538050, and c = halves/510 is the sRGB value.
        let x = UBig::from(1000 * halves + 28_050);
        significand.pow(5) * UBig::from(538_050u32).pow(12) < x.pow(12) << (5 * shift)
    }
}

/// Encodes one channel of linear light, from 0 to 1, as sRGB, from 0 to 1; inverts
/// [`srgb_to_linear`]. A light below 0 is encoded by the straight piece of the curve, and a light
/// above 1 by the power function.
pub fn linear_to_srgb(light: f64) -> f64 {
    if light <= 0.04045 / 12.92 {
        12.92 * light
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}

/// Converts a channel in the range 0–1 to a whole number in the range 0–255, and formats it.
pub fn in_bytes(part: f64) -> String {
    (part * 255.0).round().to_string()
}

/// Converts the channels of `written`, a colour in a scene's text, from the range 0–1 to the range
/// 0–255. Returns `written` unchanged if a channel is greater than 1 or not a number.
pub fn whole_parts(written: &str) -> String {
    if !are_shares(&[written]) {
        return written.to_owned();
    }
    let mut bytes = String::new();
    for part in written.split(',') {
        bytes += if bytes.is_empty() { "" } else { ", " };
        bytes += &in_bytes(part.trim().parse().unwrap_or(0.0));
    }
    bytes
}

/// Returns whether all channels in `parts` are numbers up to 1. `parts` contains the texts of a
/// colour's channels in a scene. The language's channels go from 0 to 255, so the author of such a
/// colour may have meant the range 0–1.
pub fn are_shares(parts: &[&str]) -> bool {
    let separates = |c: char| c == ',' || c.is_whitespace();
    let parts = parts.iter().flat_map(|part| part.split(separates));
    let mut parts = parts.filter(|part| !part.is_empty());
    parts.all(|part| part.parse().is_ok_and(|part: f64| part <= 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_those_of_whole_numbers() {
        for k in 0..255 {
            let light = half_byte(k);
            let are_below = [light.next_down(), light].map(|light| is_below_half_exactly(light, k));
            assert_eq!(are_below, [true, false], "{k}");
        }
    }
}
