//! Linear light as bytes of sRGB.
//!
//! Encoding and rounding are a comparison with thresholds: byte k stands for the range of light
//! from the threshold k − 1/2 to the threshold k + 1/2, both decoded to linear light. The
//! thresholds are exact, so every light gets the nearest byte. An unmixed colour of the scene gets
//! the same bytes as by [`Color::to_bytes`](crate::color::Color::to_bytes), also if a channel is
//! halfway between two bytes.

use std::array;

use crate::color::half_byte;

/// Number of equal intervals into which the range of linear light is divided. For each interval,
/// the table [`Encoder::start`] has the byte at which encoding begins its search.
const PARTS: usize = 4096;

/// Encoder of linear light as bytes of sRGB.
#[derive(Clone, Debug)]
pub struct Encoder {
    /// For each byte k below 255, the linear light whose sRGB value is k + 1/2, in 8-bit steps.
    /// From this light on, the byte is k + 1.
    thresholds: [f64; 255],
    /// For each interval of linear light, the byte of the light at its dark end.
    start: [u8; PARTS + 1],
}

/// Computes the thresholds and the table of intervals.
impl Default for Encoder {
    fn default() -> Self {
        let thresholds = array::from_fn(|k| half_byte(k as u8));
        let start = array::from_fn(|part| {
            let light = part as f64 / PARTS as f64;
            thresholds.partition_point(|&threshold| threshold <= light) as u8
        });
        Self { thresholds, start }
    }
}

impl Encoder {
    /// Encodes the channels of a pixel as bytes of sRGB.
    pub fn pixel(&self, light: [f64; 3]) -> [u8; 3] {
        light.map(|channel| self.encode(channel))
    }

    /// Encodes one channel. Light below 0 is encoded as 0, and light above 1 as 255.
    pub fn encode(&self, light: f64) -> u8 {
        // The scaling is exact, and the conversion saturates on both sides.
        let part = ((light * PARTS as f64) as usize).min(PARTS);
        let mut byte = self.start[part];
        while byte < 255 && self.thresholds[usize::from(byte)] <= light {
            byte += 1;
        }
        byte
    }
}
