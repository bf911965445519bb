//! A crossing of a ray with a surface: its inverse depth, and the part of the surface that it lies
//! in.

use crate::math::{Ball, Real};

/// A point of a ray on the surface of an object.
#[derive(Clone, Debug)]
pub struct Crossing<T: Real> {
    /// 1/λ of the point λr, positive. The nearest crossing has the greatest inverse depth.
    pub inverse_depth: Ball<T>,
    /// The part of the object's surface.
    pub part: SurfacePart,
}

/// A part of an object's surface whose depth follows one formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfacePart {
    /// The side of a sphere where a ray enters.
    Entry,
    /// The side of a sphere where a ray leaves.
    Exit,
    /// The plane of a flat object: that of a triangle, of the checkerboard, or of a box's face with
    /// this number.
    Plane(u8),
    /// An edge of a box, or a point so near to one that the precision in use cannot decide between
    /// the planes of its faces.
    Edge,
}
