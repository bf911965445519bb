//! Portable Network Graphics: 8 bits of sRGB a channel, and the scene that the picture shows.
//!
//! The text goes into compressed iTXt chunks before the pixels: `Software`, which PNG itself knows, `pinhole:scene`, one `pinhole:set`
//! for each override in their order, and `pinhole:crop` as `X,Y,W,H`. There is no date and nothing of the machine, so that the same
//! scene makes the same file.

use std::io::{self, Cursor, Write};

use png::{
    BitDepth, ColorType, DecodeOptions, Decoder, DeflateCompression, Encoder, Filter, Limits,
    SrgbRenderingIntent,
};
use thiserror::Error;

use super::{Film, Pixel, srgb};
use crate::area::Area;

/// The first bytes of every PNG.
pub const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// A recipe with more bytes of text than this is not kept in a picture.
pub const TEXT_LIMIT: usize = 1 << 20;

const SOFTWARE: &str = "Software";
const SCENE: &str = "pinhole:scene";
const SET: &str = "pinhole:set";
const CROP: &str = "pinhole:crop";

/// What a picture was made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// The text of the scene.
    pub scene: String,
    /// The `--set` arguments, in order.
    pub overrides: Vec<String>,
    /// The part of the picture, if it is not the whole.
    pub crop: Option<Area>,
}

/// Why a picture does not stand for a scene.
#[derive(Debug, Error)]
pub enum NotOurs {
    /// It does not follow the format.
    #[error("it begins as a PNG does, but is damaged or no picture")]
    Damaged(#[from] png::DecodingError),
    /// It has no scene in it.
    #[error(
        "the picture carries no scene: another program wrote it, or its scene had more than 1 MiB of text"
    )]
    NoScene,
    /// It has more text than Pinhole puts in.
    #[error("the picture carries more than 1 MiB of text")]
    TooMuchText,
    /// Its crop makes no sense.
    #[error("the picture carries a crop that makes no sense, `{0}`")]
    Crop(String),
}

impl Recipe {
    /// Whether it is short enough to be kept in a picture.
    pub fn fits(&self) -> bool {
        let overrides: usize = self.overrides.iter().map(String::len).sum();
        let crop = self.crop.map_or(0, |crop| crop.to_string().len());
        self.scene.len() + overrides + crop <= TEXT_LIMIT
    }

    fn chunks(&self) -> impl Iterator<Item = (&'static str, String)> {
        let overrides = self.overrides.iter().map(|set| (SET, set.clone()));
        let crop = self.crop.map(|crop| (CROP, crop.to_string()));
        [(SCENE, self.scene.clone())]
            .into_iter()
            .chain(overrides)
            .chain(crop)
    }
}

/// Writes a picture, with what it was made from if that [`fits`](Recipe::fits).
pub fn write_png<P: Pixel>(film: &Film<P>, recipe: &Recipe, out: impl Write) -> io::Result<()> {
    let recipe = recipe.fits().then_some(recipe);
    write(film, recipe.into_iter().flat_map(Recipe::chunks), out)
}

/// Writes a picture that no scene makes.
pub fn write_plain_png(film: &Film, out: impl Write) -> io::Result<()> {
    write(film, [].into_iter(), out)
}

fn write(
    film: &Film<impl Pixel>,
    chunks: impl Iterator<Item = (&'static str, String)>,
    out: impl Write,
) -> io::Result<()> {
    let mut encoder = Encoder::new(out, film.width(), film.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    // Rows of flat colours repeat as they are: differences of neighbours, which the format's filters store, are packed less well. Of such
    // pictures a higher level makes files smaller by a few hundredths, and takes three times as long.
    encoder.set_filter(Filter::NoFilter);
    encoder.set_deflate_compression(DeflateCompression::Level(3));
    let mut writer = encoder.write_header()?;

    let software = concat!("pinhole ", env!("CARGO_PKG_VERSION"));
    for (keyword, text) in [(SOFTWARE, software.to_owned())].into_iter().chain(chunks) {
        let mut chunk = png::text_metadata::ITXtChunk::new(keyword, text);
        chunk.compressed = true;
        writer.write_text_chunk(&chunk)?;
    }

    // Row by row: the bytes of the whole are never in memory at once.
    let mut rows = writer.stream_writer_with_size(1 << 16)?;
    let encoder = srgb::Encoder::new();
    let mut room = Vec::new();
    for y in 0..film.height() {
        rows.write_all(Pixel::bytes(film.row(y), &encoder, &mut room))?;
    }
    rows.finish()?;
    writer.finish()?;
    Ok(())
}

/// Reads what a picture was made from. Only what precedes the pixels is looked at, and no more than [`TEXT_LIMIT`] is unpacked.
pub fn read_recipe(picture: &[u8]) -> Result<Recipe, NotOurs> {
    // The decoder reserves a few rows of at most 2^20 pixels of up to 8 bytes, besides the packed text.
    let limits = Limits { bytes: 64 << 20 };
    // A chunk with a wrong checksum may have been an override, so it must not be passed over.
    let mut options = DecodeOptions::default();
    options.set_skip_ancillary_crc_failures(false);
    options.set_ignore_iccp_chunk(true);
    let mut decoder = Decoder::new_with_options(Cursor::new(picture), options);
    decoder.set_limits(limits);
    let reader = decoder.read_info()?;

    let mut recipe = Recipe {
        scene: String::new(),
        overrides: Vec::new(),
        crop: None,
    };
    let mut has_scene = false;
    let mut left = TEXT_LIMIT;
    for chunk in &reader.info().utf8_text {
        if ![SCENE, SET, CROP].contains(&chunk.keyword.as_str()) {
            continue;
        }
        let mut chunk = chunk.clone();
        if chunk.decompress_text_with_limit(left).is_err() {
            // Too long, packed wrongly, or not UTF-8.
            chunk
                .decompress_text_with_limit(0)
                .map_err(|_| NotOurs::TooMuchText)?;
        }
        let text = chunk.get_text()?;
        left = left.checked_sub(text.len()).ok_or(NotOurs::TooMuchText)?;
        match chunk.keyword.as_str() {
            SCENE => {
                has_scene = true;
                recipe.scene = text;
            }
            SET => recipe.overrides.push(text),
            _ => recipe.crop = Some(text.parse().map_err(|_| NotOurs::Crop(text))?),
        }
    }
    if has_scene {
        Ok(recipe)
    } else {
        Err(NotOurs::NoScene)
    }
}
