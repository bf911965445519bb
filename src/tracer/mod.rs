//! What a ray hits: the scene's objects as seen from the eye.
//!
//! In: a [`Scene`](crate::scene::Scene). Out: for a sample point of the picture, the colour seen
//! there, as an index into the palette of all colours. The tracer knows no text and no names: an
//! object is its index in the file.
//!
//! All rays start at the eye. The tracer therefore works in the view plane, where boundaries of
//! objects are lines and conics. The nearest surface at a point has the greatest inverse depth. The
//! inverse depth of a flat surface is a linear form. Everything that does not depend on the sample
//! point is prepared once per picture. A quadtree over the view plane finds the objects that a ray
//! may hit. Every decision is made in `f64` with an error bound. If `f64` leaves doubt, the
//! decision is made in double-double, and if doubt remains, in the highest precision, big numbers.

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

#[doc(hidden)]
pub mod candidates;
mod checker_corners;
pub(crate) mod nearby;
mod quartering;
mod ray;
#[doc(hidden)]
pub mod samples;

#[cfg(test)]
mod tests;

#[doc(hidden)]
pub use camera::{Basis, PicturePoint};
#[doc(hidden)]
pub use candidates::VisibilityCandidate;
pub(crate) use checker_corners::CheckerForms;
#[doc(hidden)]
pub use checker_corners::CheckerPixel;
#[doc(hidden)]
pub use curve::{Boundary, BoundaryLine, Conic};
pub(crate) use curve::{InverseDepth, LOOSE_LINE, SubPixelFrame};
pub(crate) use local_form::{LocalForm, Patch};
pub(crate) use object::Object;
pub(crate) use quadtree::BoundedObject;
#[doc(hidden)]
pub use quartering::{GRID, PicturePart, Quartering, Scratch};
pub use ray::{Hit, ray};
#[doc(hidden)]
pub use samples::PreparedPixel;
#[doc(hidden)]
pub use sub_pixel::SubPixel;
pub use triangle::vertices;
pub use world::World;
pub(crate) use world::{CACHE_SLOTS, ObjectRef, Precision};
