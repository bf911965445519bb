//! Reports on Pinhole itself: how accurate its decisions and numbers are, and how fast its sampling
//! methods reach an error.

pub mod numerics;
pub mod speed;
