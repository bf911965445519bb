//! Pictures in memory, and the files that they are written to and read from.
//!
//! In: the number of samples of each colour in a pixel. Out: their mean in linear light (`mean`),
//! `pixels` in memory, and picture files (`png`, which also contains the scene, `animation` of
//! several pictures, and `exr`). `read` reads a `picture` from a file of any program. It decodes
//! some formats in modules of their own, such as `pnm` and `read_exr`, and the others with
//! libraries. `compare` measures the differences of two pictures, and `embed` encodes a picture for
//! an HTML page.

#[cfg(feature = "png")]
mod animation;
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
#[cfg(feature = "cli")]
mod part_file;
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
#[cfg(any(feature = "exr", feature = "png"))]
mod recipe;
mod srgb;
#[cfg(feature = "read")]
mod unreadable;

#[cfg(feature = "png")]
pub use self::animation::Animation;
#[cfg(feature = "pages")]
#[doc(hidden)]
pub use self::embed::{data_uri, reduced};
#[cfg(feature = "exr")]
pub use self::exr::{write_exr, write_exr_bands};
#[cfg(feature = "png")]
pub use self::png::{NotOurs, SIGNATURE, read_part, read_recipe, write_png, write_png_bands};
#[cfg(any(feature = "exr", feature = "png"))]
pub use self::recipe::{OVERRIDES_LIMIT, Part, Recipe, TEXT_LIMIT};
pub use self::{
    compare::{
        CHANNELS, Comparison, HEAT_LEGEND, Largest, SizesDiffer, Tolerance, compare, heat_map,
        heat_map_up_to, rmse,
    },
    memory::TooLarge,
    picture::{Coding, Opacity, Picture, Rounding},
    pixels::{AsBytes, AsFloats, Film, Pixel, WrongPixelCount, certified},
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
#[cfg(feature = "cli")]
#[doc(hidden)]
pub use self::{
    part::place_of_part,
    part_file::{FileRows, exr_rows, png_rows, read_exr_place},
};
