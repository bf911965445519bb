//! Converts linear light to bytes of sRGB.
//!
//! The conversion compares the light with thresholds. Between any two neighbouring bytes, k and
//! k + 1, there is one threshold: the light whose sRGB value is k + 1/2. The thresholds are exact,
//! so that every light is converted to the nearest byte. For a colour of the scene, the result is
//! the same as that of [`Color::to_bytes`](crate::color::Color::to_bytes), even halfway between two
//! bytes.

use std::{array, sync::LazyLock};

use crate::color::half_byte;

/// Number of equal intervals of linear light from 0 to 1. For each interval, the table
/// [`Encoder::start`] contains the byte with which the conversion starts. With 4096 intervals, each
/// contains at most one threshold between two bytes, even near black, where thresholds are closest.
/// The conversion then increases the byte at most once. The number is a power of two, so that
/// multiplying by it is exact.
const PARTS: usize = 4096;

/// Converter of linear light to bytes of sRGB.
#[derive(Clone, Debug)]
pub struct Encoder {
    /// Threshold between each byte k and k + 1: the linear light whose sRGB value is k + 1/2, in
    /// 8-bit steps. From this light on, the byte is k + 1.
    thresholds: [f64; 255],
    /// Table of the bytes with which conversions start. Linear light from 0 to 1 is divided into
    /// [`PARTS`] equal intervals, and the table contains the byte of each interval's lower end.
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
    /// Returns the converter that all threads share. It is computed by the first call.
    pub fn shared() -> &'static Self {
        static SHARED: LazyLock<Encoder> = LazyLock::new(Encoder::default);
        &SHARED
    }

    /// Converts a pixel from linear light to bytes of sRGB.
    pub fn pixel(&self, light: [f64; 3]) -> [u8; 3] {
        light.map(|channel| self.encode(channel))
    }

    /// Converts one channel from linear light to a byte of sRGB. Light below 0 becomes 0, and light
    /// above 1 becomes 255.
    pub fn encode(&self, light: f64) -> u8 {
        // Because `PARTS` is a power of two, the product is exact. Converting it to an integer
        // turns negative light into 0. `min` limits light above 1.
        let part = ((light * PARTS as f64) as usize).min(PARTS);
        let mut byte = self.start[part];
        while byte < 255 && self.thresholds[usize::from(byte)] <= light {
            byte += 1;
        }
        byte
    }

    /// Returns whether all light from `low` to `high` is converted to the same byte.
    pub fn is_one_byte(&self, low: f64, high: f64) -> bool {
        let byte = self.encode(low);
        byte == 255 || high < self.thresholds[usize::from(byte)]
    }
}
