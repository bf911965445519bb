//! An object of any kind, prepared for one picture.
//!
//! In: an object of the scene, and the camera in one precision. Out: the crossings of a ray, the
//! intervals of inverse depths over a rectangle of the picture, and the curves that bound the
//! object. Each kind of object computes these in its own file; this file only selects among the
//! kinds.

use super::{
    camera::{Camera, Direction, Window},
    checkerboard::Checkerboard,
    convex::Convex,
    crossing::{Crossing, SurfacePart},
    cuboid,
    curve::{Boundary, Crossings, InverseDepth, SubPixelFrame},
    form::Form,
    interval::{Cover, Interval},
    local_form::Patch,
    sphere::Sphere,
    triangle,
};
use crate::{
    math::{Double, Doubt, Real, predicates::Plane},
    scene::{self, Shape, TriangleOutline},
};

/// The geometry of an object's surface. Each `match` on this type names every kind of surface. When
/// a kind is added, the compiler therefore lists all code that must handle it.
pub enum SurfaceKind<'a, T: Real> {
    /// Flat faces.
    Flat(&'a Convex<T>),
    /// A sphere.
    Round(&'a Sphere<T>),
}

/// An object prepared for one picture. A sphere is stored without a pointer, because scenes may
/// have very many spheres.
#[derive(Clone, Debug)]
pub enum Object<T: Real> {
    /// A sphere.
    Sphere(Sphere<T>),
    /// A triangle, a box, or one face of a box. Also an invisible object, without faces: a
    /// triangle, a single face or a checkerboard whose plane contains the eye.
    Convex(Convex<T>),
    /// A checkerboard.
    Checkerboard(Box<Checkerboard<T>>),
}

impl<T: Real> Object<T> {
    /// Prepares an object of the scene, or only the face `face` of a box, in the precision `T`.
    pub fn new(camera: &Camera<T>, shape: &Shape, face: Option<u8>) -> Self {
        match shape {
            Shape::Sphere(scene::Sphere { center, radius, .. }) => {
                Self::Sphere(Sphere::new(camera, *center, *radius))
            }
            Shape::Triangle(triangle) => Self::Convex(
                triangle::prepare(camera, triangle)
                    .map_or_else(Convex::nothing, |(triangle, _)| triangle),
            ),
            Shape::Box(cuboid) => Self::Convex(cuboid::prepare(camera, cuboid, face)),
            Shape::Checkerboard(board) => match Checkerboard::new(camera, board) {
                Some(board) => Self::Checkerboard(Box::new(board)),
                None => Self::Convex(Convex::nothing()),
            },
        }
    }

    /// Returns the geometry of the object's surface.
    #[inline]
    pub fn surface_kind(&self) -> SurfaceKind<'_, T> {
        match self {
            Self::Sphere(sphere) => SurfaceKind::Round(sphere),
            Self::Convex(convex) => SurfaceKind::Flat(convex),
            Self::Checkerboard(board) => SurfaceKind::Flat(&board.plane),
        }
    }

    /// Returns the nearest crossing in front of the eye. Returns `None` if the ray misses the
    /// object, and a [`Doubt`] if rounding errors leave this uncertain.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex.first(r),
            SurfaceKind::Round(sphere) => sphere.first(r),
        }
    }

    /// Returns the second crossing of the ray with the object. The ray must hit the object. Returns
    /// `None` if there is no second crossing.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex.second(r),
            SurfaceKind::Round(sphere) => sphere.second(r),
        }
    }

    /// Returns whether the ray hits the second colour of a checkerboard, or a [`Doubt`] if rounding
    /// errors leave this uncertain. Returns `false` for every other kind of object.
    #[inline]
    pub fn is_odd(&self, r: &Direction<T>) -> Result<bool, Doubt> {
        match self {
            Self::Checkerboard(checkerboard) => checkerboard.is_odd(r),
            Self::Sphere(_) | Self::Convex(_) => Ok(false),
        }
    }

    /// Returns the inverse depth of the surface part `part` as a linear form. Returns `None` for a
    /// sphere, or if the object does not have this part.
    pub fn plane(&self, part: SurfacePart) -> Option<&Form<T>> {
        match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex.face(part),
            SurfaceKind::Round(_) => None,
        }
    }

    /// Returns the boundary of the region of rays that hit the object. The form of each line is ≥ 0
    /// on the object's side.
    pub fn outline(&self, frame: &SubPixelFrame<T>) -> Vec<Boundary> {
        match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex.bounds().iter().map(|f| frame.line(f)).collect(),
            SurfaceKind::Round(sphere) => frame.silhouette(sphere),
        }
    }

    /// Returns the inverse depths of the object's surfaces at the crossings `which`. A sphere has
    /// one formula for both crossings.
    pub fn inverse_depths(&self, which: Crossings) -> Vec<InverseDepth<'_, T>> {
        let convex = match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex,
            SurfaceKind::Round(sphere) => return vec![InverseDepth::Sphere(sphere)],
        };
        let (firsts, seconds) = match which {
            Crossings::First => (convex.firsts(), &[][..]),
            Crossings::Second => (&[][..], convex.seconds()),
            Crossings::Both => (convex.firsts(), convex.seconds()),
        };
        firsts
            .iter()
            .chain(seconds)
            .map(InverseDepth::Plane)
            .collect()
    }
}

impl Object<f64> {
    /// Computes how the object covers a rectangle. Returns `None` if no ray through the rectangle
    /// hits the object.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex.cover(patch),
            SurfaceKind::Round(sphere) => sphere.cover(patch),
        }
    }

    /// Returns the range of the inverse depths of second crossings: those where a ray through the
    /// rectangle hits the object for the second time. Returns `None` if no ray hits the object
    /// twice.
    pub fn behind(&self, patch: &Patch) -> Option<Interval> {
        match self.surface_kind() {
            SurfaceKind::Flat(convex) => convex.behind(patch),
            SurfaceKind::Round(sphere) => sphere.behind(patch),
        }
    }
}

impl Object<Double> {
    /// Rounds the object to `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Object<f64> {
        match self {
            Self::Sphere(sphere) => Object::Sphere(sphere.narrowed(window)),
            Self::Convex(convex) => Object::Convex(convex.narrowed(window)),
            Self::Checkerboard(board) => Object::Checkerboard(Box::new(board.narrowed(window))),
        }
    }
}

/// Returns the exact plane of a flat part of a shape. Returns `None` for a shape that is not flat.
pub fn exact_plane(shape: &Shape, part: u8) -> Option<Plane> {
    Some(match *shape {
        Shape::Sphere(_) => return None,
        Shape::Triangle(scene::Triangle { outline, .. }) => match outline {
            TriangleOutline::Vertices(vertices) => Plane::through(vertices),
            TriangleOutline::Centered(triangle) => {
                Plane::across(triangle.normal, triangle.centroid)
            }
        },
        Shape::Box(scene::Cuboid { min, max, .. }) => {
            let (axis, corner) = (usize::from(part / 2), [min, max][usize::from(part % 2)]);
            let at = corner[axis];
            Plane::Axial { axis, at }
        }
        Shape::Checkerboard(scene::Checkerboard { y, .. }) => Plane::Axial { axis: 1, at: y },
    })
}
