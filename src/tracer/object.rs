//! Any object, prepared for one picture.
//!
//! In: an object of the scene and the camera in one precision. Out: what the rest of the tracer asks of every kind of object: crossings of a ray,
//! intervals over a rectangle, the curves that bound it. Each kind answers for itself; here is only the choice between them.

use super::{
    camera::{Camera, Direction, Window},
    checkerboard::Checkerboard,
    crossing::{Crossing, SurfacePart},
    cuboid::Cuboid,
    curve::{Crossings, Curve, SubPixelFrame, Surface},
    form::Form,
    interval::{Cover, Patch, Range},
    sphere::Sphere,
    triangle::Triangle,
};
use crate::{
    math::{Double, Doubt, Real},
    scene::{self, Shape},
};

/// An object prepared for one picture: a sphere in place, since of spheres there may be very many.
#[derive(Clone, Debug)]
pub enum Object<T: Real> {
    /// A flat object in whose plane the eye lies.
    EdgeOn,
    /// A sphere.
    Sphere(Sphere<T>),
    /// A triangle.
    Triangle(Box<Triangle<T>>),
    /// A box.
    Cuboid(Box<Cuboid<T>>),
    /// A checkerboard.
    Checkerboard(Box<Checkerboard<T>>),
}

impl<T: Real> Object<T> {
    /// Prepares an object.
    pub fn new(camera: &Camera<T>, shape: &Shape) -> Self {
        match shape {
            Shape::Sphere(scene::Sphere { center, radius, .. }) => {
                Self::Sphere(Sphere::new(camera, *center, *radius))
            }
            Shape::Triangle(triangle) => Triangle::new(camera, triangle)
                .map_or(Self::EdgeOn, |triangle| Self::Triangle(Box::new(triangle))),
            Shape::Box(cuboid) => Self::Cuboid(Box::new(Cuboid::new(camera, cuboid))),
            Shape::Checkerboard(board) => Checkerboard::new(camera, board)
                .map_or(Self::EdgeOn, |board| Self::Checkerboard(Box::new(board))),
        }
    }

    /// The nearest crossing in front of the eye.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        match self {
            Self::EdgeOn => Ok(None),
            Self::Sphere(sphere) => sphere.first(r),
            Self::Triangle(triangle) => triangle.first(r),
            Self::Cuboid(cuboid) => cuboid.first(r),
            Self::Checkerboard(checkerboard) => checkerboard.first(r),
        }
    }

    /// The crossing behind the first one, where the ray has one.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        match self {
            Self::Sphere(sphere) => sphere.second(r),
            Self::Cuboid(cuboid) => cuboid.second(r),
            Self::EdgeOn | Self::Triangle(_) | Self::Checkerboard(_) => None,
        }
    }

    /// Whether the second colour is seen where the ray meets the object first.
    #[inline]
    pub fn is_odd(&self, r: &Direction<T>) -> Result<bool, Doubt> {
        match self {
            Self::Checkerboard(checkerboard) => checkerboard.is_odd(r),
            _ => Ok(false),
        }
    }

    /// The form of the inverse depth of a flat part.
    pub fn plane(&self, part: SurfacePart) -> Option<&Form<T>> {
        match (self, part) {
            (Self::Triangle(triangle), SurfacePart::Plane(_)) => Some(&triangle.plane),
            (Self::Checkerboard(checkerboard), SurfacePart::Plane(_)) => Some(&checkerboard.plane),
            (Self::Cuboid(cuboid), SurfacePart::Plane(index)) => cuboid.face(index),
            _ => None,
        }
    }
}

impl Object<f64> {
    /// How it stands to a rectangle; `None` if no ray through it meets the object.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        match self {
            Self::EdgeOn => None,
            Self::Sphere(sphere) => sphere.cover(patch),
            Self::Triangle(triangle) => triangle.cover(patch),
            Self::Cuboid(cuboid) => cuboid.cover(patch),
            Self::Checkerboard(checkerboard) => checkerboard.cover(patch),
        }
    }

    /// The inverse depths of its second crossings, where it has any.
    pub fn behind(&self, patch: &Patch) -> Option<Range> {
        match self {
            Self::Sphere(sphere) => sphere.behind(patch),
            Self::Cuboid(cuboid) => cuboid.behind(patch),
            Self::EdgeOn | Self::Triangle(_) | Self::Checkerboard(_) => None,
        }
    }
}

impl<T: Real> Object<T> {
    /// Whether the eye is inside, so that of several faces' planes the nearest is the one that is seen.
    pub fn is_seen_from_inside(&self) -> bool {
        matches!(self, Self::Cuboid(cuboid) if cuboid.seconds().next().is_none())
    }

    /// The part that one of the surfaces of its first crossings is, if that is flat.
    pub fn first_part(&self, at: usize) -> SurfacePart {
        match self {
            Self::Cuboid(cuboid) => SurfacePart::Plane(cuboid.first_index(at)),
            Self::Sphere(_) => SurfacePart::Entry,
            Self::EdgeOn | Self::Triangle(_) | Self::Checkerboard(_) => SurfacePart::Plane(0),
        }
    }

    /// What bounds the rays that meet it; each line's form is not negative where it is met.
    pub fn outline(&self, frame: &SubPixelFrame<T>) -> Vec<Curve> {
        let line = |form: &Form<T>| frame.line(form);
        match self {
            Self::EdgeOn => Vec::new(),
            Self::Sphere(sphere) => frame.silhouette(sphere),
            Self::Triangle(triangle) => triangle.edges.iter().map(line).collect(),
            Self::Cuboid(cuboid) => cuboid.sides().map(|form| frame.line(&form)).collect(),
            Self::Checkerboard(checkerboard) => vec![line(&checkerboard.plane)],
        }
    }

    /// The surfaces where rays meet it: those of their first crossings, of their second ones, or of both.
    pub fn surfaces(&self, which: Crossings) -> Vec<Surface<'_, T>> {
        match self {
            Self::EdgeOn => Vec::new(),
            Self::Sphere(sphere) => vec![Surface::Sphere(sphere)],
            Self::Triangle(triangle) => vec![Surface::Plane(&triangle.plane)],
            Self::Checkerboard(checkerboard) => vec![Surface::Plane(&checkerboard.plane)],
            Self::Cuboid(cuboid) => match which {
                Crossings::First => cuboid.firsts().map(Surface::Plane).collect(),
                Crossings::Second => cuboid.seconds().map(Surface::Plane).collect(),
                Crossings::Both => {
                    let faces = cuboid.firsts().chain(cuboid.seconds());
                    faces.map(Surface::Plane).collect()
                }
            },
        }
    }
}

impl Object<Double> {
    /// The same object for `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Object<f64> {
        match self {
            Self::EdgeOn => Object::EdgeOn,
            Self::Sphere(sphere) => Object::Sphere(sphere.narrowed(window)),
            Self::Triangle(triangle) => Object::Triangle(Box::new(triangle.narrowed(window))),
            Self::Cuboid(cuboid) => Object::Cuboid(Box::new(cuboid.narrowed(window))),
            Self::Checkerboard(board) => Object::Checkerboard(Box::new(board.narrowed(window))),
        }
    }
}
