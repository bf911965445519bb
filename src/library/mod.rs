//! The library's main types: a text becomes a [`Scene`], and a scene a [`Picture`].
//!
//! A scene is made from a text or from data that a program has changed. A picture is in memory, can
//! be written to a file, and can be compared with a scene if another program made it. These types
//! check scenes for mistakes before other modules work on them. The crate's root exports the types.

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
