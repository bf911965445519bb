//! A picture as a file contains it, and why a file is none.

use image::ImageFormat;
use thiserror::Error;

use super::{memory::TooLarge, pixels::Film};
use crate::area::Area;

/// Maximum number of bytes that a picture is decoded to, unless the caller allows more: 2^26 pixels
/// of four bytes, whose film takes 1.5 GiB.
pub const DECODED_LIMIT: u64 = 1 << 28;

/// A picture as a file contains it.
#[derive(Clone, Debug)]
pub struct Picture {
    /// The means in linear light.
    pub film: Film,
    /// The rounding of the file's numbers.
    pub rounding: Rounding,
    /// Other changes that the file's coding makes to colours.
    pub coding: Coding,
    /// The part of a whole picture that it is, if the file says so.
    pub crop: Option<Area>,
    /// The opacity; `None` for an opaque picture.
    pub opacity: Option<Opacity>,
}

/// The opacity of a picture.
#[derive(Clone, Debug)]
pub struct Opacity {
    /// Least and greatest opacity of its pixels, from 0 to 1.
    pub range: [f64; 2],
    /// The colours of the picture without their opacity.
    pub film: Film,
}

/// The numbers that a file's values are rounded to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// Bytes of sRGB, or fewer bits.
    Byte,
    /// 16 bits of sRGB.
    Word,
    /// Floats of 16 bits, in linear light.
    Half,
    /// Floats of 32 bits, in linear light.
    Float,
}

impl Rounding {
    /// Maximum rounding error of a number between 0 and 1, in steps of 8-bit sRGB; a step is 1/255
    /// of the way from black to white.
    ///
    /// That of floats is their relative rounding, 2^−11 or 2^−24 of the light, times the 255 ·
    /// 1.055/2.4 steps per unit of light at white, where this product is greatest, rounded up.
    pub fn steps(self) -> f64 {
        match self {
            Self::Byte => 0.5,
            Self::Word => 0.5 / 257.0,
            Self::Half => 0.06,
            Self::Float => 1e-5,
        }
    }
}

/// What a file's coding does to colours besides rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// Nothing.
    Exact,
    /// Colours change where that is hardly visible: JPEG, and one kind of WebP.
    Lossy,
    /// Colours are replaced by the nearest of at most 256: GIF.
    Palette,
    /// The file declares a curve other than sRGB's, but is read as sRGB: a PNG's `gAMA` or `iCCP`.
    OtherCurve,
    /// A PNM after a byte order mark or lines of text, which are skipped.
    TextBefore,
    /// A PNM whose numbers are in UTF-16.
    Utf16,
    /// A PNM of bytes in which every line feed had become two bytes, as in a text file.
    TextMode,
    /// A PNM of bytes in which each byte above 127 had become two, as in UTF-8 text.
    Utf8,
}

impl Coding {
    /// Returns a warning for people who compare such a picture.
    pub fn warning(self) -> Option<&'static str> {
        match self {
            Self::Exact => None,
            Self::Lossy => Some(
                "its coding is lossy and changes colours, most of all where they meet: a PNG keeps them",
            ),
            Self::Palette => Some("it has 256 colours at most: a PNG keeps all of them"),
            Self::TextBefore => Some(
                "there is text before the picture, which most programs cannot read so: print it to standard error",
            ),
            Self::Utf16 => Some(
                "it is UTF-16, as `>` of PowerShell makes it, which most programs cannot read: have the program write the file itself",
            ),
            Self::TextMode => Some(
                "each of its line feeds had become CR LF, which most programs cannot read so: open the file in binary mode (\"wb\")",
            ),
            Self::Utf8 => Some(
                "each of its bytes above 127 had become two, as in a text of UTF-8, which most programs cannot read so: open the file in binary mode (\"wb\"), and write bytes",
            ),
            Self::OtherCurve => Some(
                "its gAMA or iCCP says that its numbers follow another curve than sRGB's, and they are read as sRGB",
            ),
        }
    }
}

/// Why a file is no picture.
#[derive(Debug, Error)]
pub enum Unreadable {
    /// The file is no picture, or has a format that is not read.
    #[error(
        "it is no picture in PNG, OpenEXR, PNM, BMP, TIFF, WebP, GIF or JPEG, the formats that are read here{}",
        .0.map_or(String::new(), |format| format!(", but seems to be {}", name(format)))
    )]
    Format(Option<ImageFormat>),
    /// The file is something else that is known.
    #[error("it is no picture, but {0}")]
    Other(&'static str),
    /// The file does not follow its format.
    #[error(
        "it begins as {format} files do, but is damaged or cut off: {}",
        shortened(cause)
    )]
    Damaged {
        /// The format's name.
        format: String,
        /// The defect.
        cause: String,
    },
    /// The file uses a part of its format that is not supported here.
    #[error("it is {format} of a kind that is not read here: {}", shortened(cause))]
    Unsupported {
        /// The format's name.
        format: String,
        /// The part that is not supported.
        cause: String,
    },
    /// Decompression takes too much memory, besides that of the picture itself.
    #[error("unpacking it takes more than 512 MiB of memory")]
    Unpacking,
    /// The picture is larger than the limit.
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
    /// The picture has no columns or no rows.
    #[error("it has {0} × {1} pixels, and so none at all")]
    Empty(u64, u64),
    /// There is not enough memory for the picture.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// A value is infinite or NaN.
    #[error("its pixel ({x}, {y}) holds a value that is no finite number")]
    NotFinite {
        /// The column.
        x: u32,
        /// The row.
        y: u32,
    },
}

/// Returns the name of a format.
pub(super) fn name(format: ImageFormat) -> String {
    format!("{format:?}").to_uppercase()
}

/// Rejects a picture without pixels, or one that is decoded to more than `limit` bytes, with four
/// channels of `channel` bytes each.
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

/// Shortens a decoder's message, which may contain a part of the file of any length.
fn shortened(cause: &str) -> String {
    const LONGEST: usize = 200;
    let mut characters = cause.trim_end().chars();
    let mut short: String = characters.by_ref().take(LONGEST).collect();
    if characters.next().is_some() {
        short.push('…');
    }
    short
}
