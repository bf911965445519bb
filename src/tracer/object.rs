//! Any object, prepared for one picture.
//!
//! In: an object of the scene and the camera in one precision. Out: what the rest of the tracer
//! asks of every kind of object: crossings of a ray, intervals over a rectangle, the curves that
//! bound it. Each kind answers for itself; here is only the choice between them.

use super::{
    camera::{Camera, Direction, Window},
    checkerboard::Checkerboard,
    convex::Convex,
    crossing::{Crossing, SurfacePart},
    cuboid,
    curve::{Crossings, Curve, SubPixelFrame, Surface},
    form::Form,
    interval::{Cover, Range},
    local_form::Patch,
    sphere::Sphere,
    triangle,
};
use crate::{
    math::{Double, Doubt, Real},
    scene::{self, Shape},
};

/// An object prepared for one picture: a sphere in place, since of spheres there may be very many.
#[derive(Clone, Debug)]
pub enum Object<T: Real> {
    /// A sphere.
    Sphere(Sphere<T>),
    /// A triangle or a box; nothing where the eye lies in a flat object's plane.
    Convex(Convex<T>),
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
            Shape::Triangle(triangle) => Self::Convex(
                triangle::prepare(camera, triangle)
                    .map_or_else(Convex::nothing, |(triangle, _)| triangle),
            ),
            Shape::Box(cuboid) => Self::Convex(cuboid::prepare(camera, cuboid, None)),
            Shape::Checkerboard(board) => match Checkerboard::new(camera, board) {
                Some(board) => Self::Checkerboard(Box::new(board)),
                None => Self::Convex(Convex::nothing()),
            },
        }
    }

    /// The faces of any object but a sphere.
    #[inline]
    pub fn convex(&self) -> Result<&Convex<T>, &Sphere<T>> {
        match self {
            Self::Sphere(sphere) => Err(sphere),
            Self::Convex(convex) => Ok(convex),
            Self::Checkerboard(board) => Ok(&board.plane),
        }
    }

    /// The nearest crossing in front of the eye.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        match self.convex() {
            Ok(convex) => convex.first(r),
            Err(sphere) => sphere.first(r),
        }
    }

    /// The crossing behind the first one, where the ray has one.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        match self.convex() {
            Ok(convex) => convex.second(r),
            Err(sphere) => sphere.second(r),
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
        self.convex().ok()?.face(part)
    }

    /// What bounds the rays that meet it; each line's form is not negative where it is met.
    pub fn outline(&self, frame: &SubPixelFrame<T>) -> Vec<Curve> {
        match self.convex() {
            Ok(convex) => convex.bounds().iter().map(|f| frame.line(f)).collect(),
            Err(sphere) => frame.silhouette(sphere),
        }
    }

    /// The surfaces where rays meet it: those of their first crossings, of their second ones, or of
    /// both.
    pub fn surfaces(&self, which: Crossings) -> Vec<Surface<'_, T>> {
        let convex = match self.convex() {
            Ok(convex) => convex,
            Err(sphere) => return vec![Surface::Sphere(sphere)],
        };
        let (firsts, seconds) = match which {
            Crossings::First => (convex.firsts(), &[][..]),
            Crossings::Second => (&[][..], convex.seconds()),
            Crossings::Both => (convex.firsts(), convex.seconds()),
        };
        firsts.iter().chain(seconds).map(Surface::Plane).collect()
    }
}

impl Object<f64> {
    /// How it stands to a rectangle; `None` if no ray through it meets the object.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        match self.convex() {
            Ok(convex) => convex.cover(patch),
            Err(sphere) => sphere.cover(patch),
        }
    }

    /// The inverse depths of its second crossings, where it has any.
    pub fn behind(&self, patch: &Patch) -> Option<Range> {
        match self.convex() {
            Ok(convex) => convex.behind(patch),
            Err(sphere) => sphere.behind(patch),
        }
    }
}

impl Object<Double> {
    /// The same object for `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Object<f64> {
        match self {
            Self::Sphere(sphere) => Object::Sphere(sphere.narrowed(window)),
            Self::Convex(convex) => Object::Convex(convex.narrowed(window)),
            Self::Checkerboard(board) => Object::Checkerboard(Box::new(board.narrowed(window))),
        }
    }
}
