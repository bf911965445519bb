//! Arithmetic that is the same on every machine: angles, sin and kin by way of libm, and questions answered exactly.

mod angle;
pub mod exact;
pub mod trig;

pub use angle::Angle;
