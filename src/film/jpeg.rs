//! Reads how strongly a JPEG file is compressed, and compresses other pictures in the same way.
//!
//! In: a file. Out: its quantization tables for luma (brightness) and chroma (colour), and its
//! chroma subsampling. The first table in the file is taken for luma and the second for chroma,
//! since programs usually write them in this order. If the file has a single table, it is used for
//! luma and chroma. A lossy WebP is treated as a JPEG with 2 × 2 subsampling and the quantization
//! step [`WEBP_STEP`].

use image::ImageFormat;
use jpeg_encoder::{
    ChromaSubsamplingMethod, ColorType, Encoder, QuantizationTableType, SamplingFactor,
};

/// Quantization step that is assumed for every coefficient of a lossy WebP, since its own steps are
/// not read. The value is a guess: about the typical step of a JPEG of quality 75.
const WEBP_STEP: u16 = 16;

/// The lossy compression of a JPEG file (ITU-T T.81).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jpeg {
    /// Quantization table of luma.
    pub luma: JpegTable,
    /// Quantization table of chroma.
    pub chroma: JpegTable,
    /// Chroma subsampling: the numbers of columns and of rows of pixels that share one chroma
    /// sample.
    pub shared: [u8; 2],
}

/// A quantization table: the steps of the 64 cosine coefficients of a block of 8 × 8 pixels. Each
/// coefficient is rounded to a multiple of its step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JpegTable {
    /// Square of the quantization step of a block's mean. A twelfth of this square is the variance
    /// of the mean's rounding error.
    pub first: f64,
    /// Mean of the squares of all 64 steps.
    pub mean: f64,
    /// The 64 quantization steps, row by row. The first one is that of the block's mean.
    pub steps: [u16; 64],
}

impl JpegTable {
    /// Makes a table from its steps in zigzag order, in which files contain them.
    fn new(zigzag: [u16; 64]) -> Self {
        let mut order: Vec<usize> = (0..64).collect();
        // Zigzag order follows the diagonals of the block, in alternating directions.
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
    /// Returns the compression of a JPEG, or an assumed one for a lossy WebP. Returns `None` for
    /// other files, and for a JPEG without quantization tables.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        if bytes.starts_with(b"RIFF") && bytes.windows(4).take(64).any(|name| name == b"VP8 ") {
            let table = JpegTable::new([WEBP_STEP; 64]);
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
                // For each channel, the frame header contains its number, its horizontal and
                // vertical sampling factors, and the number of its quantization table.
                0xc0..=0xc2 => {
                    let components = segment.get(6..)?.chunks_exact(3);
                    let factors: Vec<[u8; 2]> = components
                        .map(|component| [component[1] >> 4, component[1] & 15])
                        .collect();
                    if let [luma, chroma, ..] = factors[..] {
                        shared = [0, 1].map(|i| luma[i] / chroma[i].max(1));
                    }
                }
                // This marker precedes the compressed pixels, so all tables have been read.
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

    /// Compresses a picture with the quantization tables and the subsampling of this JPEG, and
    /// decodes the result. `bytes` contains the picture's red, green and blue bytes, row by row.
    /// Returns `None` if the encoder does not support the subsampling or the picture's size.
    pub fn coded(&self, bytes: &[u8], [width, height]: [u32; 2]) -> Option<Vec<u8>> {
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, 100);
        let table = |table: &JpegTable| {
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

/// Returns whether a JPEG has its end marker. If it is cut off, decoders fill the rest with gray,
/// which would look like a part of the picture.
pub fn is_whole(bytes: &[u8]) -> bool {
    /// Second byte of the marker before the compressed pixels (start of scan).
    const SCAN: u8 = 0xda;
    const END: u8 = 0xd9;
    // The position starts after the two bytes that begin every JPEG.
    let mut at = 2;
    loop {
        // In compressed pixels, a data byte of 255 is followed by 0, so this pair is not a marker.
        // The markers 0xd0 to 0xd7, at which a decoder can restart, are part of the compressed
        // pixels.
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

fn read_tables(mut segment: &[u8], tables: &mut [Option<JpegTable>; 4]) -> Option<()> {
    while let Some((&head, rest)) = segment.split_first() {
        let size = if head >> 4 == 0 { 1 } else { 2 };
        let steps = rest.get(..64 * size)?.chunks_exact(size);
        let step = |step: &[u8]| {
            step.iter()
                .fold(0, |sum, byte| 256 * sum + u16::from(*byte))
        };
        let steps: Vec<u16> = steps.map(step).collect();
        *tables.get_mut(usize::from(head & 15))? = Some(JpegTable::new(steps.try_into().ok()?));
        segment = &rest[64 * size..];
    }
    Some(())
}
