//! Pixels in memory, and the files they are written to and read from.
//!
//! In: how often each colour was seen in a pixel. Out: its mean in linear light (`mean`), the
//! `pixels` in memory, and a picture file: `png`, which contains the scene, or `exr`. `read` reads
//! a `picture` from a file, also from files of other programs (`read_exr`, `pnm`, `jpeg`). `compare` measures how much two
//! films differ, and `embed` puts a film into a page.

mod compare;
#[cfg(feature = "pages")]
mod embed;
#[cfg(feature = "exr")]
mod exr;
#[cfg(feature = "read")]
mod jpeg;
mod mean;
mod memory;
#[cfg(feature = "read")]
mod no_picture;
#[cfg(feature = "cli")]
mod part;
mod picture;
mod pixels;
#[cfg(feature = "png")]
mod png;
#[cfg(feature = "read")]
mod pnm;
#[cfg(feature = "read")]
mod read;
#[cfg(feature = "read")]
mod read_exr;
mod srgb;
#[cfg(feature = "read")]
mod unreadable;

#[cfg(feature = "pages")]
#[doc(hidden)]
pub use self::embed::{data_uri, reduced};
#[cfg(feature = "exr")]
pub use self::exr::{LinearFilm, write_exr};
#[cfg(feature = "cli")]
#[doc(hidden)]
pub use self::part::place_of_part;
#[cfg(feature = "png")]
pub use self::png::{
    NotOurs, OVERRIDES_LIMIT, Recipe, SIGNATURE, TEXT_LIMIT, read_recipe, write_png,
};
pub use self::{
    compare::{
        CHANNELS, Comparison, HEAT_LEGEND, Largest, SizesDiffer, Tolerance, compare, heat_map, rmse,
    },
    memory::TooLarge,
    picture::{Coding, Opacity, Picture, Rounding},
    pixels::{AsBytes, Film, Pixel, certified},
    srgb::Encoder,
};
#[cfg(feature = "read")]
pub use self::{
    jpeg::{Jpeg, JpegTable},
    read::{is_picture, is_picture_behind_lines, read_picture, read_picture_up_to},
    unreadable::{DECODED_LIMIT, Unreadable},
};
#[doc(hidden)]
pub use self::{mean::mean, memory::reserve as reserve_memory};
