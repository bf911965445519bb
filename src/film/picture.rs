//! A picture as a file contains it.

use super::pixels::Film;
use crate::area::Area;

/// A picture as a file contains it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// Mean of each pixel, in linear light.
    pub film: Film,
    /// Format to which the file's numbers are rounded.
    pub rounding: Rounding,
    /// Changes of colours by the file's coding, besides rounding.
    pub coding: Coding,
    /// Part of a whole picture that the file shows, if the file says so.
    pub crop: Option<Area>,
    /// Opacity of the pixels; `None` for an opaque picture.
    pub opacity: Option<Opacity>,
}

impl Picture {
    /// Makes an opaque picture of a whole film, whose numbers are rounded so.
    pub fn new(film: Film, rounding: Rounding) -> Self {
        Self {
            film,
            rounding,
            coding: Coding::Exact,
            crop: None,
            opacity: None,
        }
    }
}

/// The opacity of a picture.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Opacity {
    /// Least and greatest opacity of the pixels, from 0 to 1.
    pub range: [f64; 2],
    /// Colours of the picture, in linear light, without regard to the opacity.
    pub film: Film,
}

/// Format to which a file's values are rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rounding {
    /// Bytes of sRGB, or numbers of fewer bits.
    Byte,
    /// Words of sRGB, which have 16 bits.
    Word,
    /// Floats of 16 bits, in linear light.
    Half,
    /// Floats of 32 bits, in linear light.
    Float,
}

impl Rounding {
    /// Returns the maximum rounding error of a number between 0 and 1, in steps of 8-bit sRGB; a
    /// step is 1/255 of the way from black to white.
    ///
    /// A float has a relative rounding error of 2^−11 or 2^−24. The error in steps is greatest at
    /// white, where the sRGB curve has 255 · 1.055/2.4 steps per unit of light. The product is
    /// rounded up.
    pub fn steps(self) -> f64 {
        match self {
            Self::Byte => 0.5,
            Self::Word => 0.5 / 257.0,
            Self::Half => 0.06,
            Self::Float => 1e-5,
        }
    }
}

/// The effect of a file's coding on colours besides rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Coding {
    /// No effect: apart from rounding, the file has the colours that the program computed.
    Exact,
    /// JPEG or lossy WebP: colours are changed where this is hardly visible.
    Lossy,
    /// GIF: colours are replaced by the nearest of at most 256.
    Palette,
    /// The file declares a curve other than sRGB's, by a PNG's `gAMA` or `iCCP`, but is read as
    /// sRGB.
    OtherCurve,
    /// A PNM behind a byte order mark or lines of text, which are skipped.
    TextBefore,
    /// A PNM in UTF-16, as some shells write the output of a program.
    Utf16,
    /// A binary PNM in which every line feed was replaced by two bytes, as in a text file.
    TextMode,
    /// A binary PNM in which each byte above 127 was replaced by two bytes, as in UTF-8 text.
    Utf8,
}

impl Coding {
    /// Returns a warning for users who compare a picture with this coding. Returns `None` for
    /// [`Exact`](Self::Exact).
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
