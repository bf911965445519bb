//! Any object, prepared for one picture.

use super::{
    camera::{Camera, Direction, Window},
    checkerboard::Checkerboard,
    crossing::{Crossing, Part},
    cuboid::Cuboid,
    form::Form,
    sphere::Sphere,
    triangle::Triangle,
};
use crate::{
    math::{Double, Doubt, Real},
    scene::Shape,
};

/// An object prepared for one picture.
#[derive(Clone, Debug)]
pub enum Object<T> {
    /// A flat object in whose plane the eye lies.
    EdgeOn,
    /// A sphere.
    Sphere(Sphere<T>),
    /// A triangle.
    Triangle(Triangle<T>),
    /// A box.
    Cuboid(Cuboid<T>),
    /// A checkerboard.
    Checkerboard(Checkerboard<T>),
}

impl<T: Real> Object<T> {
    /// Prepares an object.
    pub fn new(camera: &Camera<T>, shape: &Shape) -> Self {
        match shape {
            Shape::Sphere(sphere) => Self::Sphere(Sphere::new(camera, sphere)),
            Shape::Triangle(triangle) => {
                Triangle::new(camera, triangle).map_or(Self::EdgeOn, Self::Triangle)
            }
            Shape::Box(cuboid) => Self::Cuboid(Cuboid::new(camera, cuboid)),
            Shape::Checkerboard(board) => {
                Checkerboard::new(camera, board).map_or(Self::EdgeOn, Self::Checkerboard)
            }
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
    pub fn plane(&self, part: Part) -> Option<&Form<T>> {
        match (self, part) {
            (Self::Triangle(triangle), Part::Plane(_)) => Some(&triangle.plane),
            (Self::Checkerboard(checkerboard), Part::Plane(_)) => Some(&checkerboard.plane),
            (Self::Cuboid(cuboid), Part::Plane(index)) => cuboid.face(index),
            _ => None,
        }
    }
}

impl Object<Double> {
    /// The same object for `f64`.
    pub fn narrowed(&self, window: &Window) -> Object<f64> {
        match self {
            Self::EdgeOn => Object::EdgeOn,
            Self::Sphere(sphere) => Object::Sphere(sphere.narrowed(window)),
            Self::Triangle(triangle) => Object::Triangle(triangle.narrowed(window)),
            Self::Cuboid(cuboid) => Object::Cuboid(cuboid.narrowed(window)),
            Self::Checkerboard(checkerboard) => Object::Checkerboard(checkerboard.narrowed(window)),
        }
    }
}
