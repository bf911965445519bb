//! PNG files: pixels in 8-bit sRGB, and the text of the scene that the picture shows.
//!
//! Before the pixels, the file contains compressed iTXt chunks with these keywords: `Software`,
//! Pinhole's version; `pinhole:scene`, the scene's text; and `pinhole:set` for each override, i.e.
//! `--set` argument. If it shows only a part of a picture, it also contains `pinhole:crop`, the
//! part as `X,Y,W,H`; `pinhole:size`, the whole picture's size as `W,H`; and `pinhole:digest`, a
//! digest of the scene and the overrides. The file contains no date and nothing about the machine,
//! so that equal scenes give equal files.

use std::{
    borrow::Borrow,
    io::{self, Write},
};

use fdeflate::BoundedDecompressionError;
use flate2::{Compression, write::ZlibEncoder};
use png::{BitDepth, ColorType, DeflateCompression, Encoder, Filter, SrgbRenderingIntent};
use thiserror::Error;

use super::{
    pixels::{AsBytes, Film},
    recipe::{OVERRIDES_LIMIT, Part, Recipe, TEXT_LIMIT},
    srgb,
};
use crate::area::Area;

/// The first eight bytes of every PNG file.
pub const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

const SOFTWARE: &str = "Software";
const SCENE: &str = "pinhole:scene";
const SET: &str = "pinhole:set";
const CROP: &str = "pinhole:crop";
const SIZE: &str = "pinhole:size";
const DIGEST: &str = "pinhole:digest";

/// Bytes of an iTXt chunk between its keyword and its text: the zero that ends the keyword, 1 for
/// compressed text, 0 for the method zlib, and the zeros that end an empty language and an empty
/// translated keyword.
const PACKED_TEXT: &[u8] = &[0, 1, 0, 0, 0];

/// Maximum length, in bytes, of each text that says which part of a picture a file shows. The
/// longest text of this kind that Pinhole writes is a digest, with a third of this length.
const PART_LIMIT: usize = 192;

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
    /// The crop in the file, or the size of the whole picture, is invalid. The field contains the
    /// invalid text.
    #[error("the picture carries a crop that makes no sense, `{0}`")]
    Crop(String),
    /// The file does not say which part of a whole picture it shows.
    #[error("it is no part of a picture: it carries no crop with the size of the whole")]
    NoPart,
}

/// Writes a picture as a PNG, and `recipe` as texts in it. The scene and its overrides are left out
/// if they are too long ([`fits`](Recipe::fits)).
///
/// # Errors
///
/// `out` cannot be written to.
pub fn write_png<P: AsBytes>(
    film: &Film<P>,
    recipe: Option<&Recipe>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let size = [film.width(), film.height()];
    write_png_bands(size, recipe, out, [Ok(film)])
}

/// Writes a picture as [`write_png`] does, but from bands of rows, from the top to the bottom. The
/// whole picture need not be in memory. `size` contains the numbers of columns and rows.
///
/// # Errors
///
/// `out` cannot be written to, an item of `bands` is an error, or the bands do not have the
/// picture's size.
pub fn write_png_bands<P: AsBytes, B: Borrow<Film<P>>>(
    size: [u32; 2],
    recipe: Option<&Recipe>,
    out: &mut dyn Write,
    bands: impl IntoIterator<Item = io::Result<B>>,
) -> io::Result<()> {
    let mut writer = encoder(out, size).write_header()?;

    let software = concat!("pinhole ", env!("CARGO_PKG_VERSION"));
    let texts = recipe.into_iter().flat_map(texts);
    // All texts share one compressor, because clearing the memory of a new compressor takes longer
    // than compressing a short text.
    let mut compressor = ZlibEncoder::new(Vec::new(), Compression::fast());
    for (keyword, text) in [(SOFTWARE, software.to_owned())].into_iter().chain(texts) {
        compressor.write_all(text.as_bytes())?;
        let packed = compressor.reset(Vec::new())?;
        let chunk = [keyword.as_bytes(), PACKED_TEXT, &packed].concat();
        writer.write_chunk(png::chunk::iTXt, &chunk)?;
    }

    // Rows are converted and written one by one, so that the bytes of the whole picture are never
    // in memory at once.
    let mut rows = writer.stream_writer_with_size(1 << 16)?;
    let encoder = srgb::Encoder::shared();
    let mut buffer = Vec::new();
    for band in bands {
        let band = band?;
        let film = band.borrow();
        if film.width() != size[0] {
            return Err(io::ErrorKind::InvalidInput.into());
        }
        for y in 0..film.height() {
            rows.write_all(P::bytes(film.row(y), encoder, &mut buffer))?;
        }
    }
    rows.finish()?;
    writer.finish()?;
    Ok(())
}

/// Makes an encoder for pictures of scenes.
pub(super) fn encoder<W: Write>(out: W, [width, height]: [u32; 2]) -> Encoder<'static, W> {
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    // Pictures of scenes have flat colours, so their rows repeat. Equal rows compress better
    // without PNG's filters, which store differences of neighbours. Compression levels above 3 make
    // files a few percent smaller, but take three times as long.
    encoder.set_filter(Filter::NoFilter);
    encoder.set_deflate_compression(DeflateCompression::Level(3));
    encoder
}

/// Returns the keywords and texts with which a PNG stores a recipe.
fn texts(recipe: &Recipe) -> Vec<(&'static str, String)> {
    let mut texts = Vec::new();
    if recipe.fits() {
        texts.push((SCENE, recipe.scene.clone()));
        texts.extend(recipe.overrides.iter().map(|set| (SET, set.clone())));
    }
    if let Some(crop) = recipe.crop {
        texts.push((CROP, crop.to_string()));
    }
    if let Some(Part {
        size: [width, height],
        digest,
        ..
    }) = recipe.part()
    {
        texts.extend([(SIZE, format!("{width},{height}")), (DIGEST, digest)]);
    }
    texts
}

/// Reads the scene and its overrides from a PNG file. Nothing after the start of the pixels is
/// read. At most [`TEXT_LIMIT`] bytes of text are unpacked.
///
/// # Errors
///
/// The file is damaged, contains no scene or an invalid text, or contains too much text or too many
/// overrides.
pub fn read_recipe(picture: &[u8]) -> Result<Recipe, NotOurs> {
    let texts = StoredTexts::read(picture)?;
    Ok(Recipe {
        scene: texts.scene.ok_or(NotOurs::NoScene)?,
        overrides: texts.overrides,
        crop: texts.crop,
        size: texts.size,
    })
}

/// Reads which part of a picture a PNG file shows, and the scene and its overrides if they are not
/// too long. Nothing after the start of the pixels is read.
///
/// # Errors
///
/// The file is damaged, shows no part, or contains an invalid text, too much text or too many
/// overrides.
pub fn read_part(picture: &[u8]) -> Result<(Part, Option<Recipe>), NotOurs> {
    let texts = StoredTexts::read(picture)?;
    let part = || {
        Some(Part {
            area: texts.crop?,
            size: texts.size?,
            digest: texts.digest?,
        })
    };
    let part = part().ok_or(NotOurs::NoPart)?;
    let recipe = texts.scene.map(|scene| Recipe {
        scene,
        overrides: texts.overrides,
        crop: texts.crop,
        size: texts.size,
    });
    Ok((part, recipe))
}

/// The texts of a PNG file that Pinhole wrote. A text that is missing is `None`.
#[derive(Default)]
struct StoredTexts {
    scene: Option<String>,
    overrides: Vec<String>,
    crop: Option<Area>,
    size: Option<[u32; 2]>,
    digest: Option<String>,
}

impl StoredTexts {
    fn read(picture: &[u8]) -> Result<Self, NotOurs> {
        let mut rest = picture.strip_prefix(&SIGNATURE).ok_or(NotOurs::Damaged)?;
        let mut found = Self::default();
        let mut left = TEXT_LIMIT;
        loop {
            let (kind, content);
            (kind, content, rest) = chunk(rest).ok_or(NotOurs::Damaged)?;
            let (keyword, is_packed, text) = match kind {
                b"IDAT" => break,
                b"iTXt" => international_text(content).ok_or(NotOurs::Damaged)?,
                _ => continue,
            };
            let keyword = [SCENE, SET, CROP, SIZE, DIGEST]
                .into_iter()
                .find(|ours| ours.as_bytes() == keyword);
            let Some(keyword) = keyword else { continue };
            let is_of_scene = keyword == SCENE || keyword == SET;
            let limit = if is_of_scene { left } else { PART_LIMIT };
            let text = if is_packed {
                fdeflate::decompress_to_vec_bounded(text, limit).map_err(not_unpacked)?
            } else if text.len() > limit {
                return Err(NotOurs::TooMuchText);
            } else {
                text.to_owned()
            };
            if is_of_scene {
                left -= text.len();
            }
            let text = String::from_utf8(text).map_err(|_| NotOurs::NotUtf8)?;
            match keyword {
                SCENE => found.scene = Some(text),
                SET if found.overrides.len() == OVERRIDES_LIMIT => {
                    return Err(NotOurs::TooManyOverrides);
                }
                SET => found.overrides.push(text),
                CROP => found.crop = Some(text.parse().map_err(|_| NotOurs::Crop(text))?),
                SIZE => found.size = Some(size(&text).ok_or(NotOurs::Crop(text))?),
                _ => found.digest = Some(text),
            }
        }
        Ok(found)
    }
}

/// Parses the numbers of columns and rows of a picture, written as `W,H`. Returns `None` if the
/// text has another form.
fn size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once(',')?;
    Some([width.parse().ok()?, height.parse().ok()?])
}

/// Reads a chunk of a PNG. Returns its type, its content, and the bytes after it. For the chunk of
/// pixels, only the type is returned. Returns `None` if the chunk is cut off or its checksum is
/// wrong.
fn chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
    if rest.starts_with(b"IDAT") {
        // If `bytes` is only the start of a file, the chunk of pixels is incomplete, so it is not
        // checked.
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

#[cfg(test)]
mod tests {
    use png::text_metadata::{EncodableTextChunk, ITXtChunk};

    use super::*;

    #[test]
    fn a_compressor_that_is_used_again_writes_the_same_chunks_as_a_new_one() {
        let recipe = Recipe {
            scene: "sphere { center (0, 1, 0) }\n".repeat(1000),
            overrides: (0..20).map(|i| format!("image.width={i}")).collect(),
            crop: None,
            size: None,
        };
        let film = Film::<[u8; 3]>::new(1, 1).expect("there is memory for a pixel");
        let mut file = Vec::new();
        write_png(&film, Some(&recipe), &mut file).expect("a list can be written to");
        let mut chunks = Vec::new();
        for (keyword, text) in texts(&recipe) {
            let mut chunk = ITXtChunk::new(keyword, text);
            chunk.compressed = true;
            chunk.encode(&mut chunks).expect("the text can be packed");
        }
        let is_there = file.windows(chunks.len()).any(|bytes| bytes == chunks);
        assert!(!chunks.is_empty() && is_there);
    }
}
