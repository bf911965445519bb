//! OpenEXR: the linear means, rounded to 32-bit floats, in the channels R, G and B.

use std::io::{self, Seek, Write};

use exr::{
    error::Error,
    image::{Encoding, Image, SpecificChannels, write::WritableImage},
    math::Vec2,
    meta::attribute::{LineOrder, Text},
    prelude::{Blocks, Compression, LayerAttributes},
};

use super::Film;

/// Writes a picture.
pub fn write_exr(film: &Film, out: impl Write + Seek) -> io::Result<()> {
    let channels = SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| {
        // A picture has at most 2^20 columns and rows.
        let [r, g, b] = film.pixel(x as u32, y as u32);
        (r as f32, g as f32, b as f32)
    });
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (film.width() as usize, film.height() as usize);
    let mut image = Image::from_encoded_channels(size, encoding, channels);
    image.layer_data.attributes = LayerAttributes {
        software_name: Some(Text::from(concat!("pinhole ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
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
