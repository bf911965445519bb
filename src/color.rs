//! Colours: sRGB as the language writes them, linear light as the film averages them.

use std::fmt;

/// An sRGB colour; each channel is a number from 0 to 255, fractions allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color {
    /// Red, green and blue, encoded, 0 to 255.
    pub srgb: [f64; 3],
}

impl Color {
    /// Black.
    pub const BLACK: Self = Self::from_bytes([0, 0, 0]);

    /// A colour from three bytes.
    pub const fn from_bytes([r, g, b]: [u8; 3]) -> Self {
        Self {
            srgb: [r as f64, g as f64, b as f64],
        }
    }

    /// The nearest colour of three bytes.
    pub fn to_bytes(self) -> [u8; 3] {
        // A channel lies in 0..=255, so the conversion only rounds.
        self.srgb.map(|channel| channel.round() as u8)
    }

    /// The channels in linear light, 0 to 1 (IEC 61966-2-1).
    pub fn to_linear(self) -> [f64; 3] {
        self.srgb.map(|channel| srgb_to_linear(channel / 255.0))
    }
}

/// The nearest hex code, `#rrggbb` in lower case.
impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.to_bytes();
        write!(f, "#{r:02x}{g:02x}{b:02x}")
    }
}

/// Decodes one sRGB channel, 0 to 1, to linear light, 0 to 1 (IEC 61966-2-1).
pub fn srgb_to_linear(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        libm::pow((encoded + 0.055) / 1.055, 2.4)
    }
}

/// Encodes one channel of linear light, 0 to 1, as sRGB, 0 to 1: the inverse of [`srgb_to_linear`]. Negative light goes on with the straight
/// piece and light above 1 with the curve.
pub fn linear_to_srgb(light: f64) -> f64 {
    if light <= 0.04045 / 12.92 {
        12.92 * light
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}
