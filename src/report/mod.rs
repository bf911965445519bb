//! What Pinhole says about itself: how right its decisions and numbers are, and in what time its
//! methods come to what error.

pub mod numerics;
#[cfg(feature = "report")]
pub mod speed;
