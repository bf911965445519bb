//! Picture files of any program become films.
//!
//! In: the bytes of a picture in any format that `image` reads here, or in OpenEXR. Out: linear means, how far the file's rounding
//! may have moved them, and what else its coding does to colours.
//!
//! Whole numbers count as sRGB, whatever a `gAMA` or a colour profile says: that is how the pictures of a scene are meant, and what
//! most programs write without saying so. Floats count as linear light. What is transparent is seen on black, mixed in linear light.

use std::{error::Error, io::Cursor};

use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use thiserror::Error;

use super::{Film, TooLarge, exr, read_recipe};
use crate::{area::Area, color::srgb_to_linear};

/// A picture with more pixels is not read: as a film they take 1.5 GiB.
const PIXELS: u64 = 1 << 26;

/// A picture as a file holds it.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Its means in linear light.
    pub film: Film,
    /// How its numbers are rounded.
    pub rounding: Rounding,
    /// What else its coding does to them.
    pub coding: Coding,
    /// The part of a whole picture that it is, if it says so.
    pub crop: Option<Area>,
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

/// What a file's coding does to colours besides rounding them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// Nothing.
    Exact,
    /// It changes them where that is hardly seen: JPEG, and one kind of WebP.
    Lossy,
    /// It replaces them by the nearest of at most 256: GIF.
    Palette,
}

impl Coding {
    /// What whoever compares such a picture should know.
    pub fn warning(self) -> Option<&'static str> {
        match self {
            Self::Exact => None,
            Self::Lossy => Some(
                "its coding is lossy and changes colours, most of all where they meet: a PNG keeps them",
            ),
            Self::Palette => Some("it has 256 colours at most: a PNG keeps all of them"),
        }
    }
}

/// Why a file is no picture.
#[derive(Debug, Error)]
pub enum Unreadable {
    /// It is none, or of a format that is not read.
    #[error(
        "it is no picture in PNG, OpenEXR, PNM, BMP, TIFF, WebP, GIF or JPEG, the formats that are read here{}",
        .0.map_or(String::new(), |format| format!(", but seems to be {}", name(format)))
    )]
    Format(Option<ImageFormat>),
    /// It does not follow its format, or uses a part of it that is not read here.
    #[error("it begins as {} file does, but is damaged or cut off: {cause}", with_article(.format))]
    Damaged {
        /// The format's name.
        format: String,
        /// What is wrong.
        cause: String,
    },
    /// It is larger than pictures that are read.
    #[error("it has {0} × {1} pixels, and pictures of more than 67108864 are not read")]
    Pixels(u64, u64),
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

fn name(format: ImageFormat) -> String {
    format!("{format:?}").to_uppercase()
}

fn with_article(name: &str) -> String {
    match name {
        "OpenEXR" => format!("an {name}"),
        _ => format!("a {name}"),
    }
}

/// Whether a file begins as a picture does, of a format that is read here or not.
pub fn is_picture(bytes: &[u8]) -> bool {
    format(bytes).is_some()
}

fn format(bytes: &[u8]) -> Option<ImageFormat> {
    let format = image::guess_format(bytes).ok()?;
    // The two letters of this format could be a name in a scene.
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    match format == ImageFormat::Pnm && bytes.get(2).is_some_and(is_word) {
        true => None,
        false => Some(format),
    }
}

/// Refuses sides that no picture has which is read here.
pub(super) fn check_pixels(width: u64, height: u64) -> Result<(u32, u32), Unreadable> {
    let sides = [width, height].map(u32::try_from);
    match (sides, width.checked_mul(height)) {
        ([Ok(columns), Ok(rows)], Some(1..=PIXELS)) => Ok((columns, rows)),
        _ => Err(Unreadable::Pixels(width, height)),
    }
}

/// Reads a picture.
pub fn read_picture(bytes: &[u8]) -> Result<Picture, Unreadable> {
    let picture = match format(bytes) {
        Some(ImageFormat::OpenExr) => exr::read(bytes)?,
        Some(format) if format.reading_enabled() => read(bytes, format)?,
        other => return Err(Unreadable::Format(other)),
    };
    let width = picture.film.width() as usize;
    let is_odd = |pixel: &[f64; 3]| pixel.iter().any(|light| !light.is_finite());
    if let Some(at) = picture.film.pixels.iter().position(is_odd) {
        let (x, y) = ((at % width) as u32, (at / width) as u32);
        return Err(Unreadable::NotFinite { x, y });
    }
    Ok(picture)
}

fn read(bytes: &[u8], format: ImageFormat) -> Result<Picture, Unreadable> {
    let damaged = |error: ImageError| Unreadable::Damaged {
        format: name(format),
        // Its own words name the format again.
        cause: error
            .source()
            .map_or_else(|| error.to_string(), ToString::to_string),
    };
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    // What a decoder may take: 512 MiB.
    reader.limits(Limits::default());
    let decoder = reader.into_decoder().map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    check_pixels(width.into(), height.into())?;
    let mut film = Film::new(width, height)?;
    let image = DynamicImage::from_decoder(decoder).map_err(damaged)?;

    let sample = image.color();
    let rounding = match sample.bytes_per_pixel() / sample.channel_count() {
        1 => Rounding::Byte,
        2 => Rounding::Word,
        _ => Rounding::Float,
    };
    match rounding {
        Rounding::Byte => {
            let table = table(u8::MAX.into());
            let part = |byte: u8| f64::from(byte) / f64::from(u8::MAX);
            fill(
                &mut film,
                &image.into_rgba8(),
                |byte| table[usize::from(byte)],
                part,
            );
        }
        Rounding::Word => {
            let table = table(u16::MAX);
            let part = |word: u16| f64::from(word) / f64::from(u16::MAX);
            fill(
                &mut film,
                &image.into_rgba16(),
                |word| table[usize::from(word)],
                part,
            );
        }
        _ => fill(&mut film, &image.into_rgba32f(), f64::from, f64::from),
    }
    let is_lossy = match format {
        ImageFormat::WebP => {
            image_webp::WebPDecoder::new(Cursor::new(bytes)).is_ok_and(|mut webp| webp.is_lossy())
        }
        format => format == ImageFormat::Jpeg,
    };
    Ok(Picture {
        film,
        rounding,
        coding: match format {
            _ if is_lossy => Coding::Lossy,
            ImageFormat::Gif => Coding::Palette,
            _ => Coding::Exact,
        },
        crop: read_recipe(bytes).ok().and_then(|recipe| recipe.crop),
    })
}

/// The light of each number of sRGB up to the last.
fn table(last: u16) -> Vec<f64> {
    let light = |k| srgb_to_linear(f64::from(k) / f64::from(last));
    (0..=last).map(light).collect()
}

/// Fills a film with samples of red, green, blue and opacity.
fn fill<T: Copy>(
    film: &mut Film,
    samples: &[T],
    light: impl Fn(T) -> f64,
    opacity: impl Fn(T) -> f64,
) {
    for (pixel, &[r, g, b, a]) in film.pixels.iter_mut().zip(samples.as_chunks().0) {
        *pixel = [r, g, b].map(|sample| light(sample) * opacity(a));
    }
}
