//! The library's front: a text becomes a [`Scene`], and a scene a [`Picture`].
//!
//! In: texts, and data that a program changes. Out: pictures in memory and in files, and verdicts
//! on other pictures. Everything is done by the stages; only a whole scene without mistakes gets
//! to them from here. The crate's root exports these names.

mod error;
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
