//! OpenEXR files: the pixels' colours in linear light, as 32-bit floats in the channels R, G and B.
//!
//! The format's display window is the area of the whole picture. Its data window is the part of the
//! picture that the file contains.

use std::{borrow::Borrow, io};

use exr::{
    block::{self, UncompressedBlock, writer::ChunksWriter},
    error::Error,
    math::Vec2,
    meta::{
        BlockDescription, Headers,
        attribute::{
            AttributeValue, ChannelDescription, Chromaticities, LineOrder, SampleType, Text,
        },
        header::{Header, ImageAttributes, LayerAttributes},
    },
    prelude::Compression,
};

use super::pixels::{AsFloats, Film};
use crate::{area::Area, files::Sink};

/// Name of the attribute with the digest of a picture's recipe ([`Recipe::digest`]).
///
/// [`Recipe::digest`]: super::Recipe::digest
const DIGEST: &str = "pinhole:digest";

/// Writes `film` as an OpenEXR file. The film shows the area `part` of a picture with the area
/// `whole`. The two areas are equal if the picture was not cropped. `digest` is the digest of the
/// picture's recipe, if the recipe is known.
///
/// # Errors
///
/// `out` cannot be written to, or `part` does not have the film's size or does not lie in `whole`.
pub fn write_exr<P: AsFloats>(
    film: &Film<P>,
    part: Area,
    whole: Area,
    digest: Option<&str>,
    out: &mut dyn Sink,
) -> io::Result<()> {
    if film.height() != part.height || !part.lies_in(whole) {
        return Err(other_size(film, part));
    }
    write_exr_bands(part, whole, digest, out, [Ok(film)])
}

/// Writes an OpenEXR file as [`write_exr`] does, but from bands of rows, from the top to the
/// bottom. The whole picture need not be in memory.
///
/// # Errors
///
/// `out` cannot be written to, an item of `bands` is an error, the bands do not have the size of
/// `part`, or `part` does not lie in `whole`.
pub fn write_exr_bands<P: AsFloats, B: Borrow<Film<P>>>(
    part: Area,
    whole: Area,
    digest: Option<&str>,
    out: &mut dyn Sink,
    bands: impl IntoIterator<Item = io::Result<B>>,
) -> io::Result<()> {
    if !part.lies_in(whole) {
        let message = format!(
            "the part {part} does not lie in a picture of {} × {} pixels",
            whole.width, whole.height
        );
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    let mut rows = Rows {
        part,
        bands: bands.into_iter(),
        band: None,
        end: 0,
        floats: Vec::new(),
        at: None,
    };
    // Blocks of rows are compressed and written one by one, so that the whole file is never in
    // memory.
    block::write(
        io::BufWriter::new(out),
        headers(part, whole, digest),
        true,
        |meta, chunks| {
            let channels = &meta.headers[0].channels;
            let mut chunks = chunks.sequential_blocks_compressor(&meta);
            for (at, index) in meta.enumerate_ordered_header_block_indices() {
                let mut failed = Ok(());
                let block = UncompressedBlock::from_lines(channels, index, |line| {
                    // Channels are stored in alphabetical order: blue, green, red. A row of pixels
                    // has them in the opposite order.
                    let (y, channel) = (line.location.position.y(), 2 - line.location.channel);
                    let written = rows
                        .row(y as u32)
                        .map_err(Error::Io)
                        .and_then(|row| line.write_samples(|x| row[x][channel]));
                    if failed.is_ok() {
                        failed = written;
                    }
                });
                failed?;
                chunks.compress_block(at, block)?;
            }
            Ok(())
        },
    )
    .map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other),
    })
}

/// Returns the header of an OpenEXR file, as a list with one item. The format allows several
/// headers, so the library expects a list.
fn headers(part: Area, whole: Area, digest: Option<&str>) -> Headers {
    let channel = |name: &str| ChannelDescription::named(name, SampleType::F32);
    let size = Vec2(part.width as usize, part.height as usize);
    // Blocks of 16 rows compress better than single rows, but the encoder holds several copies of a
    // block in memory. Very wide pictures are therefore written in blocks of one row.
    let compression = match part.width {
        0..=0x1_0000 => Compression::ZIP16,
        _ => Compression::ZIP1,
    };
    let mut own = LayerAttributes {
        layer_position: Vec2(part.x as i32, part.y as i32),
        software_name: Some(Text::from(concat!("pinhole ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    let digest =
        digest.map(|digest| (Text::from(DIGEST), AttributeValue::Text(Text::from(digest))));
    own.other.extend(digest);
    let shared = ImageAttributes {
        // Chromaticities of sRGB's red, green, blue and white. OpenEXR assumes the same ones if a
        // file contains none.
        chromaticities: Some(Chromaticities {
            red: Vec2(0.64, 0.33),
            green: Vec2(0.3, 0.6),
            blue: Vec2(0.15, 0.06),
            white: Vec2(0.3127, 0.329),
        }),
        ..ImageAttributes::with_size(Vec2(whole.width as usize, whole.height as usize))
    };
    let header = Header::new(
        Text::default(),
        size,
        ["B", "G", "R"].map(channel)[..].into(),
    )
    .with_encoding(
        compression,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    )
    .with_attributes(own)
    .with_shared_attributes(shared);
    [header][..].into()
}

/// Reader of single rows of a picture that is given in bands of several rows.
struct Rows<I, B> {
    /// The picture's area.
    part: Area,
    bands: I,
    /// The band that contains the row that was returned last; `None` before the first row.
    band: Option<B>,
    /// Number of rows of the picture that were received so far, including all rows of `band`.
    end: u32,
    /// The row that was returned last, as floats.
    floats: Vec<[f32; 3]>,
    /// Index of the row that was returned last; `None` before the first row.
    at: Option<u32>,
}

impl<I, B> Rows<I, B> {
    /// Returns row `y`, counted from the top of the picture. Rows must be requested in order. The
    /// last row may be requested again.
    fn row<P: AsFloats>(&mut self, y: u32) -> io::Result<&[[f32; 3]]>
    where
        I: Iterator<Item = io::Result<B>>,
        B: Borrow<Film<P>>,
    {
        if self.at == Some(y) {
            return Ok(&self.floats);
        }
        while self.band.is_none() || y >= self.end {
            let band = self.bands.next().ok_or(io::ErrorKind::UnexpectedEof)??;
            let film = band.borrow();
            if film.width() != self.part.width || film.height() == 0 {
                return Err(other_size(film, self.part));
            }
            self.end += film.height();
            self.band = Some(band);
        }
        let band = self.band.as_ref().ok_or(io::ErrorKind::UnexpectedEof)?;
        let film = band.borrow();
        let row = film.row(y + film.height() - self.end);
        self.floats.clear();
        self.floats.extend(row.iter().map(|pixel| pixel.floats()));
        self.at = Some(y);
        Ok(&self.floats)
    }
}

/// Returns the error that a film does not have the size of the part that it should show.
fn other_size<P: AsFloats>(film: &Film<P>, part: Area) -> io::Error {
    let (width, height) = (film.width(), film.height());
    let message = format!("a film of {width} × {height} pixels is not the part {part}");
    io::Error::new(io::ErrorKind::InvalidInput, message)
}

/// Returns the digest that a file's header stores; `None` if another program wrote the file.
#[cfg(feature = "read")]
pub(super) fn stored_digest(own: &LayerAttributes) -> Option<String> {
    match own.other.get(&Text::from(DIGEST))? {
        AttributeValue::Text(digest) => Some(digest.to_string()),
        _ => None,
    }
}
