//! OpenEXR files: pixels' means in linear light, as 32-bit floats in the channels R, G and B.
//!
//! The format's display window is the area of the whole picture. Its data window is the part that
//! the file contains.

use std::{
    collections::BTreeSet,
    io::{self, Cursor},
};

use exr::{
    block,
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
        attribute::{
            ChannelDescription, Chromaticities, IntegerBounds, LineOrder, SampleType, Text,
        },
        header::{Header, ImageAttributes},
    },
    prelude::{Blocks, Compression, LayerAttributes},
};

use super::{
    memory::TooLarge,
    picture::{Coding, Picture, Rounding, Unreadable, check_size},
    pixels::Film,
};
use crate::{area::Area, files::Sink};

/// A picture in memory, in linear light, with 64-bit or 32-bit floats.
#[derive(Clone, Copy, Debug)]
pub enum LinearFilm<'a> {
    /// Pixels with 64-bit floats.
    Means(&'a Film),
    /// Pixels with 32-bit floats.
    Floats(&'a Film<[f32; 3]>),
}

impl<'a> From<&'a Film> for LinearFilm<'a> {
    fn from(film: &'a Film) -> Self {
        Self::Means(film)
    }
}

impl<'a> From<&'a Film<[f32; 3]>> for LinearFilm<'a> {
    fn from(film: &'a Film<[f32; 3]>) -> Self {
        Self::Floats(film)
    }
}

impl LinearFilm<'_> {
    fn width(self) -> u32 {
        match self {
            Self::Means(film) => film.width(),
            Self::Floats(film) => film.width(),
        }
    }

    fn height(self) -> u32 {
        match self {
            Self::Means(film) => film.height(),
            Self::Floats(film) => film.height(),
        }
    }

    fn pixel(self, x: u32, y: u32) -> [f32; 3] {
        match self {
            Self::Means(film) => film.pixel(x, y).map(|mean| mean as f32),
            Self::Floats(film) => film.pixel(x, y),
        }
    }
}

/// Writes `film` as an OpenEXR file. The film shows the area `part` of a picture with the area
/// `whole`. Both are equal if the picture was not cropped.
///
/// # Errors
///
/// `out` cannot be written to, or `part` does not have the film's size or does not lie in `whole`.
pub fn write_exr<'a>(
    film: impl Into<LinearFilm<'a>>,
    part: Area,
    whole: Area,
    out: &mut dyn Sink,
) -> io::Result<()> {
    write(film.into(), part, whole, out)
}

fn write(film: LinearFilm, part: Area, whole: Area, out: &mut dyn Sink) -> io::Result<()> {
    if [part.width, part.height] != [film.width(), film.height()] || !part.lies_in(whole) {
        let message = format!(
            "a film of {} × {} pixels is not the part {part} of a picture of {} × {}",
            film.width(),
            film.height(),
            whole.width,
            whole.height
        );
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        // A picture has at most 2^20 columns and rows, so the conversions to `u32` are exact.
        <(f32, f32, f32)>::from(film.pixel(x as u32, y as u32))
    });
    let encoding = Encoding {
        // Blocks of 16 rows compress better. For very wide pictures, they would take more memory
        // than the film, since each block is in memory several times, so these have blocks of one
        // row.
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
        // These are the colours of sRGB's red, green, blue and white. OpenEXR also assumes them if
        // a file does not name any.
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
    // The blocks are written one by one, so that at most one is in memory.
    image
        .write()
        .non_parallel()
        .to_unbuffered(out)
        .map_err(|error| match error {
            Error::Io(error) => error,
            other => io::Error::other(other),
        })
}

/// Reads a picture that is decoded to at most `limit` bytes. The alpha channel is ignored: OpenEXR
/// stores colours multiplied by it, i.e. as seen on black.
pub fn read(bytes: &[u8], limit: u64) -> Result<Picture, Unreadable> {
    let file = block::read(Cursor::new(bytes), false).map_err(unreadable)?;
    for header in file.headers() {
        // The size is checked before anything is decompressed.
        let Vec2(width, height) = header.layer_size;
        let channels = &header.channels.list;
        // The decoder unpacks all channels of the file, not only R, G, B and A, so all are counted.
        let sizes = channels
            .iter()
            .map(|channel| channel.sample_type.bytes_per_sample());
        let channel = sizes.sum::<usize>().div_ceil(4);
        check_size([width as u64, height as u64], channel as u64, limit)?;
    }
    let [red, green, blue] = channels(file.headers())?;
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required(red)
        .required(green)
        .required(blue)
        .collect_pixels(
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
        .from_chunks(file)
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
            ..Area::whole(width, height)
        }),
        _ => None,
    };
    let is_half = |channel: &ChannelDescription| channel.sample_type == SampleType::F16;
    Ok(Picture {
        film,
        rounding: if [red, green, blue].iter().any(is_half) {
            Rounding::Half
        } else {
            Rounding::Float
        },
        coding: Coding::Exact,
        crop,
        opacity: None,
    })
}

/// Returns the names of the channels to read: R, G and B, or those of a layer, such as `beauty.R`,
/// if it is the only one with all three. Fails if there are none.
fn channels(headers: &[Header]) -> Result<[Text; 3], Unreadable> {
    let names = headers.iter().flat_map(|header| &header.channels.list);
    let names: BTreeSet<String> = names.map(|channel| channel.name.to_string()).collect();
    let of = |layer: &str| ["R", "G", "B"].map(|letter| format!("{layer}{letter}"));
    let layers = names.iter().filter_map(|name| name.strip_suffix('R'));
    let is_whole = |layer: &&str| of(layer).iter().all(|name| names.contains(name));
    let layers: Vec<&str> = layers.filter(is_whole).collect();
    let layer = match layers[..] {
        [layer] => layer,
        _ if layers.contains(&"") => "",
        _ => {
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            let cause = format!(
                "its channels are {}, of which R, G and B are read, or those of one layer, such as beauty.R",
                names.join(", ")
            );
            return Err(Unreadable::Unsupported {
                format: "OpenEXR".to_owned(),
                cause,
            });
        }
    };
    Ok(of(layer).map(|name| Text::from(&*name)))
}

fn unreadable(error: Error) -> Unreadable {
    let format = "OpenEXR".to_owned();
    let cause = match &error {
        Error::NotSupported(what) | Error::Invalid(what) => what.to_string(),
        other => other.to_string(),
    };
    match error {
        Error::NotSupported(_) => Unreadable::Unsupported { format, cause },
        _ => Unreadable::Damaged { format, cause },
    }
}
