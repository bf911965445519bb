//! Where a ray meets a surface: the inverse depth of the crossing, and which part of the surface it
//! lies in.

use crate::math::{Ball, Real};

/// A point of a ray on the surface of an object.
#[derive(Clone, Debug)]
pub struct Crossing<T: Real> {
    /// 1/λ for the point λr, > 0: the nearest crossing has the greatest one.
    pub inverse_depth: Ball<T>,
    /// Which part of the object's surface.
    pub part: SurfacePart,
}

/// A part of an object's surface that one formula gives the depth of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfacePart {
    /// The side of a sphere where a ray enters.
    Entry,
    /// The side of a sphere where a ray leaves.
    Exit,
    /// The plane of a flat object: a triangle's, the checkerboard's, or that of the face with this
    /// index of a box.
    Plane(u8),
    /// An edge of a box, or so near to one that the precision at hand cannot say in which of its
    /// faces' planes.
    Edge,
}
