//! Arithmetic that is the same on every machine: angles, and sin and kin by way of libm.

mod angle;

pub use angle::Angle;
