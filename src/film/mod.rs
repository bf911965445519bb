//! Pictures in memory, and the files that they are written to and read from.
//!
//! In: the number of samples of each colour in a pixel. Out: their mean in linear light (`mean`),
//! `pixels` in memory, and picture files (`png`, which also contains the scene, and `exr`). `read`
//! reads a `picture` from a file of any program. `compare` measures the differences of two
//! pictures, and `embed` encodes them for an HTML page.

mod compare;
#[cfg(any(feature = "cli", feature = "report"))]
mod embed;
mod exr;
mod jpeg;
mod mean;
mod memory;
mod no_picture;
#[cfg(feature = "cli")]
mod part;
mod picture;
mod pixels;
mod png;
mod pnm;
mod read;
mod srgb;

#[cfg(any(feature = "cli", feature = "report"))]
#[doc(hidden)]
pub use self::embed::{data_uri, reduced};
#[cfg(feature = "cli")]
#[doc(hidden)]
pub use self::part::place_of_part;
pub use self::{
    compare::{
        CHANNELS, Comparison, HEAT_LEGEND, Largest, SizesDiffer, Tolerance, compare, heat_map, rmse,
    },
    exr::{LinearFilm, write_exr},
    jpeg::{Jpeg, JpegTable},
    memory::TooLarge,
    picture::{Coding, DECODED_LIMIT, Opacity, Picture, Rounding, Unreadable},
    pixels::{AsBytes, Film, Pixel, certified},
    png::{NotOurs, OVERRIDES_LIMIT, Recipe, SIGNATURE, TEXT_LIMIT, read_recipe, write_png},
    read::{is_picture, is_picture_behind_lines, read_picture, read_picture_up_to},
    srgb::Encoder,
};
#[doc(hidden)]
pub use self::{mean::mean, memory::reserve as reserve_memory};
