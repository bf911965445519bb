//! Predicts what JPEG coding does to a picture.
//!
//! In: how a file is coded, and a prediction of the picture. Out: the predicted picture after
//! coding, and the variance that coding adds to each pixel, in linear light. The variance is needed
//! because the real picture has noise, which changes how it is coded.
//!
//! JPEG (ITU-T T.81) transforms each block of 8 × 8 values of luma (brightness) or chroma (colour)
//! into 64 coefficients. Each coefficient is rounded to a multiple of a step, which a table
//! contains. Rounding to a step s adds the variance s²/12. The transform preserves sums of squares,
//! so the mean variance of a block's values is the mean variance of its coefficients. In a block of
//! one colour, only the first coefficient differs from 0, so rounding changes only this
//! coefficient. Chroma is assumed to have half the picture's resolution, as in most files, so its
//! errors spread up to two pixels.

use glam::DVec3;

use super::{moments::range, prediction::Prediction, unexplained_errors::DEVIATIONS};
use crate::{
    area::Area,
    color::srgb_to_linear,
    film::{Jpeg, JpegTable},
    grading::hypotheses::STEP,
};

/// Side of a block of chroma, in pixels, if chroma has half the picture's resolution. Along the
/// side, there are 8 values of chroma, each of which spans 2 pixels.
const BLOCK: usize = 16;

/// Distance over which the colours of neighbouring pixels mix, in pixels, if chroma has half the
/// picture's resolution.
const MIXED: usize = 2;

/// Encodes the predicted picture as the file is encoded, and returns the light after decoding.
/// Returns `None` if the encoder does not support the file's chroma subsampling or the picture's
/// size.
pub fn coded(jpeg: &Jpeg, prediction: &Prediction, part: Area) -> Option<Vec<DVec3>> {
    let byte = |light: f64| {
        let encoded = prediction.encoded(light);
        (255.0 * encoded).round().clamp(0.0, 255.0) as u8
    };
    let light_of = |byte: u8| {
        prediction
            .curve
            .light(srgb_to_linear(f64::from(byte) / 255.0))
    };
    let light: Vec<f64> = (0..=255).map(light_of).collect();
    let mean = prediction.moments.mean.iter();
    let bytes: Vec<u8> = mean.flat_map(|pixel| pixel.to_array().map(byte)).collect();
    let coded = jpeg.coded(&bytes, [part.width, part.height])?;
    let (pixels, _) = coded.as_chunks::<3>();
    let light = |pixel: &[u8; 3]| DVec3::from(pixel.map(|byte| light[usize::from(byte)]));
    Some(pixels.iter().map(light).collect())
}

/// Returns the variances that JPEG coding adds to the cells of a prediction, in squared linear
/// light. A cell is `factor` pixels wide and tall.
pub fn variances(jpeg: &Jpeg, prediction: &Prediction, factor: usize) -> Vec<DVec3> {
    let (mean, width) = (&prediction.moments.mean, prediction.width);
    let height = mean.len() / width;
    // Weights by which JPEG's conversion from YCbCr to RGB multiplies chroma, for red, green and
    // blue. Green depends on both chroma values, Cb and Cr, so its weight is the sum of two
    // weights.
    const SHARES: [f64; 3] = [1.402, 0.344 + 0.714, 1.772];
    let side = (BLOCK / factor).max(1);
    let reach = MIXED.div_ceil(factor);
    let count = (factor * factor) as f64;
    let columns = width.div_ceil(side);
    let mut blocks = vec![None; columns * height.div_ceil(side)];
    let block = |at: usize| at / width / side * columns + at % width / side;
    let mut are_flat = vec![true; blocks.len()];
    for at in 0..mean.len() {
        let first = *blocks[block(at)].get_or_insert(mean[at]);
        are_flat[block(at)] &= first == mean[at];
    }
    // Last argument and result of the conversion to light, for each channel. They are cached
    // because most pixels equal the one before, and the conversion is slow.
    let mut known = [([f64::NAN; 2], f64::NAN); 3];
    let pixel = |at: usize| {
        let is_flat = are_flat[block(at)];
        let square = |table: &JpegTable| {
            if is_flat {
                table.first / 64.0
            } else {
                table.mean / count
            }
        };
        // If chroma has half the resolution, the colours of neighbouring pixels mix. So the
        // difference between the least and the greatest of these colours adds to the variance.
        let [least, most] = range(mean, width, at, reach);
        let mixed = most - least;
        DVec3::from([0, 1, 2].map(|i| {
            // The first two terms come from rounding the coefficients of luma and of chroma. The
            // last term comes from values that are rounded or truncated to integers before and
            // after the transform. The mean squared error of truncation is 1/3, four times that of
            // rounding, hence the factor 4.
            let share = SHARES[i] * SHARES[i];
            let steps = square(&jpeg.luma) + share * square(&jpeg.chroma) + 4.0 * (2.0 + share);
            // A step of the 8-bit value changes light more in bright areas than in dark ones. To be
            // safe, the standard deviation is computed from the greatest likely error: the 8-bit
            // value is increased by five standard deviations (`DEVIATIONS`), and the increase of
            // the light is divided by five.
            let by = DEVIATIONS * STEP * (steps / 12.0).sqrt();
            let own = [mean[at][i], by];
            if known[i].0 != own {
                let encoded = prediction.encoded(own[0]);
                let most = prediction.curve.light(srgb_to_linear(encoded + by));
                known[i] = (own, (most - own[0]) / DEVIATIONS);
            }
            let light = known[i].1;
            light * light + mixed[i] * mixed[i] / (4.0 * count)
        }))
    };
    (0..mean.len()).map(pixel).collect()
}
