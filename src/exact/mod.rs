//! A pixel's mean computed rather than sampled: what the infinite board adds up to over a part of a pixel.
//!
//! In come polygons and arcs of conics in the picture, in pixels from the pixel's centre; out goes an integral together with
//! a bound on its error. Which part of a pixel shows which object, and every colour, is left to the caller.
//!
//! [`Board`] is the integral of the board's sign, [`Arc`] an arc of a conic. Few squares are cut out one by one (`cells`);
//! many are summed along the region's boundary (`edge`), and those that pile up at the horizon by their Fourier series
//! (`horizon`).
#![allow(dead_code, unused_imports)]

mod arc;
mod board;
mod cells;
mod edge;
mod euler;
mod horizon;
mod sliver;
#[cfg(test)]
mod tests;

pub(crate) use arc::Arc;
pub(crate) use board::{Board, Sum};
