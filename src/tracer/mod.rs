//! What a ray can hit: the scene's objects as seen from the eye.
//!
//! In: a [`Scene`](crate::scene::Scene). Out: for a sample point of the picture, the colour seen there, as a slot of the
//! palette. No text and no names: an object is its index in the file.

mod world;

pub use world::World;
