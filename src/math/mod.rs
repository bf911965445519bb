//! Arithmetic in three precisions, trigonometry, and exact predicates. Results are the same on
//! every machine.
//!
//! [`Real`] is the arithmetic of one precision: `f64`, [`Double`] (double-double) or [`Big`]. A
//! [`Ball`] is a number with an error bound. A decision about a ball is either certain or a
//! [`Doubt`], which the next higher precision resolves.

mod angle;
mod ball;
mod big;
mod double;
mod dyadic;
pub mod predicates;
mod radius;
mod real;
mod simd_width;
mod sine;
pub mod trig;
mod unit;

pub use angle::Angle;
pub use ball::{Ball, Ball3, Doubt, UP, cross, dot};
pub use big::{Big, compare_half_turns};
pub use double::{Double, two_product, two_sum};
pub use dyadic::{Dyadic, Dyadic3};
pub use radius::{Radius, Wide};
pub use real::{ROUND, Real, floor};
pub use simd_width::{HAS_WIDER, SimdWidth};
pub use sine::sin_cos;
pub use unit::unit;
