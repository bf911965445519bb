//! Reads picture files of any program.
//!
//! In: the bytes of a picture in PNG, OpenEXR, or another format that the crate `image` reads. Out:
//! pixels in linear light, the precision of the file's numbers, and how the format changes colours.
//!
//! Whole numbers are read as sRGB, even if a PNG declares another curve: a picture of a scene
//! should be in sRGB, and most programs declare no curve. Floats are read as linear light.
//! Transparent pixels are mixed with black in linear light.

use std::{error::Error, io::Cursor};

use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader};
use png::{BitDepth, ColorType, DecodingError, Transformations};

use super::{
    jpeg,
    memory::{self, TooLarge},
    no_picture,
    picture::{Coding, Opacity, Picture, Rounding},
    pixels::Film,
    png::read_recipe,
    pnm, read_exr,
    unreadable::{DECODED_LIMIT, Unreadable, check_size, name},
};
use crate::color::srgb_to_linear;

/// Maximum number of bytes that the PNG decoder may allocate in addition to the picture. A picture
/// that needs more is rejected. The limit is the default of the crate `image`. Usual files need far
/// less.
const UNPACKING: usize = 512 << 20;

/// Returns whether a file begins like a picture of a known format, which need not be supported.
pub fn is_picture(bytes: &[u8]) -> bool {
    pnm::start(bytes).is_some() || format(bytes).is_some()
}

/// Returns whether a PNM picture begins after lines of text, within the first 64 KiB of a file.
pub fn is_picture_behind_lines(bytes: &[u8]) -> bool {
    pnm::after_lines(bytes).is_some()
}

fn format(bytes: &[u8]) -> Option<ImageFormat> {
    let format = image::guess_format(bytes).ok()?;
    // A scene's text may begin with a name whose first characters are those of a PNM, for example
    // `P3`. In a PNM, white space or a comment follows these two characters.
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    if format == ImageFormat::Pnm && bytes.get(2).is_some_and(is_word) {
        return None;
    }
    Some(format)
}

/// Reads a picture of at most [`DECODED_LIMIT`] decoded bytes.
///
/// # Errors
///
/// The file is not a picture that can be read.
pub fn read_picture(bytes: &[u8]) -> Result<Picture, Unreadable> {
    read_picture_up_to(bytes, DECODED_LIMIT)
}

/// Reads a picture of at most `limit` decoded bytes. Before decoding, the size in the file's header
/// and the available memory are checked.
///
/// # Errors
///
/// The file is not a picture that can be read.
pub fn read_picture_up_to(bytes: &[u8], limit: u64) -> Result<Picture, Unreadable> {
    let picture = match format(bytes) {
        Some(ImageFormat::OpenExr) => read_exr::read(bytes, limit)?,
        Some(ImageFormat::Png) => read_png(bytes, limit)?,
        Some(ImageFormat::Pnm) if !bytes.starts_with(b"P7") => pnm::read(bytes, limit)?,
        Some(format) if format.reading_enabled() => read(bytes, format, limit)?,
        // `format` does not recognise a PNM in UTF-16, or a PNM after a byte order mark or lines of
        // text. These kinds of PNM are tried last.
        None => pnm::read(bytes, limit).map_err(|error| match (error, no_picture::of(bytes)) {
            (Unreadable::Format(None), Some(what)) => Unreadable::Other(what),
            (error, _) => error,
        })?,
        other => return Err(Unreadable::Format(other.map(name))),
    };
    let width = picture.film.width() as usize;
    let is_odd = |pixel: &[f64; 3]| pixel.iter().any(|light| !light.is_finite());
    if let Some(at) = picture.film.pixels().iter().position(is_odd) {
        let (x, y) = ((at % width) as u32, (at / width) as u32);
        return Err(Unreadable::NotFinite { x, y });
    }
    Ok(picture)
}

fn read(bytes: &[u8], format: ImageFormat, limit: u64) -> Result<Picture, Unreadable> {
    let unreadable = |error| unreadable(&error, format);
    if format == ImageFormat::Jpeg && !jpeg::is_whole(bytes) {
        return Err(Unreadable::Damaged {
            format: name(format),
            cause: "its end is missing".to_owned(),
        });
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    if limit > DECODED_LIMIT {
        // The decoder's own limit is removed. The available memory is checked below instead.
        reader.no_limits();
    }
    let decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    let color = decoder.color_type();
    let channel = color.bytes_per_pixel() / color.channel_count();
    check_size([width.into(), height.into()], channel.into(), limit)?;
    let rounding = match channel {
        1 => Rounding::Byte,
        2 => Rounding::Word,
        _ => Rounding::Float,
    };
    // `whole` is the number of bytes for each pixel in three copies of the picture: the decoded
    // one, one with four channels, and the film.
    let channels = match rounding {
        Rounding::Float => size_of::<[f32; 4]>(),
        _ => size_of::<[u16; 4]>(),
    };
    let whole = usize::from(color.bytes_per_pixel()) + channels + size_of::<[f64; 3]>();
    memory::check(width, height, whole as u64)?;
    let mut film = Film::new(width, height)?;
    let image = DynamicImage::from_decoder(decoder).map_err(unreadable)?;
    let opacity = match rounding {
        Rounding::Float => fill(&mut film, &image.into_rgba32f(), f64::from, f64::from),
        // The library converts bytes to 16-bit numbers: a byte k becomes 257 · k. This is the same
        // fraction of the range, since 65535 = 257 · 255. So bytes and 16-bit numbers share one
        // table of linear light.
        _ => {
            let light = light_of_words();
            let light = |word: u16| light[usize::from(word)];
            fill(&mut film, &image.into_rgba16(), light, part)
        }
    };
    let is_lossy = match format {
        ImageFormat::WebP => {
            image_webp::WebPDecoder::new(Cursor::new(bytes)).is_ok_and(|mut webp| webp.is_lossy())
        }
        format => format == ImageFormat::Jpeg,
    };
    Ok(Picture {
        digest: None,
        film,
        rounding,
        coding: match format {
            _ if is_lossy => Coding::Lossy,
            ImageFormat::Gif => Coding::Palette,
            _ => Coding::Exact,
        },
        crop: None,
        size: None,
        opacity: opacity?,
    })
}

fn read_png(bytes: &[u8], limit: u64) -> Result<Picture, Unreadable> {
    let unreadable = |error| match error {
        DecodingError::LimitsExceeded => Unreadable::Unpacking,
        error => Unreadable::Damaged {
            format: name(ImageFormat::Png),
            cause: error.to_string(),
        },
    };
    let limits = png::Limits { bytes: UNPACKING };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    // With these settings, the decoder returns 8-bit or 16-bit numbers of gray and opacity, or of
    // red, green, blue and opacity.
    decoder.set_transformations(Transformations::EXPAND | Transformations::ALPHA);
    let header = decoder.read_header_info().map_err(unreadable)?;
    let (width, height) = (header.width, header.height);
    let channel = match header.bit_depth {
        BitDepth::Sixteen => 2,
        _ => 1,
    };
    check_size([width.into(), height.into()], channel, limit)?;
    let mut reader = decoder.read_info().map_err(unreadable)?;
    let (color, depth) = reader.output_color_type();
    let (rounding, length) = match depth {
        BitDepth::Sixteen => (Rounding::Word, 2),
        _ => (Rounding::Byte, 1),
    };
    let places = match color {
        ColorType::GrayscaleAlpha => [0, 0, 0, 1],
        _ => [0, 1, 2, 3],
    };
    let channels = color.samples();
    let whole = channels * length + size_of::<[f64; 3]>();
    memory::check(width, height, whole as u64)?;
    let mut film = Film::new(width, height)?;
    let mut samples = vec![0; film.pixels().len() * channels * length];
    reader.next_frame(&mut samples).map_err(unreadable)?;
    let light = light_of_words();
    let word = |index: usize| match rounding {
        Rounding::Word => u16::from_be_bytes([samples[2 * index], samples[2 * index + 1]]),
        // A byte k becomes the 16-bit number 257 · k. This is the same fraction of the range, since
        // 65535 = 257 · 255. So bytes and 16-bit numbers share one table of linear light.
        _ => 257 * u16::from(samples[index]),
    };
    let count = film.pixels().len();
    let pixels = (0..count).map(|index| places.map(|place| word(channels * index + place)));
    let opacity = mix(&mut film, pixels, |word| light[usize::from(word)], part)?;
    let recipe = read_recipe(bytes).ok();
    Ok(Picture {
        digest: None,
        film,
        rounding,
        coding: if says_other_curve(reader.info()) {
            Coding::OtherCurve
        } else {
            Coding::Exact
        },
        crop: recipe.as_ref().and_then(|recipe| recipe.crop),
        size: recipe.and_then(|recipe| recipe.size),
        opacity,
    })
}

/// Returns whether a PNG declares a brightness curve other than sRGB's. Its colour profile (`iCCP`)
/// takes precedence over the chunk `sRGB`, which takes precedence over `gAMA`.
fn says_other_curve(info: &png::Info) -> bool {
    match (&info.icc_profile, info.srgb, info.gama_chunk) {
        (Some(profile), ..) => is_other_profile(profile).unwrap_or(false),
        (None, None, Some(gamma)) => (gamma.into_value() - 1.0 / 2.2).abs() > 0.01,
        _ => false,
    }
}

/// Returns whether the brightness curve of the red channel (or of gray) in an ICC profile is far
/// from sRGB's. The format is in ICC.1:2010, sections 10.5 and 10.15. Returns `None` if the profile
/// has no such curve.
fn is_other_profile(profile: &[u8]) -> Option<bool> {
    let number = |at: usize| Some(u32::from_be_bytes(*profile.get(at..)?.first_chunk()?));
    let count = number(128)?.min(100) as usize;
    // An entry of the profile's table has 12 bytes: name, position and length.
    let tag = (0..count)
        .map(|index| 132 + 12 * index)
        .find(|&at| matches!(profile.get(at..at + 4), Some(b"rTRC" | b"kTRC")))?;
    let at = number(tag + 4)? as usize;
    let word = |at: usize| Some(u16::from_be_bytes(*profile.get(at..)?.first_chunk()?));
    let fixed = |index: usize| Some(f64::from(number(at + 12 + 4 * index)? as i32) / 65536.0);
    // Each curve is evaluated only at the encoded value 1/2, and compared with sRGB's linear light
    // there, 0.2140. A gamma of 2.2 gives 0.2176, which is near enough.
    let light = match (profile.get(at..at + 4)?, number(at + 8)?) {
        (b"curv", 0) => 0.5,
        (b"curv", 1) => libm::pow(0.5, f64::from(word(at + 12)?) / 256.0),
        (b"curv", count) => f64::from(word(at + 12 + 2 * (count as usize / 2))?) / 65535.0,
        (b"para", 0) => libm::pow(0.5, fixed(0)?),
        // Parametric curves of the types 1 to 4 are (a·x + b)^g at the encoded value x = 1/2, where
        // a, b and g are their parameters. Types 2 and 4 add a constant, which is neglected.
        (b"para", _) => libm::pow(0.5 * fixed(1)? + fixed(2)?, fixed(0)?),
        _ => return None,
    };
    Some((light - srgb_to_linear(0.5)).abs() > 0.01)
}

/// Converts a 16-bit number to a fraction from 0 to 1.
fn part(word: u16) -> f64 {
    f64::from(word) / f64::from(u16::MAX)
}

/// Returns a table of the linear light of every 16-bit number in sRGB.
fn light_of_words() -> Vec<f64> {
    let words = 0..=u16::MAX;
    words.map(|word| srgb_to_linear(part(word))).collect()
}

/// Fills a film from a flat list of numbers: red, green, blue and opacity of each pixel. Mixes the
/// colours with black according to the opacity. Returns the opacity, or `None` if all pixels are
/// opaque.
fn fill<T: Copy>(
    film: &mut Film,
    samples: &[T],
    light: impl Fn(T) -> f64,
    opacity: impl Fn(T) -> f64,
) -> Result<Option<Opacity>, TooLarge> {
    mix(film, samples.as_chunks().0.iter().copied(), light, opacity)
}

/// Fills a film from pixels of red, green, blue and opacity. Mixes the colours with black according
/// to the opacity. Returns the opacity, or `None` if all pixels are opaque. Fails if there is not
/// enough memory.
fn mix<T: Copy>(
    film: &mut Film,
    pixels: impl Iterator<Item = [T; 4]>,
    light: impl Fn(T) -> f64,
    opacity: impl Fn(T) -> f64,
) -> Result<Option<Opacity>, TooLarge> {
    let mut opaque: Option<Opacity> = None;
    for (at, [r, g, b, a]) in pixels.enumerate() {
        let (light, part) = ([r, g, b].map(&light), opacity(a));
        if part < 1.0 && opaque.is_none() {
            let (width, height) = (film.width(), film.height());
            memory::check(width, height, size_of::<[f64; 3]>() as u64)?;
            let before = if at == 0 { part } else { 1.0 };
            opaque = Some(Opacity {
                range: [part, before],
                film: film.clone(),
            });
        }
        if let Some(opaque) = &mut opaque {
            let [least, most] = opaque.range;
            opaque.range = [least.min(part), most.max(part)];
            opaque.film.pixels_mut()[at] = light;
        }
        film.pixels_mut()[at] = light.map(|light| light * part);
    }
    Ok(opaque)
}

fn unreadable(error: &ImageError, format: ImageFormat) -> Unreadable {
    let format = name(format);
    // The text of the error would repeat the format's name, so the text of the error's cause is
    // used.
    let cause = error
        .source()
        .map_or_else(|| error.to_string(), ToString::to_string);
    match error {
        ImageError::Limits(_) => Unreadable::Unpacking,
        ImageError::Unsupported(_) => Unreadable::Unsupported { format, cause },
        _ => Unreadable::Damaged { format, cause },
    }
}
