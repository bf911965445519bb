//! What Pinhole says about itself: how right its decisions and numbers are, and how fast its methods come how near the truth.

pub mod numerics;
#[cfg(feature = "report")]
pub mod speed;
