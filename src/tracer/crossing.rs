//! A crossing of a ray with a surface, given by its inverse depth and by the part of the surface
//! that contains it.

use crate::math::{Ball, Real};

/// A crossing of a ray with the surface of an object.
#[derive(Clone, Debug)]
pub struct Crossing<T: Real> {
    /// Inverse depth 1/λ of the point λr, where r is the ray's direction. It is positive. The
    /// nearest crossing has the greatest inverse depth.
    pub inverse_depth: Ball<T>,
    /// The part of the object's surface that contains the crossing.
    pub part: SurfacePart,
}

/// A part of an object's surface on which one formula gives the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfacePart {
    /// The side of a sphere where a ray enters.
    Entry,
    /// The side of a sphere where a ray leaves.
    Exit,
    /// The plane of a triangle, of a checkerboard, or of a box's face. The field is the number of
    /// the face; it is 0 for a triangle or a checkerboard.
    Plane(u8),
    /// An edge of a box, or a point so close to an edge that the precision in use cannot decide
    /// between the planes of its faces.
    Edge,
}
