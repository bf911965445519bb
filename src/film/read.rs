//! Picture files of any program become films.
//!
//! In: the bytes of a PNG (any colour type and depth) or of an OpenEXR file with the channels R, G and B. Out: linear means, and how far
//! the file's rounding may have moved them.
//!
//! The numbers of a PNG count as sRGB, whatever its `gAMA` or colour profile say: that is how the pictures of a scene are meant, and
//! what most programs write without saying so. What is transparent is seen on black, mixed in linear light; an EXR holds its colours in
//! that way already, so its alpha is not looked at.

use std::io::Cursor;

use exr::{
    error::Error,
    image::read::{
        image::ReadLayers, layers::ReadChannels, read, specific_channels::ReadSpecificChannel,
    },
    math::Vec2,
    meta::{MetaData, attribute::SampleType},
};
use png::{BitDepth, ColorType, DecodeOptions, Decoder, Limits, Transformations};
use thiserror::Error;

use super::{Film, SIGNATURE, TooLarge, memory};
use crate::color::srgb_to_linear;

/// The first bytes of every OpenEXR file.
const EXR_SIGNATURE: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// A side of a picture is at most so long, as in the language.
const SIDE_LIMIT: usize = 1 << 20;

/// What other formats begin with, for messages.
const FOREIGN: [(&[u8], &str); 8] = [
    (b"\xff\xd8\xff", "JPEG"),
    (b"GIF8", "GIF"),
    (b"BM", "BMP"),
    (b"RIFF", "WebP"),
    (b"II*\0", "TIFF"),
    (b"MM\0*", "TIFF"),
    (b"#?RADIANCE", "Radiance HDR"),
    (b"\x00\x00\x00\x0cjP", "JPEG 2000"),
];

/// A picture as a file holds it.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Its means in linear light.
    pub film: Film,
    /// How its numbers are rounded.
    pub rounding: Rounding,
}

/// What the numbers of a file are rounded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// Bytes of sRGB, or fewer bits.
    Byte,
    /// 16 bits of sRGB.
    Word,
    /// Floats of 16 bits, in linear light.
    Half,
    /// Floats of 32 bits, in linear light.
    Float,
}

impl Rounding {
    /// How far it may move a number between 0 and 1, in steps of 8-bit sRGB; a step is 1/255 of the way from black to white.
    ///
    /// The floats' part is their relative rounding 2^−11 or 2^−24 of the light, times the 255 · 1.055/2.4 steps of a unit of light at
    /// white, where that product is greatest, rounded up.
    pub fn steps(self) -> f64 {
        match self {
            Self::Byte => 0.5,
            Self::Word => 0.5 / 257.0,
            Self::Half => 0.06,
            Self::Float => 1e-5,
        }
    }
}

/// Why a file is no picture.
#[derive(Debug, Error)]
pub enum Unreadable {
    /// It is none, or of another format.
    #[error("it is no picture in PNG or OpenEXR, the formats that are read here{}", foreign(.0))]
    Format(Option<&'static str>),
    /// A PNG that does not follow the format.
    #[error("it begins as a PNG does, but is damaged or cut off: {0}")]
    Png(png::DecodingError),
    /// An EXR that does not follow the format, or uses a part of it that is not read here.
    #[error("it begins as an OpenEXR file does, but {0}")]
    Exr(String),
    /// It says to have sides of an absurd length.
    #[error("it has {0} × {1} pixels, and a side may have 1048576 at most")]
    Sides(usize, usize),
    /// There is no memory for it.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// A value is infinite or NaN.
    #[error("its pixel ({x}, {y}) holds a value that is no finite number")]
    NotFinite {
        /// The column.
        x: u32,
        /// The row.
        y: u32,
    },
}

fn foreign(format: &Option<&'static str>) -> String {
    format.map_or(String::new(), |format| {
        format!(", but seems to be {format}")
    })
}

/// Whether a file begins as a picture does, of this program's formats or another's.
pub fn is_picture(bytes: &[u8]) -> bool {
    bytes.starts_with(&SIGNATURE) || bytes.starts_with(&EXR_SIGNATURE) || format(bytes).is_some()
}

fn format(bytes: &[u8]) -> Option<&'static str> {
    let found = FOREIGN.iter().find(|(start, _)| bytes.starts_with(start))?;
    Some(found.1)
}

/// Reads a picture.
pub fn read_picture(bytes: &[u8]) -> Result<Picture, Unreadable> {
    let picture = if bytes.starts_with(&SIGNATURE) {
        read_png(bytes)?
    } else if bytes.starts_with(&EXR_SIGNATURE) {
        read_exr(bytes)?
    } else {
        return Err(Unreadable::Format(format(bytes)));
    };
    let width = picture.film.width() as usize;
    let is_odd = |pixel: &[f64; 3]| pixel.iter().any(|light| !light.is_finite());
    if let Some(at) = picture.film.pixels.iter().position(is_odd) {
        let (x, y) = ((at % width) as u32, (at / width) as u32);
        return Err(Unreadable::NotFinite { x, y });
    }
    Ok(picture)
}

fn read_png(bytes: &[u8]) -> Result<Picture, Unreadable> {
    let mut options = DecodeOptions::default();
    options.set_ignore_text_chunk(true);
    options.set_ignore_iccp_chunk(true);
    let mut decoder = Decoder::new_with_options(Cursor::new(bytes), options);
    decoder.set_limits(Limits { bytes: 64 << 20 });
    // Palettes become colours, few bits 8, and a transparent colour becomes an alpha.
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(Unreadable::Png)?;
    let (width, height) = reader.info().size();
    check_sides(width as usize, height as usize)?;
    let is_interlaced = reader.info().interlaced;
    let (color, depth) = reader.output_color_type();
    let mut film = Film::new(width, height)?;

    let row_bytes = reader.output_line_size(width).unwrap_or(0);
    let light = Light::new(color, depth);
    if is_interlaced {
        // Its rows come in pieces, so it is unpacked as a whole: a third of the film's size at most.
        let size = reader.output_buffer_size().unwrap_or(0);
        let mut whole = Vec::new();
        whole.try_reserve_exact(size).map_err(|_| TooLarge {
            width,
            height,
            needed: size as u64,
            available: None,
        })?;
        whole.resize(size, 0);
        reader.next_frame(&mut whole).map_err(Unreadable::Png)?;
        let rows = film.pixels.chunks_exact_mut(width as usize);
        for (row, bytes) in rows.zip(whole.chunks_exact(row_bytes)) {
            light.put(bytes, row);
        }
    } else {
        for row in film.pixels.chunks_exact_mut(width as usize) {
            match reader.next_row().map_err(Unreadable::Png)? {
                Some(bytes) => light.put(bytes.data(), row),
                None => return Err(cut_off()),
            }
        }
    }
    reader.finish().map_err(Unreadable::Png)?;
    let rounding = match depth {
        BitDepth::Sixteen => Rounding::Word,
        _ => Rounding::Byte,
    };
    Ok(Picture { film, rounding })
}

fn cut_off() -> Unreadable {
    Unreadable::Png(png::DecodingError::IoError(
        std::io::ErrorKind::UnexpectedEof.into(),
    ))
}

fn check_sides(width: usize, height: usize) -> Result<(), Unreadable> {
    if width.max(height) > SIDE_LIMIT || width.min(height) == 0 {
        return Err(Unreadable::Sides(width, height));
    }
    Ok(())
}

/// From the samples of a PNG to linear light.
struct Light {
    channels: usize,
    is_wide: bool,
    /// The light of each number of 8 or 16 bits.
    table: Vec<f64>,
}

impl Light {
    fn new(color: ColorType, depth: BitDepth) -> Self {
        let is_wide = depth == BitDepth::Sixteen;
        let last = if is_wide { 65535u32 } else { 255 };
        let table = (0..=last).map(|k| srgb_to_linear(f64::from(k) / f64::from(last)));
        Self {
            channels: color.samples(),
            is_wide,
            table: table.collect(),
        }
    }

    fn put(&self, bytes: &[u8], row: &mut [[f64; 3]]) {
        let size = self.channels * if self.is_wide { 2 } else { 1 };
        for (pixel, bytes) in row.iter_mut().zip(bytes.chunks_exact(size)) {
            let sample = |channel: usize| match self.is_wide {
                true => usize::from(u16::from_be_bytes([
                    bytes[2 * channel],
                    bytes[2 * channel + 1],
                ])),
                false => usize::from(bytes[channel]),
            };
            let light = |channel: usize| self.table[sample(channel)];
            let alpha = |channel: usize| sample(channel) as f64 / (self.table.len() - 1) as f64;
            *pixel = match self.channels {
                1 => [light(0); 3],
                2 => [light(0) * alpha(1); 3],
                3 => [0, 1, 2].map(light),
                _ => [0, 1, 2].map(|channel| light(channel) * alpha(3)),
            };
        }
    }
}

fn read_exr(bytes: &[u8]) -> Result<Picture, Unreadable> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(exr_error)?;
    let mut rounding = Rounding::Float;
    for header in &meta.headers {
        // Before anything is unpacked.
        let Vec2(width, height) = header.layer_size;
        check_sides(width, height)?;
        memory::reserve::<[f64; 3]>(&mut Vec::new(), width as u32, height as u32)?;
        let channels = &header.channels.list;
        if channels
            .iter()
            .any(|channel| channel.sample_type == SampleType::F16)
        {
            rounding = Rounding::Half;
        }
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required("R")
        .required("G")
        .required("B")
        .collect_pixels(
            |Vec2(width, height), _| Film::new(width as u32, height as u32).ok(),
            |film: &mut Option<Film>, Vec2(x, y), (r, g, b): (f32, f32, f32)| {
                if let Some(film) = film {
                    film.pixels[y * film.width as usize + x] = [r, g, b].map(f64::from);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(exr_error)?;
    let film = image.layer_data.channel_data.pixels;
    let film = film.ok_or_else(|| Unreadable::Exr("there is no memory for it".to_owned()))?;
    Ok(Picture { film, rounding })
}

fn exr_error(error: Error) -> Unreadable {
    Unreadable::Exr(match error {
        Error::NotSupported(what) => format!("uses what is not read here: {what}"),
        Error::Invalid(what) => {
            format!("is damaged, cut off or without channels R, G and B: {what}")
        }
        Error::Io(error) => format!("is damaged or cut off: {error}"),
        Error::Aborted => "reading it was given up".to_owned(),
    })
}
