//! What JPEG does to a picture.
//!
//! In: a file, and what a picture should show. Out: the variance that the file's coding gives to each pixel, in linear light.
//!
//! JPEG (ITU-T T.81) rounds the 64 coefficients of each block of 8 × 8 numbers of luma, and of chroma, to multiples of the steps in its tables. The transform keeps
//! squares, so the mean variance of a block's numbers is the mean of those of the coefficients, a twelfth of a step's square each. A block of one colour has one
//! coefficient. Chroma may be kept for each second column and row alone: then colours mix with those up to two pixels away.

use super::{
    light::STEP,
    moments::{Moments, range},
    strays::DEVIATIONS,
};
use crate::color::{linear_to_srgb, srgb_to_linear};

/// The side of a block.
const BLOCK: usize = 8;

/// How far colours mix, in pixels.
const MIXED: usize = 2;

/// How a file is coded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jpeg {
    luma: Table,
    chroma: Table,
    /// Whether chroma is kept for fewer columns or rows.
    is_subsampled: bool,
}

/// A table of steps: the square of the first, which is that of a block's mean, and the mean of all squares.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Table {
    first: f64,
    mean: f64,
}

impl Jpeg {
    /// How a file is coded, if it is a JPEG.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let mut rest = bytes.strip_prefix(b"\xff\xd8")?;
        let mut tables = [Table::default(); 4];
        // The tables of luma and chroma, and whether there is less chroma.
        let mut frame = None;
        loop {
            let [0xff, marker, high, low, ..] = *rest else {
                return None;
            };
            if marker == 0xff {
                rest = &rest[1..];
                continue;
            }
            let length = usize::from(u16::from_be_bytes([high, low]));
            let segment = rest.get(4..2 + length)?;
            match marker {
                0xdb => read_tables(segment, &mut tables)?,
                // Frames; among them are three markers of something else.
                0xc0..=0xcf if !matches!(marker, 0xc4 | 0xc8 | 0xcc) => {
                    // A component has three bytes: its name, its sampling factors, and its table.
                    let components = segment.get(6..)?.as_chunks::<3>().0;
                    let [_, sampling, luma] = *components.first()?;
                    let chroma = components.get(1);
                    let is_less = chroma.is_some_and(|chroma| chroma[1] != sampling);
                    frame = Some((luma, chroma.map(|chroma| chroma[2]), is_less));
                }
                // What follows is the picture.
                0xda => {
                    let (luma, chroma, is_subsampled) = frame?;
                    let table = |at: u8| tables.get(usize::from(at)).copied();
                    return Some(Self {
                        luma: table(luma)?,
                        chroma: chroma.map_or(Some(Table::default()), table)?,
                        is_subsampled,
                    });
                }
                _ => {}
            }
            rest = rest.get(2 + length..)?;
        }
    }

    /// The variances of the cells of so many pixels each way, in so many columns, of a picture that should show something.
    pub fn variances(&self, moments: &Moments, width: usize, factor: usize) -> Vec<[f64; 3]> {
        let mean = &moments.mean;
        let height = mean.len() / width;
        // How much of blue-yellow and red-green difference is in a channel.
        const SHARES: [f64; 3] = [1.402, 0.344 + 0.714, 1.772];
        let side = if self.is_subsampled { 2 * BLOCK } else { BLOCK };
        let side = (side / factor).max(1);
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
        let pixel = |at: usize| {
            let is_flat = are_flat[block(at)];
            let square = |table: &Table| match is_flat {
                true => table.first / 64.0,
                false => table.mean / count,
            };
            let mixed = match self.is_subsampled && !is_flat {
                true => {
                    let [least, most] = range(mean, width, at, reach);
                    [0, 1, 2].map(|i| most[i] - least[i])
                }
                false => [0.0; 3],
            };
            [0, 1, 2].map(|i| {
                // Before the transform and after it numbers are rounded, or cut off, which makes four times the square.
                let share = SHARES[i] * SHARES[i];
                let steps = square(&self.luma) + share * square(&self.chroma) + 4.0 * (2.0 + share);
                // In light a step is the more, the brighter: it is told from so many deviations.
                let by = DEVIATIONS * STEP * (steps / 12.0).sqrt();
                let encoded = linear_to_srgb(mean[at][i]);
                let light = (srgb_to_linear(encoded + by) - mean[at][i]) / DEVIATIONS;
                light * light + mixed[i] * mixed[i] / (4.0 * count)
            })
        };
        (0..mean.len()).map(pixel).collect()
    }
}

fn read_tables(mut segment: &[u8], tables: &mut [Table; 4]) -> Option<()> {
    while let Some((&head, rest)) = segment.split_first() {
        let size = if head >> 4 == 0 { 1 } else { 2 };
        let steps = rest.get(..64 * size)?.chunks_exact(size);
        let squares = steps.map(|step| {
            let step = step
                .iter()
                .fold(0, |sum, byte| 256 * sum + u32::from(*byte));
            f64::from(step) * f64::from(step)
        });
        let squares: Vec<f64> = squares.collect();
        *tables.get_mut(usize::from(head & 15))? = Table {
            first: squares[0],
            mean: squares.iter().sum::<f64>() / 64.0,
        };
        segment = &rest[64 * size..];
    }
    Some(())
}
