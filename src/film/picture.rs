//! A picture that was read from a file.

use super::pixels::Film;
use crate::area::Area;

/// A picture that was read from a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// Pixels in linear light.
    pub film: Film,
    /// Precision to which the file's numbers are rounded.
    pub rounding: Rounding,
    /// Change of colours by the file's format, besides rounding.
    pub coding: Coding,
    /// The part of the whole picture that the file contains. `None` if the file contains the whole
    /// picture, or does not say which part it contains.
    pub crop: Option<Area>,
    /// Numbers of columns and rows of the whole picture. `None` if `crop` is `None`, or if the file
    /// does not give them.
    pub size: Option<[u32; 2]>,
    /// Opacity of the pixels; `None` if all are opaque.
    pub opacity: Option<Opacity>,
    /// Digest of the scene and its overrides, from an EXR file that Pinhole wrote. Otherwise
    /// `None`.
    pub digest: Option<String>,
}

impl Picture {
    /// Makes an opaque, uncropped picture from a film whose numbers are rounded as `rounding` says.
    pub fn new(film: Film, rounding: Rounding) -> Self {
        Self {
            film,
            rounding,
            coding: Coding::Exact,
            crop: None,
            size: None,
            opacity: None,
            digest: None,
        }
    }
}

/// The opacity of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Opacity {
    /// Least and greatest opacity of the pixels, from 0 to 1.
    pub range: [f64; 2],
    /// Colours of the pixels before they are mixed with black according to their opacity, in linear
    /// light.
    pub film: Film,
}

/// Precision to which the numbers in a file are rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rounding {
    /// Whole numbers of at most 8 bits, in sRGB.
    Byte,
    /// Whole numbers of 16 bits, in sRGB.
    Word,
    /// Floats of 16 bits, in linear light.
    Half,
    /// Floats of 32 bits, in linear light.
    Float,
}

impl Rounding {
    /// Returns the maximum rounding error of a number between 0 and 1, in steps of 8-bit sRGB, i.e.
    /// in 1/255 of the way from black to white.
    ///
    /// Floats have relative rounding errors of 2^−11 (16 bits) or 2^−24 (32 bits). The error in
    /// steps is greatest at white, where the slope of the sRGB curve is 255 · 1.055/2.4 steps per
    /// unit of light. The values for floats are this slope times 2^−11 or 2^−24, rounded up.
    pub fn steps(self) -> f64 {
        match self {
            Self::Byte => 0.5,
            Self::Word => 0.5 / 257.0,
            Self::Half => 0.06,
            Self::Float => 1e-5,
        }
    }
}

/// Change of colours by a file's format, besides rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Coding {
    /// No change: the colours are those that the program computed.
    Exact,
    /// Lossy compression, as in a JPEG or in some WebP files: colours are changed where this is
    /// hardly visible.
    Lossy,
    /// A palette, as in a GIF: each colour is replaced by the nearest of at most 256.
    Palette,
    /// The file declares another brightness curve than sRGB's, by a PNG's chunk `gAMA` or `iCCP`,
    /// but is read as sRGB.
    OtherCurve,
    /// A PNM with a byte order mark or lines of text before it, which are skipped.
    TextBefore,
    /// A PNM in UTF-16, as some shells write the output of a program.
    Utf16,
    /// A binary PNM in which a carriage return was inserted before every line feed, as Windows does
    /// in text files.
    TextMode,
    /// A binary PNM in which each byte above 127 became two bytes, because the program wrote it as
    /// UTF-8 text.
    Utf8,
}

impl Coding {
    /// Returns a warning for users about the change of colours, or `None` if there is none.
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
