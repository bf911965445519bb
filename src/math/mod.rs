//! Arithmetic that is the same on every machine, in three precisions, sine and kin, and questions
//! answered exactly.
//!
//! [`Real`] is the arithmetic of one precision: `f64`, [`Double`] (double-double) or [`Big`]. A
//! [`Ball`] is a number with a bound on its error, so that a decision either is certain or says
//! that it is in [`Doubt`]; the next precision then decides.

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

pub use angle::Angle;
pub use ball::{Ball, Ball3, Doubt, UP, cross, dot};
pub use big::{Big, compare_half_turns};
pub use double::{Double, two_product, two_sum};
pub use dyadic::{Dyadic, Dyadic3};
pub use radius::{Radius, Wide};
pub use real::{ROUND, Real, floor};
pub use simd_width::{HAS_WIDER, SimdWidth};
pub use sine::sin_cos;
