//! What a ray can hit: the scene's objects as seen from the eye.
//!
//! In: a [`Scene`](crate::scene::Scene). Out: for a sample point of the picture, the colour seen there, as a slot of the
//! palette. No text and no names: an object is its index in the file.
//!
//! All rays share the eye, so everything happens in the view plane: boundaries are lines and conics there, and of the
//! surfaces at a point the nearest is the one with the greatest inverse depth, a linear form for everything flat. What does
//! not depend on the sample point is prepared once per picture; which objects a ray may meet at all, a quadtree over the view plane
//! knows. Every decision is made in `f64` with a bound on its error;
//! what that leaves in doubt is decided in double-double, and what that leaves in doubt, in big numbers.

mod boards;
mod boundaries;
mod camera;
mod checkerboard;
mod cover;
mod crossing;
mod cuboid;
mod curve;
mod extent;
mod form;
mod hierarchy;
mod object;
mod outlook;
mod pixel;
mod quartering;
mod sphere;
#[cfg(test)]
mod tests;
mod triangle;
mod world;

pub use boards::{Boards, PIXELS, Views};
pub use camera::{Basis, Point};
pub use curve::{Conic, Curve, Line};
pub use outlook::{Board, Live, Spot};
pub use pixel::{Checks, Pixel};
pub use quartering::{GRID, Part, Quartering, Room};
pub use triangle::vertices;
pub use world::{Hit, Precision, World};
