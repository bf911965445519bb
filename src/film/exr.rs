//! OpenEXR: the linear means, rounded to 32-bit floats, in the channels R, G and B.
//!
//! The display window is the whole picture, and the data window the part of it that the file holds.

use std::{
    io::{self, Cursor, Seek, SeekFrom, Write},
    ops::Range,
};

use exr::{
    error::Error,
    image::read::{image::ReadLayers, layers::ReadChannels, read as reader},
    math::Vec2,
    meta::{
        MetaData,
        attribute::{ChannelDescription, SampleType},
    },
};

use super::{
    memory::TooLarge,
    picture::{Coding, Picture, Rounding, Unreadable, check_pixels},
    pixels::Film,
};
use crate::area::Area;

/// Writes a part of a whole picture, or all of it. The crate `exr` would bring its other compressions, and their tables, into the engine that browsers load.
pub fn write_exr(
    film: &Film,
    part: Area,
    whole: Area,
    mut out: impl Write + Seek,
) -> io::Result<()> {
    // A block is in memory several times over, which of 16 rows would be more than the film for the widest pictures.
    let (rows, compression) = match film.width() {
        0..=0x1_0000 => (16, ZIP16),
        _ => (1, ZIP1),
    };
    let starts = || (0..film.height()).step_by(rows as usize);
    let blocks = starts().len();
    out.write_all(&header(part, whole, compression, blocks as u32))?;
    let table = out.stream_position()?;
    let mut places = Vec::with_capacity(8 * blocks);
    out.write_all(&vec![0; 8 * blocks])?;
    for start in starts() {
        places.extend(out.stream_position()?.to_le_bytes());
        let plain = block(film, start..film.height().min(start + rows));
        let packed = packed(&plain);
        let content = match packed.len() < plain.len() {
            true => packed,
            false => plain,
        };
        out.write_all(&(part.y + start).to_le_bytes())?;
        out.write_all(&(content.len() as u32).to_le_bytes())?;
        out.write_all(&content)?;
    }
    let end = out.stream_position()?;
    out.seek(SeekFrom::Start(table))?;
    out.write_all(&places)?;
    out.seek(SeekFrom::Start(end))?;
    Ok(())
}

/// Compression by zlib, of one row or of sixteen.
const ZIP1: u8 = 2;
const ZIP16: u8 = 3;

/// Where red, green, blue and white lie: those of sRGB, which are also what a reader assumes where a file has none.
const CHROMATICITIES: [f32; 8] = [0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329];

/// What stands before the table of blocks: the attributes, each with a name, a type, a length and a value.
fn header(part: Area, whole: Area, compression: u8, blocks: u32) -> Vec<u8> {
    // Magic number, and version 2 without flags.
    let mut header = b"v/1\x01\x02\0\0\0".to_vec();
    let mut attribute = |name: &str, kind: &str, value: &[u8]| {
        for word in [name, kind] {
            header.extend(word.as_bytes());
            header.push(0);
        }
        header.extend((value.len() as u32).to_le_bytes());
        header.extend(value);
    };
    // 32-bit floats that are linear, one for each pixel.
    let channel = |name: u8| [&[name, 0][..], &numbers([2, 0, 1, 1])].concat();
    let channels = [channel(b'B'), channel(b'G'), channel(b'R'), vec![0]].concat();
    let window = |area: Area, x, y| numbers([x, y, x + area.width - 1, y + area.height - 1]);
    let floats = |floats: &[f32]| {
        floats
            .iter()
            .flat_map(|it| it.to_le_bytes())
            .collect::<Vec<_>>()
    };
    let software = concat!("pinhole ", env!("CARGO_PKG_VERSION"));
    attribute("chunkCount", "int", &blocks.to_le_bytes());
    attribute("channels", "chlist", &channels);
    attribute("compression", "compression", &[compression]);
    // From the top down.
    attribute("lineOrder", "lineOrder", &[0]);
    attribute("displayWindow", "box2i", &window(whole, 0, 0));
    attribute("pixelAspectRatio", "float", &floats(&[1.0]));
    attribute("screenWindowCenter", "v2f", &floats(&[0.0, 0.0]));
    attribute("screenWindowWidth", "float", &floats(&[1.0]));
    attribute("dataWindow", "box2i", &window(part, part.x, part.y));
    attribute("type", "string", b"scanlineimage");
    attribute("chromaticities", "chromaticities", &floats(&CHROMATICITIES));
    attribute("software", "string", software.as_bytes());
    header.push(0);
    header
}

fn numbers(numbers: [u32; 4]) -> Vec<u8> {
    numbers.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Some rows, each as all its blue, its green and its red.
fn block(film: &Film, rows: Range<u32>) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(rows.len() * film.width() as usize * 12);
    for y in rows {
        for channel in [2, 1, 0] {
            for x in 0..film.width() {
                bytes.extend((film.pixel(x, y)[channel] as f32).to_le_bytes());
            }
        }
    }
    bytes
}

/// The bytes as the format packs them: those at even places before those at odd ones, each as the difference from the one before it, and then by zlib.
fn packed(bytes: &[u8]) -> Vec<u8> {
    let places = |first| bytes.iter().skip(first).step_by(2).copied();
    let mut before = 128_u8;
    let differences = places(0).chain(places(1)).map(|byte| {
        let difference = byte.wrapping_sub(before).wrapping_add(128);
        before = byte;
        difference
    });
    miniz_oxide::deflate::compress_to_vec_zlib(&differences.collect::<Vec<_>>(), 4)
}

/// Reads a picture. It holds its colours as they are seen on black already, so an alpha is not looked at.
pub fn read(bytes: &[u8]) -> Result<Picture, Unreadable> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(unreadable)?;
    for header in &meta.headers {
        // Before anything is unpacked.
        let Vec2(width, height) = header.layer_size;
        check_pixels(width as u64, height as u64)?;
    }
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |Vec2(width, height), _| Film::new(width as u32, height as u32),
            |film: &mut Result<Film, TooLarge>, Vec2(x, y), (r, g, b): (f32, f32, f32)| {
                if let Ok(film) = film {
                    let at = y * film.width() as usize + x;
                    film.pixels_mut()[at] = [r, g, b].map(f64::from);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(unreadable)?;
    let window = image.attributes.display_window;
    let corner = image.layer_data.attributes.layer_position - window.position;
    let channels = image.layer_data.channel_data;
    let (red, green, blue) = channels.channels;
    let film = channels.pixels?;
    let (width, height) = (film.width(), film.height());
    let is_whole = corner == Vec2(0, 0) && window.size == Vec2(width as usize, height as usize);
    let crop = match (corner.0.try_into(), corner.1.try_into()) {
        (Ok(x), Ok(y)) if !is_whole => Some(Area {
            x,
            y,
            width,
            height,
        }),
        _ => None,
    };
    let is_half = |channel: &ChannelDescription| channel.sample_type == SampleType::F16;
    Ok(Picture {
        film,
        rounding: match [red, green, blue].iter().any(is_half) {
            true => Rounding::Half,
            false => Rounding::Float,
        },
        coding: Coding::Exact,
        crop,
    })
}

fn unreadable(error: Error) -> Unreadable {
    let format = "OpenEXR".to_owned();
    match error {
        Error::NotSupported(what) => Unreadable::Unsupported {
            format,
            cause: what.into_owned(),
        },
        Error::Invalid(what) => Unreadable::Damaged {
            format,
            cause: what.into_owned(),
        },
        other => Unreadable::Damaged {
            format,
            cause: other.to_string(),
        },
    }
}
