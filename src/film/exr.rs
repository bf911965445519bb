//! OpenEXR: the linear means, rounded to 32-bit floats, in the channels R, G and B.
//!
//! The display window is the whole picture, and the data window the part of it that the file holds.

use std::io::{self, Cursor, Seek, Write};

use exr::{
    error::Error,
    image::{
        Encoding, Image, SpecificChannels,
        read::{
            image::ReadLayers, layers::ReadChannels, read as reader,
            specific_channels::ReadSpecificChannel,
        },
        write::WritableImage,
    },
    math::Vec2,
    meta::{
        MetaData,
        attribute::{Chromaticities, IntegerBounds, LineOrder, SampleType, Text},
        header::ImageAttributes,
    },
    prelude::{Blocks, Compression, LayerAttributes},
};

use super::{
    Film,
    picture::{Coding, Picture, Rounding, Unreadable, check_pixels},
};
use crate::area::Area;

/// Writes a part of a whole picture, or all of it.
pub fn write_exr(film: &Film, part: Area, whole: Area, out: impl Write + Seek) -> io::Result<()> {
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        // A picture has at most 2^20 columns and rows.
        let [r, g, b] = film.pixel(x as u32, y as u32);
        (r as f32, g as f32, b as f32)
    });
    let encoding = Encoding {
        // A block of 16 rows is in memory several times over, which for the widest pictures would be more than the film.
        compression: match film.width() {
            0..=0x1_0000 => Compression::ZIP16,
            _ => Compression::ZIP1,
        },
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (film.width() as usize, film.height() as usize);
    let mut image = Image::from_encoded_channels(size, encoding, channels);
    image.layer_data.attributes = LayerAttributes {
        layer_position: Vec2(part.x as i32, part.y as i32),
        software_name: Some(Text::from(concat!("pinhole ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    image.attributes = ImageAttributes {
        // Those of sRGB, which are also what a reader assumes where a file has none.
        chromaticities: Some(Chromaticities {
            red: Vec2(0.64, 0.33),
            green: Vec2(0.3, 0.6),
            blue: Vec2(0.15, 0.06),
            white: Vec2(0.3127, 0.329),
        }),
        ..ImageAttributes::new(IntegerBounds::from_dimensions((
            whole.width as usize,
            whole.height as usize,
        )))
    };
    // One block after the other, so that no more than one is in memory.
    image
        .write()
        .non_parallel()
        .to_unbuffered(out)
        .map_err(|error| match error {
            Error::Io(error) => error,
            other => io::Error::other(other),
        })
}

/// Reads a picture. It holds its colours as they are seen on black already, so an alpha is not looked at.
pub fn read(bytes: &[u8]) -> Result<Picture, Unreadable> {
    let meta = MetaData::read_from_buffered(bytes, false).map_err(damaged)?;
    let mut rounding = Rounding::Float;
    for header in &meta.headers {
        // Before anything is unpacked.
        let Vec2(width, height) = header.layer_size;
        let (width, height) = check_pixels(width as u64, height as u64)?;
        Film::<[f64; 3]>::new(width, height)?;
        let channels = &header.channels.list;
        if channels
            .iter()
            .any(|channel| channel.sample_type == SampleType::F16)
        {
            rounding = Rounding::Half;
        }
    }
    let image = reader()
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
        .map_err(damaged)?;
    let window = image.attributes.display_window;
    let corner = image.layer_data.attributes.layer_position - window.position;
    let film = image.layer_data.channel_data.pixels;
    let film = film.ok_or_else(|| damaged(Error::Aborted))?;
    let (width, height) = (film.width, film.height);
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
    Ok(Picture {
        film,
        rounding,
        coding: Coding::Exact,
        crop,
    })
}

fn damaged(error: Error) -> Unreadable {
    Unreadable::Damaged {
        format: "OpenEXR".to_owned(),
        cause: match error {
            Error::NotSupported(what) => format!("it uses what is not read here: {what}"),
            Error::Invalid(what) => what.into_owned(),
            Error::Io(error) => error.to_string(),
            Error::Aborted => "there is no memory for it".to_owned(),
        },
    }
}
