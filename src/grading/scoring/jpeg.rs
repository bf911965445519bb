//! What JPEG coding does to a picture.
//!
//! In: how a file is coded, and a prediction of the picture. Out: the coded picture, and the
//! variance that the coding adds to each pixel, in linear light, because a picture with noise is
//! coded a little otherwise.
//!
//! JPEG (ITU-T T.81) rounds the 64 coefficients of each block of 8 × 8 numbers of luma, and of
//! chroma, to multiples of the steps in its tables. The transform preserves squares, so the mean
//! variance of a block's numbers is the mean of the coefficients' variances, a twelfth of a step's
//! square each. A block of one colour has one coefficient. Chroma is assumed to be kept only for
//! every second column and row, as it is in most files, so that noise spreads up to two pixels.

use glam::DVec3;

use super::{moments::range, prediction::Prediction, strays::DEVIATIONS};
use crate::{
    area::Area,
    color::srgb_to_linear,
    film::{Jpeg, JpegTable},
    grading::hypotheses::STEP,
};

/// Side of a block, in pixels, if chroma is kept for every second column and row.
const BLOCK: usize = 16;

/// Distance over which colours mix, in pixels.
const MIXED: usize = 2;

/// Codes a prediction as the file is coded. Returns `None` if it cannot be coded.
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

/// Returns the variances that the coding adds to the cells of a prediction, which span `factor`
/// pixels each way.
pub fn variances(jpeg: &Jpeg, prediction: &Prediction, factor: usize) -> Vec<DVec3> {
    let (mean, width) = (&prediction.moments.mean, prediction.width);
    let height = mean.len() / width;
    // Weights of the blue-yellow and red-green differences in each channel.
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
    // Most pixels equal the one before, and curves are slow to evaluate.
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
        // Colours of neighbouring blocks mix, too.
        let [least, most] = range(mean, width, at, reach);
        let mixed = most - least;
        DVec3::from([0, 1, 2].map(|i| {
            // Numbers are rounded or truncated before and after the transform, which quadruples the
            // variance.
            let share = SHARES[i] * SHARES[i];
            let steps = square(&jpeg.luma) + share * square(&jpeg.chroma) + 4.0 * (2.0 + share);
            // A step is larger in brighter light, so the variance is measured at several
            // deviations.
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
