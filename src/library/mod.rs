//! The library's main types: a text becomes a [`Scene`], and a scene a [`Picture`].
//!
//! In: texts, or data that a program has changed. Out: pictures in memory and in files, and
//! verdicts on pictures of other programs. These types check scenes for mistakes before other
//! modules work on them. The crate's root exports the types.

mod error;
mod mistakes;
#[cfg(feature = "png")]
mod opening;
mod picture;
#[cfg(feature = "read")]
mod reading;
#[cfg(any(feature = "exr", feature = "png"))]
mod saving;
mod scene;

pub use self::{
    error::Error,
    picture::{Exact, Picture},
    scene::Scene,
};
