//! Linear light as bytes of sRGB.
//!
//! Encoding and rounding are one comparison with thresholds: byte k stands for what lies from the
//! light of k − 1/2 to that of k + 1/2. The thresholds are exact, so every light gets the byte that
//! is the nearest; and a colour of the scene that nothing else is mixed into comes out as
//! [`Color::to_bytes`](crate::color::Color::to_bytes) has it, ties included.

use std::array;

use crate::color::half_byte;

/// The parts that linear light is cut into to find the byte.
const PARTS: usize = 4096;

/// Encodes linear light as bytes.
pub struct Encoder {
    /// The light of k + 1/2, for the bytes k below 255.
    thresholds: [f64; 255],
    /// The byte at the dark end of each part.
    start: [u8; PARTS + 1],
}

/// Prepares the thresholds.
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
    /// The bytes of a pixel.
    pub fn pixel(&self, light: [f64; 3]) -> [u8; 3] {
        light.map(|channel| self.encode(channel))
    }

    /// The byte of one channel; light below 0 or above 1 counts as 0 or 1.
    pub fn encode(&self, light: f64) -> u8 {
        // The conversion clamps on both sides, and the scaling is exact.
        let part = ((light * PARTS as f64) as usize).min(PARTS);
        let mut byte = self.start[part];
        while byte < 255 && self.thresholds[usize::from(byte)] <= light {
            byte += 1;
        }
        byte
    }
}
