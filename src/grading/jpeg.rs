//! What JPEG does to a picture.
//!
//! In: how a file is coded, and what a picture should show. Out: what it shows if it is coded as
//! the file is, and the variance that this coding gives to each pixel, in linear light, as a
//! picture with noise is coded a little otherwise.
//!
//! JPEG (ITU-T T.81) rounds the 64 coefficients of each block of 8 × 8 numbers of luma, and of
//! chroma, to multiples of the steps in its tables. The transform keeps squares, so the mean
//! variance of a block's numbers is the mean of those of the coefficients, a twelfth of a step's
//! square each. A block of one colour has one coefficient. Chroma is taken to be kept for each
//! second column and row alone, as it is in most files, so that noise mixes with that up to two
//! pixels away.

use glam::DVec3;

use super::{
    light::{Curve, STEP},
    moments::range,
    prediction::Prediction,
    strays::DEVIATIONS,
};
use crate::{
    area::Area,
    color::srgb_to_linear,
    film::{Jpeg, JpegTable},
};

/// The side of a block, where chroma is kept for each second column and row.
const BLOCK: usize = 16;

/// How far colours mix, in pixels.
const MIXED: usize = 2;

/// What pixels show that should show something else, if that is coded as a file is; none if it
/// cannot be.
pub fn coded(jpeg: &Jpeg, prediction: &Prediction, part: Area) -> Option<Vec<DVec3>> {
    let byte = |light: f64| {
        let encoded = prediction.encoded(light);
        (255.0 * encoded).round().clamp(0.0, 255.0) as u8
    };
    let light: Vec<f64> = (0..=255).map(light_of(prediction.curve)).collect();
    let mean = prediction.moments.mean.iter();
    let bytes: Vec<u8> = mean.flat_map(|pixel| pixel.to_array().map(byte)).collect();
    let coded = jpeg.coded(&bytes, [part.width, part.height])?;
    let (pixels, _) = coded.as_chunks::<3>();
    Some(
        pixels
            .iter()
            .map(|pixel| DVec3::from(pixel.map(|byte| light[usize::from(byte)])))
            .collect(),
    )
}

/// The light of a byte.
fn light_of(curve: Curve) -> impl Fn(u8) -> f64 {
    move |byte| curve.light(srgb_to_linear(f64::from(byte) / 255.0))
}

/// The variances that a file's coding gives to the cells of so many pixels each way of a picture
/// that should show something.
pub fn variances(jpeg: &Jpeg, prediction: &Prediction, factor: usize) -> Vec<DVec3> {
    let (mean, width) = (&prediction.moments.mean, prediction.width);
    let height = mean.len() / width;
    // How much of blue-yellow and red-green difference is in a channel.
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
    // Most pixels are as the one before, and curves take long.
    let mut known = [([f64::NAN; 2], f64::NAN); 3];
    let pixel = |at: usize| {
        let is_flat = are_flat[block(at)];
        let square = |table: &JpegTable| match is_flat {
            true => table.first / 64.0,
            false => table.mean / count,
        };
        // Of the block beside it, too.
        let [least, most] = range(mean, width, at, reach);
        let mixed = most - least;
        DVec3::from([0, 1, 2].map(|i| {
            // Before the transform and after it numbers are rounded, or cut off, which makes four
            // times the square.
            let share = SHARES[i] * SHARES[i];
            let steps = square(&jpeg.luma) + share * square(&jpeg.chroma) + 4.0 * (2.0 + share);
            // In light a step is the more, the brighter: it is told from so many deviations.
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
