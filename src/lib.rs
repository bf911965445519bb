//! Pinhole reads a small declarative scene language and renders what it describes through a virtual pinhole camera.

pub mod area;
pub mod color;
pub mod math;
pub mod source;

pub mod scene;
pub mod tracer;

pub mod film;
pub mod render;
pub mod sampling;
