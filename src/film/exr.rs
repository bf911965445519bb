//! OpenEXR files: the pixels' colours in linear light, as 32-bit floats in the channels R, G and B.
//!
//! The format's display window is the area of the whole picture. Its data window is the part of the
//! picture that the file contains.

use std::io;

use exr::{
    error::Error,
    image::{Encoding, Image, SpecificChannels, write::WritableImage},
    math::Vec2,
    meta::{
        attribute::{Chromaticities, IntegerBounds, LineOrder, Text},
        header::ImageAttributes,
    },
    prelude::{Blocks, Compression, LayerAttributes},
};

use super::pixels::Film;
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
        // Blocks of 16 rows compress better than single rows. Several copies of a block are in
        // memory at once, which for a very wide picture would need more memory than the film. Very
        // wide pictures are therefore written in blocks of one row.
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
