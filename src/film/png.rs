//! PNG files: pixels in 8-bit sRGB, and the text of the scene that the picture shows.
//!
//! Before the pixels, the file contains compressed iTXt chunks with these keywords: `Software`,
//! Pinhole's version; `pinhole:scene`, the scene's text; `pinhole:set` for each `--set` argument;
//! and `pinhole:crop`, the rendered part as `X,Y,W,H`. The file contains no date and nothing about
//! the machine, so that equal scenes give equal files.

use std::io::{self, Write};

use fdeflate::BoundedDecompressionError;
use png::{BitDepth, ColorType, DeflateCompression, Encoder, Filter, SrgbRenderingIntent};
use thiserror::Error;

use super::{
    pixels::{AsBytes, Film},
    srgb,
};
use crate::area::Area;

/// The first eight bytes of every PNG file.
pub const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Maximum length, in bytes, of all texts that a PNG stores about its scene. Longer texts are not
/// stored, and not read from a PNG, so that a small file cannot be unpacked to a huge one. Usual
/// scenes are far shorter.
pub const TEXT_LIMIT: usize = 1 << 20;

/// Maximum number of overrides (`--set` arguments) that a PNG stores. If a picture has more,
/// nothing about its scene is stored, and a file that contains more is rejected. Users give far
/// fewer.
pub const OVERRIDES_LIMIT: usize = 1000;

const SOFTWARE: &str = "Software";
const SCENE: &str = "pinhole:scene";
const SET: &str = "pinhole:set";
const CROP: &str = "pinhole:crop";

/// Everything from which a picture was made. A PNG stores it, so that the picture can be rendered
/// again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// The text of the scene.
    pub scene: String,
    /// The overrides of the scene's values, i.e. the `--set` arguments, in the order given by the
    /// user.
    pub overrides: Vec<String>,
    /// The part of the picture that was rendered; `None` if all of it was rendered.
    pub crop: Option<Area>,
}

/// Error: the scene of a picture cannot be read from its PNG file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum NotOurs {
    /// The file is not a valid PNG.
    #[error("it begins as a PNG does, but is damaged or no picture")]
    Damaged,
    /// The file contains no scene, so another program wrote it, or the scene was too long.
    #[error(
        "the picture carries no scene: another program wrote it, or its scene had more than 1 MiB of text"
    )]
    NoScene,
    /// The file contains more text about a scene than Pinhole writes.
    #[error("the picture carries more than 1 MiB of text")]
    TooMuchText,
    /// The file contains more overrides of a scene's values than Pinhole writes.
    #[error("the picture carries more than 1000 overrides")]
    TooManyOverrides,
    /// A text in the file is not UTF-8.
    #[error("the picture carries a scene or an override that is not UTF-8 text")]
    NotUtf8,
    /// The crop in the file is not a valid area. The field contains the invalid text.
    #[error("the picture carries a crop that makes no sense, `{0}`")]
    Crop(String),
}

impl Recipe {
    /// Returns whether a PNG stores the recipe's texts: their total length and the number of
    /// overrides must be within the limits.
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

/// Writes a picture as a PNG. Also stores `recipe`, unless its texts are too long
/// ([`fits`](Recipe::fits)).
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
    // Pictures of scenes have flat colours, so their rows repeat. Equal rows compress better
    // without PNG's filters, which store differences of neighbours. Compression levels above 3 make
    // files a few percent smaller, but need three times as long.
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

    // Rows are converted and written one by one, so that the bytes of the whole picture are never
    // in memory at once.
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

/// Reads the scene and its overrides from a PNG file. Nothing after the start of the pixels is
/// read. At most [`TEXT_LIMIT`] bytes of text are unpacked.
///
/// # Errors
///
/// The file is damaged, contains no scene or an invalid text, or contains too much text or too many
/// overrides.
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

/// Reads a chunk of a PNG. Returns its type, its content, and the bytes after it. For the chunk of
/// pixels, only the type is returned. Returns `None` if the chunk is cut off or its checksum is
/// wrong.
fn chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
    if rest.starts_with(b"IDAT") {
        // Only the start of the file may have been read, so the chunk of pixels may be incomplete.
        return Some((&rest[..4], &[], &[]));
    }
    let (checked, rest) = rest.split_at_checked(length.checked_add(4)?)?;
    let (checksum, rest) = rest.split_first_chunk::<4>()?;
    let (kind, content) = checked.split_at(4);
    (crc32fast::hash(checked) == u32::from_be_bytes(*checksum)).then_some((kind, content, rest))
}

/// Reads an iTXt chunk of a PNG. Returns its keyword, whether its text is compressed, and the text.
/// Returns `None` if the chunk does not follow the format.
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
