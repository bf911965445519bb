//! A picture as a file holds it, and why a file is none.

use image::ImageFormat;
use thiserror::Error;

use super::{memory::TooLarge, pixels::Film};
use crate::area::Area;

/// Maximum number of bytes that a picture is decoded to, unless it is said that it may be larger:
/// of 2^26 pixels with four bytes each, whose film takes 1.5 GiB.
pub const DECODED_LIMIT: u64 = 1 << 28;

/// A picture as a file holds it.
#[derive(Clone, Debug)]
pub struct Picture {
    /// Its means in linear light.
    pub film: Film,
    /// How its numbers are rounded.
    pub rounding: Rounding,
    /// What else its coding does to them.
    pub coding: Coding,
    /// The part of a whole picture that it is, if it says so.
    pub crop: Option<Area>,
    /// How transparent it is, if it is.
    pub opacity: Option<Opacity>,
}

/// How transparent a picture is.
#[derive(Clone, Debug)]
pub struct Opacity {
    /// The least and the greatest of its pixels, from 0 to 1.
    pub range: [f64; 2],
    /// The picture as it would be if it were opaque.
    pub film: Film,
}

/// What the numbers of a file are rounded to.
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
    /// How far it may move a number between 0 and 1, in steps of 8-bit sRGB; a step is 1/255 of the
    /// way from black to white.
    ///
    /// The floats' part is their relative rounding 2^−11 or 2^−24 of the light, times the 255 ·
    /// 1.055/2.4 steps of a unit of light at white, where that product is greatest, rounded up.
    pub fn steps(self) -> f64 {
        match self {
            Self::Byte => 0.5,
            Self::Word => 0.5 / 257.0,
            Self::Half => 0.06,
            Self::Float => 1e-5,
        }
    }
}

/// What a file's coding does to colours besides rounding them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coding {
    /// Nothing.
    Exact,
    /// It changes them where that is hardly seen: JPEG, and one kind of WebP.
    Lossy,
    /// It replaces them by the nearest of at most 256: GIF.
    Palette,
    /// It says that they follow another curve than sRGB's, as which they are read: a PNG's `gAMA`
    /// or `iCCP`.
    OtherCurve,
    /// It is a PNM with a mark or lines of text in front, which are passed over.
    TextBefore,
    /// It is a PNM of numbers in UTF-16.
    Utf16,
    /// It is a PNM of bytes in which every line feed had become two, as in a text.
    TextMode,
    /// It is a PNM of bytes in which all above 127 had become two, as letters of a text in UTF-8.
    Utf8,
}

impl Coding {
    /// What whoever compares such a picture should know.
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
    /// It is none, or of a format that is not read.
    #[error(
        "it is no picture in PNG, OpenEXR, PNM, BMP, TIFF, WebP, GIF or JPEG, the formats that are read here{}",
        .0.map_or(String::new(), |format| format!(", but seems to be {}", name(format)))
    )]
    Format(Option<ImageFormat>),
    /// It is something else.
    #[error("it is no picture, but {0}")]
    Other(&'static str),
    /// It does not follow its format.
    #[error(
        "it begins as {format} files do, but is damaged or cut off: {}",
        shortened(cause)
    )]
    Damaged {
        /// The format's name.
        format: String,
        /// What is wrong.
        cause: String,
    },
    /// It uses a part of its format that is not read here.
    #[error("it is {format} of a kind that is not read here: {}", shortened(cause))]
    Unsupported {
        /// The format's name.
        format: String,
        /// What is not read.
        cause: String,
    },
    /// To unpack it takes too much memory, besides what the picture itself takes.
    #[error("unpacking it takes more than 512 MiB of memory")]
    Unpacking,
    /// It is larger than pictures that are read.
    #[error(
        "it has {width} × {height} pixels, which are decoded to more than the {limit} bytes that are read"
    )]
    Large {
        /// The number of columns.
        width: u64,
        /// The number of rows.
        height: u64,
        /// How many bytes are decoded at most.
        limit: u64,
    },
    /// It has no columns or no rows.
    #[error("it has {0} × {1} pixels, and so none at all")]
    Empty(u64, u64),
    /// There is no memory for it.
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

/// What a format is called.
pub(super) fn name(format: ImageFormat) -> String {
    format!("{format:?}").to_uppercase()
}

/// Refuses a picture that is decoded to more bytes than this, with four channels of so many bytes,
/// or has no pixels.
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

/// What a decoder says, which may hold a part of the file of any length.
fn shortened(cause: &str) -> String {
    const LONGEST: usize = 200;
    let mut characters = cause.trim_end().chars();
    let mut short: String = characters.by_ref().take(LONGEST).collect();
    if characters.next().is_some() {
        short.push('…');
    }
    short
}
