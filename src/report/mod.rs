//! Reports on Pinhole itself: how accurate its arithmetic is, and how fast the errors of its
//! sampling methods decrease with more samples.

pub mod numerics;
pub mod speed;
