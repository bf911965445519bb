//! OpenEXR: linear means, rounded to 32-bit floats, in the channels R, G and B.
//!
//! The display window is the whole picture. The data window is the part of it that the file
//! contains.

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

/// A film of linear light, in 64-bit or in 32-bit floats.
#[derive(Clone, Copy, Debug)]
pub enum LinearFilm<'a> {
    /// Means of the pixels as `f64`.
    Means(&'a Film),
    /// Means of the pixels, rounded to 32-bit floats.
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

/// Writes `film` as an OpenEXR file. `part` is the area of the picture `whole` that `film` shows;
/// it may be all of it.
///
/// # Errors
///
/// `out` cannot be written to, or `part` has another size than the film or does not lie in `whole`.
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
        // Columns and rows are below 2^20, so the conversions to `u32` are exact.
        <(f32, f32, f32)>::from(film.pixel(x as u32, y as u32))
    });
    let encoding = Encoding {
        // A block of 16 rows is in memory several times at once. For the widest pictures, that
        // would take more memory than the film, so their blocks have one row.
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
        // These are the primaries of sRGB, which readers also assume if a file has none.
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
    // The file is written block by block, so that at most one block is in memory.
    image
        .write()
        .non_parallel()
        .to_unbuffered(out)
        .map_err(|error| match error {
            Error::Io(error) => error,
            other => io::Error::other(other),
        })
}
