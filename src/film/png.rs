//! Portable Network Graphics: 8 bits of sRGB per channel, and the scene that the picture shows.
//!
//! The text is stored in compressed iTXt chunks before the pixels: `Software`, a keyword of PNG
//! itself; `pinhole:scene`; one `pinhole:set` for each override, in order; and `pinhole:crop` as
//! `X,Y,W,H`. The file contains no date and nothing about the machine, so that the same scene gives
//! the same file.

use std::io::{self, Write};

use fdeflate::BoundedDecompressionError;
use png::{BitDepth, ColorType, DeflateCompression, Encoder, Filter, SrgbRenderingIntent};
use thiserror::Error;

use super::{
    pixels::{AsBytes, Film},
    srgb,
};
use crate::area::Area;

/// The first bytes of every PNG.
pub const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Maximum number of bytes of all texts of a [`Recipe`]. A longer recipe is not stored in a
/// picture.
pub const TEXT_LIMIT: usize = 1 << 20;

/// Maximum number of overrides of a [`Recipe`]. A recipe with more is not stored in a picture.
pub const OVERRIDES_LIMIT: usize = 1000;

const SOFTWARE: &str = "Software";
const SCENE: &str = "pinhole:scene";
const SET: &str = "pinhole:set";
const CROP: &str = "pinhole:crop";

/// The scene, the overrides and the crop from which a picture was made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// The text of the scene.
    pub scene: String,
    /// The `--set` arguments, in order.
    pub overrides: Vec<String>,
    /// The part of the picture that was rendered; `None` for the whole.
    pub crop: Option<Area>,
}

/// Why a picture's recipe cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NotOurs {
    /// The file does not follow the PNG format.
    #[error("it begins as a PNG does, but is damaged or no picture")]
    Damaged,
    /// The picture contains no scene.
    #[error(
        "the picture carries no scene: another program wrote it, or its scene had more than 1 MiB of text"
    )]
    NoScene,
    /// The picture contains more text than Pinhole writes.
    #[error("the picture carries more than 1 MiB of text")]
    TooMuchText,
    /// The picture contains more overrides than Pinhole writes.
    #[error("the picture carries more than 1000 overrides")]
    TooManyOverrides,
    /// A text of the picture is not UTF-8.
    #[error("the picture carries a scene or an override that is not UTF-8 text")]
    NotUtf8,
    /// The crop in the picture is not a valid area.
    #[error("the picture carries a crop that makes no sense, `{0}`")]
    Crop(String),
}

impl Recipe {
    /// Returns whether the recipe is short enough to be stored in a picture.
    pub fn fits(&self) -> bool {
        let overrides: usize = self.overrides.iter().map(String::len).sum();
        let crop = self.crop.map_or(0, |crop| crop.to_string().len());
        self.overrides.len() <= OVERRIDES_LIMIT && self.scene.len() + overrides + crop <= TEXT_LIMIT
    }

    fn texts(&self) -> impl Iterator<Item = (&'static str, String)> {
        let overrides = self.overrides.iter().map(|set| (SET, set.clone()));
        let crop = self.crop.map(|crop| (CROP, crop.to_string()));
        [(SCENE, self.scene.clone())]
            .into_iter()
            .chain(overrides)
            .chain(crop)
    }
}

/// Writes a picture as a PNG. Also stores `recipe` if it is given and [`fits`](Recipe::fits).
///
/// # Errors
///
/// `out` cannot be written to.
pub fn write_png<P: AsBytes>(
    film: &Film<P>,
    recipe: Option<&Recipe>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut encoder = Encoder::new(out, film.width(), film.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    // The rows of flat colours repeat. They compress better unfiltered than as the differences of
    // neighbours that the format's filters store. Compression levels above 3 make the files of such
    // pictures smaller by a few hundredths, but take three times as long.
    encoder.set_filter(Filter::NoFilter);
    encoder.set_deflate_compression(DeflateCompression::Level(3));
    let mut writer = encoder.write_header()?;

    let software = concat!("pinhole ", env!("CARGO_PKG_VERSION"));
    let recipe = recipe.filter(|recipe| recipe.fits());
    let texts = recipe.into_iter().flat_map(Recipe::texts);
    for (keyword, text) in [(SOFTWARE, software.to_owned())].into_iter().chain(texts) {
        let mut chunk = png::text_metadata::ITXtChunk::new(keyword, text);
        chunk.compressed = true;
        writer.write_text_chunk(&chunk)?;
    }

    // Rows are written one by one, so that the bytes of the whole picture are never in memory at
    // once.
    let mut rows = writer.stream_writer_with_size(1 << 16)?;
    let encoder = srgb::Encoder::default();
    let mut buffer = Vec::new();
    for y in 0..film.height() {
        rows.write_all(P::bytes(film.row(y), &encoder, &mut buffer))?;
    }
    rows.finish()?;
    writer.finish()?;
    Ok(())
}

/// Reads the recipe from the bytes of a PNG file. Only the chunks before the pixels are read, and
/// at most [`TEXT_LIMIT`] bytes are decompressed.
///
/// # Errors
///
/// The file is damaged, contains no scene or an invalid text, or contains more text or overrides
/// than a recipe may have.
pub fn read_recipe(picture: &[u8]) -> Result<Recipe, NotOurs> {
    let mut rest = picture.strip_prefix(&SIGNATURE).ok_or(NotOurs::Damaged)?;
    let (mut scene, mut overrides, mut crop) = (None, Vec::new(), None);
    let mut left = TEXT_LIMIT;
    loop {
        let (kind, content);
        (kind, content, rest) = chunk(rest).ok_or(NotOurs::Damaged)?;
        let (keyword, is_packed, text) = match kind {
            b"IDAT" => break,
            b"iTXt" => international_text(content).ok_or(NotOurs::Damaged)?,
            _ => continue,
        };
        let keyword = [SCENE, SET, CROP]
            .into_iter()
            .find(|ours| ours.as_bytes() == keyword);
        let Some(keyword) = keyword else { continue };
        let text = if is_packed {
            fdeflate::decompress_to_vec_bounded(text, left).map_err(not_unpacked)?
        } else if text.len() > left {
            return Err(NotOurs::TooMuchText);
        } else {
            text.to_owned()
        };
        left -= text.len();
        let text = String::from_utf8(text).map_err(|_| NotOurs::NotUtf8)?;
        match keyword {
            SCENE => scene = Some(text),
            SET if overrides.len() == OVERRIDES_LIMIT => return Err(NotOurs::TooManyOverrides),
            SET => overrides.push(text),
            _ => crop = Some(text.parse().map_err(|_| NotOurs::Crop(text))?),
        }
    }
    Ok(Recipe {
        scene: scene.ok_or(NotOurs::NoScene)?,
        overrides,
        crop,
    })
}

/// Returns a chunk's kind, its content, and the bytes after it. Returns `None` if the chunk is cut
/// off or its checksum is wrong. For the pixels, only the kind is returned.
fn chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
    if rest.starts_with(b"IDAT") {
        // The chunk of pixels may extend beyond the bytes that were read of the file.
        return Some((&rest[..4], &[], &[]));
    }
    let (checked, rest) = rest.split_at_checked(length.checked_add(4)?)?;
    let (checksum, rest) = rest.split_first_chunk::<4>()?;
    let (kind, content) = checked.split_at(4);
    (crc32fast::hash(checked) == u32::from_be_bytes(*checksum)).then_some((kind, content, rest))
}

/// Returns the keyword of an iTXt chunk, whether its text is compressed, and the text. Returns
/// `None` if the chunk is malformed.
fn international_text(content: &[u8]) -> Option<(&[u8], bool, &[u8])> {
    let (keyword, rest) = before_zero(content)?;
    let (&[is_packed, _method], rest) = rest.split_first_chunk()?;
    let (_language, rest) = before_zero(rest)?;
    let (_translated, text) = before_zero(rest)?;
    Some((keyword, is_packed != 0, text))
}

fn before_zero(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|&byte| byte == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

fn not_unpacked(error: BoundedDecompressionError) -> NotOurs {
    match error {
        BoundedDecompressionError::OutputTooLarge { .. } => NotOurs::TooMuchText,
        BoundedDecompressionError::DecompressionError { .. } => NotOurs::Damaged,
    }
}
