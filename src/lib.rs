//! Pinhole reads a small declarative scene language and renders what it describes through a virtual pinhole camera.

pub mod area;
pub mod color;
pub mod diagnostic;
pub mod math;
pub mod numbers;
pub mod source;
pub mod suggest;

pub mod syntax;

pub mod scene;
pub mod tracer;

pub mod sampling;

pub mod render;

pub mod film;

pub mod inspect;
pub mod probe;
