//! What a ray can hit: the scene's objects as seen from the eye.
//!
//! In: a [`Scene`](crate::scene::Scene). Out: for a sample point of the picture, the colour seen
//! there, as a slot of the palette. No text and no names: an object is its index in the file.
//!
//! All rays share the eye, so everything happens in the view plane: boundaries are lines and conics
//! there, and of the surfaces at a point the nearest is the one with the greatest inverse depth, a
//! linear form for everything flat. What does not depend on the sample point is prepared once per
//! picture; which objects a ray may meet at all, a quadtree over the view plane knows. Every
//! decision is made in `f64` with a bound on its error; what that leaves in doubt is decided in
//! double-double, and what that leaves in doubt, in big numbers.

mod camera;
mod crossing;
mod form;
mod local_form;
mod sub_pixel;

mod checkerboard;
mod convex;
mod cuboid;
mod curve;
mod interval;
mod object;
mod pieces;
mod sphere;
mod triangle;

mod bounds2d;
mod quadtree;
mod world;

pub mod candidates;
mod checker_corners;
pub(crate) mod nearby;
mod quartering;
mod ray;
pub mod samples;

#[cfg(test)]
mod tests;

pub use camera::{Basis, Point};
pub use candidates::Candidate;
pub use checker_corners::Checks;
pub(crate) use checker_corners::Squares;
pub use curve::{Conic, Curve, Line};
pub(crate) use curve::{LOOSE_LINE, SubPixelFrame, Surface};
pub(crate) use local_form::{LocalForm, Patch};
pub(crate) use object::Object;
pub(crate) use quadtree::Item as Nearby;
pub use quartering::{GRID, Part, Quartering, Scratch};
pub use ray::{Hit, ray};
pub use samples::PreparedPixel;
pub use sub_pixel::SubPixel;
pub use triangle::vertices;
pub use world::World;
pub(crate) use world::{Held, KEPT, Precision};
