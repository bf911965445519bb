//! Picture files of any program become films.
//!
//! In: the bytes of a picture in any format that `image` reads here, or in OpenEXR. Out: linear means, how far the file's rounding
//! may have moved them, and what else its coding does to colours.
//!
//! Whole numbers count as sRGB, whatever a `gAMA` or a colour profile says: that is how the pictures of a scene are meant, and what
//! most programs write without saying so. Floats count as linear light. What is transparent is seen on black, mixed in linear light.

use std::{error::Error, io::Cursor};

use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::{
    Film, exr,
    picture::{Coding, Picture, Rounding, Unreadable, check_pixels, name},
    read_recipe,
};
use crate::color::srgb_to_linear;

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
