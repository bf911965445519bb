//! How a JPEG file is compressed, and what that does to another picture.
//!
//! In: a file. Out: its tables of luma and of chroma: the first two, as programs write them, or the
//! only one for both; and how many pixels share a number of chroma. A lossy WebP is taken for a
//! JPEG that shares them by fours, with steps that are large enough.

use image::ImageFormat;
use jpeg_encoder::{
    ChromaSubsamplingMethod, ColorType, Encoder, QuantizationTableType, SamplingFactor,
};

/// A step in a lossy WebP, all of which are taken for the same: that of a quality of about 75.
const WEBP_STEP: u16 = 16;

/// How a file is coded (ITU-T T.81).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jpeg {
    /// The steps of luma.
    pub luma: Table,
    /// The steps of chroma.
    pub chroma: Table,
    /// How many columns, and how many rows, share a number of chroma.
    pub shared: [u8; 2],
}

/// A table of steps, to whose multiples a block's coefficients are rounded; the first is that of
/// its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// The square of the first step.
    pub first: f64,
    /// The mean of the squares.
    pub mean: f64,
    /// The steps, row by row.
    pub steps: [u16; 64],
}

impl Table {
    /// Of the steps in the order of a file, from corner to corner.
    fn new(zigzag: [u16; 64]) -> Self {
        let mut order: Vec<usize> = (0..64).collect();
        // Diagonal by diagonal, every other one upwards.
        order.sort_by_key(|at| {
            let (x, y) = (at % 8, at / 8);
            (x + y, if (x + y) % 2 == 0 { x } else { y })
        });
        let mut steps = [0; 64];
        order
            .iter()
            .zip(zigzag)
            .for_each(|(at, step)| steps[*at] = step);
        let square = |step: &u16| f64::from(*step) * f64::from(*step);
        Self {
            first: square(&steps[0]),
            mean: steps.iter().map(square).sum::<f64>() / 64.0,
            steps,
        }
    }
}

impl Jpeg {
    /// How a file is coded, if it is a JPEG.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b"RIFF") && bytes.windows(4).take(64).any(|name| name == b"VP8 ") {
            let table = Table::new([WEBP_STEP; 64]);
            return Some(Self {
                luma: table,
                chroma: table,
                shared: [2, 2],
            });
        }
        let mut rest = bytes.strip_prefix(b"\xff\xd8")?;
        let mut tables = [None; 4];
        let mut shared = [1, 1];
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
                // The frame: of each component a number, how many of its numbers lie in a unit of
                // pixels, across and down, and its table.
                0xc0..=0xc2 => {
                    let components = segment.get(6..)?.chunks_exact(3);
                    let factors: Vec<[u8; 2]> = components
                        .map(|component| [component[1] >> 4, component[1] & 15])
                        .collect();
                    if let [luma, chroma, ..] = factors[..] {
                        shared = [0, 1].map(|i| luma[i] / chroma[i].max(1));
                    }
                }
                // What follows is the picture.
                0xda => {
                    let mut tables = tables.into_iter().flatten();
                    let luma = tables.next()?;
                    let chroma = tables.next().unwrap_or(luma);
                    return Some(Self {
                        luma,
                        chroma,
                        shared,
                    });
                }
                _ => {}
            }
            rest = rest.get(2 + length..)?;
        }
    }
}

/// Whether a JPEG goes on to the marker of its end: what decoders make of one that is cut off is
/// gray below the cut, and looks like a picture.
pub fn is_whole(bytes: &[u8]) -> bool {
    /// Comes before what is coded.
    const SCAN: u8 = 0xda;
    const END: u8 = 0xd9;
    // After the marker of its start.
    let mut at = 2;
    loop {
        // A byte of 255 in what is coded has a 0 behind it; those from 0xd0 to 0xd7 restart it.
        let is_marker = |pair: &[u8]| pair[0] == 0xff && !matches!(pair[1], 0 | 0xd0..=0xd7 | 0xff);
        let rest = bytes.get(at..).unwrap_or_default();
        let Some(found) = rest.windows(2).position(is_marker) else {
            return false;
        };
        at += found;
        match bytes[at + 1] {
            END => return true,
            SCAN => at += 2,
            _ => match bytes.get(at + 2..at + 4) {
                Some(&[high, low]) => at += 2 + usize::from(u16::from_be_bytes([high, low])),
                _ => return false,
            },
        }
    }
}

impl Jpeg {
    /// What becomes of a picture's bytes, red, green and blue in rows of a width, by this coding;
    /// none if it cannot be coded so.
    pub fn coded(&self, bytes: &[u8], [width, height]: [u32; 2]) -> Option<Vec<u8>> {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, 100);
        let table = |table: &Table| {
            QuantizationTableType::Custom(Box::new(table.steps.map(|step| step.max(1))))
        };
        encoder.set_quantization_tables(table(&self.luma), table(&self.chroma));
        let [across, down] = self.shared;
        encoder.set_sampling_factor(SamplingFactor::from_factors(across, down)?);
        encoder.set_chroma_subsampling_method(ChromaSubsamplingMethod::Average);
        let sides = [u16::try_from(width).ok()?, u16::try_from(height).ok()?];
        encoder
            .encode(bytes, sides[0], sides[1], ColorType::Rgb)
            .ok()?;
        let decoded = image::load_from_memory_with_format(&file, ImageFormat::Jpeg).ok()?;
        Some(decoded.into_rgb8().into_raw())
    }
}

fn read_tables(mut segment: &[u8], tables: &mut [Option<Table>; 4]) -> Option<()> {
    while let Some((&head, rest)) = segment.split_first() {
        let size = if head >> 4 == 0 { 1 } else { 2 };
        let steps = rest.get(..64 * size)?.chunks_exact(size);
        let step = |step: &[u8]| {
            step.iter()
                .fold(0, |sum, byte| 256 * sum + u16::from(*byte))
        };
        let steps: Vec<u16> = steps.map(step).collect();
        *tables.get_mut(usize::from(head & 15))? = Some(Table::new(steps.try_into().ok()?));
        segment = &rest[64 * size..];
    }
    Some(())
}
