//! The reasons why a file cannot be read as a picture.

use image::ImageFormat;
use thiserror::Error;

use super::memory::TooLarge;

/// Maximum length, in bytes, of a decoded picture, unless the caller allows more. A larger picture
/// is rejected, so that it cannot fill the memory. The limit allows 2^26 pixels of four bytes. A
/// film of this size has 24 bytes per pixel, i.e. 1.5 GiB.
pub const DECODED_LIMIT: u64 = 1 << 28;

/// Error: a file cannot be read as a picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Unreadable {
    /// The file is no picture, or its format is not supported.
    #[error(
        "it is no picture in PNG, OpenEXR, PNM, BMP, TIFF, WebP, GIF or JPEG, the formats that are read here{}",
        .0.as_ref().map_or(String::new(), |format| format!(", but seems to be {format}"))
    )]
    Format(Option<String>),
    /// The file is not a picture, but of another known kind, for example a web page. The text
    /// describes it.
    #[error("it is no picture, but {0}")]
    Other(&'static str),
    /// The file does not follow the rules of its format, so it is damaged or cut off.
    #[error(
        "it begins as {format} files do, but is damaged or cut off: {}",
        shortened(cause)
    )]
    Damaged {
        /// Name of the file's format.
        format: String,
        /// Description of the defect.
        cause: String,
    },
    /// The file uses a feature of its format that is not supported.
    #[error("it is {format} of a kind that is not read here: {}", shortened(cause))]
    Unsupported {
        /// Name of the file's format.
        format: String,
        /// Description of the feature.
        cause: String,
    },
    /// Decompressing the file needs more memory than the decoder may use in addition to the
    /// picture.
    #[error("unpacking it takes more than 512 MiB of memory")]
    Unpacking,
    /// The decoded picture would have more bytes than the limit that the caller set.
    #[error(
        "it has {width} × {height} pixels, which are decoded to more than the {limit} bytes that are read"
    )]
    Large {
        /// The number of columns.
        width: u64,
        /// The number of rows.
        height: u64,
        /// Maximum number of decoded bytes.
        limit: u64,
    },
    /// The picture has no columns or no rows. The fields are the numbers of columns and rows.
    #[error("it has {0} × {1} pixels, and so none at all")]
    Empty(u64, u64),
    /// There is not enough memory for the picture.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// A channel of a pixel is infinite or NaN.
    #[error("its pixel ({x}, {y}) holds a value that is no finite number")]
    NotFinite {
        /// Column of the pixel.
        x: u32,
        /// Row of the pixel.
        y: u32,
    },
}

/// Returns the name of an image format in capital letters.
pub(super) fn name(format: ImageFormat) -> String {
    format!("{format:?}").to_uppercase()
}

/// Rejects a picture that has no pixels or would need more than `limit` bytes when it is decoded.
/// Pixels are assumed to have four channels of `channel` bytes each.
pub(super) fn check_size(
    [width, height]: [u64; 2],
    channel: u64,
    limit: u64,
) -> Result<(), Unreadable> {
    let large = Unreadable::Large {
        width,
        height,
        limit,
    };
    match width
        .checked_mul(height)
        .and_then(|n| n.checked_mul(4 * channel))
    {
        Some(0) => Err(Unreadable::Empty(width, height)),
        Some(bytes) if bytes <= limit => Ok(()),
        _ => Err(large),
    }
}

/// Shortens a decoder's message to 200 characters, since a message may repeat a long part of the
/// file.
fn shortened(cause: &str) -> String {
    const LONGEST: usize = 200;
    let mut characters = cause.trim_end().chars();
    let mut short: String = characters.by_ref().take(LONGEST).collect();
    if characters.next().is_some() {
        short.push('…');
    }
    short
}
