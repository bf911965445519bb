//! What Pinhole says about itself: how right its decisions and numbers are.

pub mod numerics;
