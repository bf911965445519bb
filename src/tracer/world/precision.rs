//! The camera and the objects in each precision: `f64`, double-double, and big numbers, which
//! decide everything.
//!
//! In: the numbers of the scene. Out: frames and objects in the precision that is asked for; beyond
//! `f64` they are prepared when they are first asked for. What a decision in one precision leaves
//! in doubt, by the bounds on its errors, is asked of the next.

use glam::{DVec2, DVec3};

use super::precise_cache::{Held, Kept};
use crate::{
    math::{Ball, Big, Double, Real, predicates::Plane},
    scene::{self, Outline, Scene, Shape},
    tracer::{
        camera::{Basis, Camera},
        crossing::SurfacePart,
        cuboid,
        form::Form,
        object::Object,
        sphere::Sphere,
    },
};

/// The answer to a question about a ray in the first precision that is certain of it, the ray
/// having its direction there; and whether that is not the last precision, in which what it does
/// not tell apart counts as equal, so that it is never in doubt.
macro_rules! first_certain {
    ($geometry:expr, $point:expr, |$r:ident| $answer:expr) => {{
        let (geometry, point): (&Geometry, &Point) = ($geometry, $point);
        let asked = {
            let $r = &geometry.fast.camera.direction(point);
            $answer
        };
        let asked = asked.or_else(|Doubt| {
            let $r = &geometry.double.camera.direction(point);
            $answer
        });
        let is_sure = asked.is_ok();
        let asked = asked.or_else(|Doubt| {
            let $r = &geometry.big.camera.direction(point);
            $answer
        });
        (asked.unwrap_or_default(), is_sure)
    }};
}
pub(super) use first_certain;

/// The numbers of the scene that an object is prepared from.
#[derive(Debug)]
pub enum Numbers {
    /// A sphere's centre and radius.
    Sphere(DVec3, f64),
    /// All of any other shape, and of a box that was taken apart which face it is.
    Other(Box<(Shape, Option<u8>)>),
}

/// The camera and the objects, in each precision.
#[derive(Debug)]
pub struct Geometry {
    /// What the objects are prepared from.
    pub numbers: Vec<Numbers>,
    /// The objects for `f64`.
    pub objects: Vec<Object<f64>>,
    pub fast: Frame<f64>,
    pub double: Frame<Double>,
    pub big: Frame<Big>,
}

/// The camera and some objects in one precision.
#[derive(Debug)]
pub struct Frame<T: Real> {
    pub camera: Camera<T>,
    /// The objects that were asked for, of many the last; none for `f64`, whose are all there.
    pub(in crate::tracer) kept: Kept<T>,
    pub near: Option<Form<T>>,
    pub far: Option<Form<T>>,
}

impl<T: Real> Frame<T> {
    /// With places for so many objects.
    pub(super) fn new(basis: &Basis, scene: &Scene, reach: DVec2, kept: usize) -> Self {
        let scene::Camera { near, far, .. } = scene.camera;
        let camera = Camera::new(basis, scene, reach);
        // A point λr has the depth λZ, so its inverse depth 1/λ at the depth n is Z/n.
        let clip = |depth: f64| {
            let zero = Ball::exact(0.0);
            let inverse = Ball::exact(1.0) / camera.length(depth);
            Form::new(&camera, &[zero.clone(), zero, inverse])
        };
        Self {
            near: (near > 0.0).then(|| clip(near)),
            far: far.map(clip),
            kept: Kept::new(kept),
            camera,
        }
    }
}

/// A precision that the world is held in.
pub trait Precision: Real {
    fn frame(geometry: &Geometry) -> &Frame<Self>;

    /// An object in this precision, prepared when it is asked for.
    fn object(geometry: &Geometry, index: usize) -> Held<'_, Self> {
        let Frame { camera, kept, .. } = Self::frame(geometry);
        let prepare = || geometry.numbers[index].object(camera);
        kept.object(index, prepare)
    }
}

impl Numbers {
    pub(super) fn new(object: &scene::Object, face: Option<u8>) -> Self {
        match &object.shape {
            Shape::Sphere(sphere) => Self::Sphere(sphere.center, sphere.radius),
            other => Self::Other(Box::new((*other, face))),
        }
    }

    /// The plane of a flat part.
    pub(super) fn plane(&self, part: SurfacePart) -> Option<Plane> {
        let (Self::Other(other), SurfacePart::Plane(index)) = (self, part) else {
            return None;
        };
        Some(match other.0 {
            Shape::Sphere(_) => return None,
            Shape::Triangle(scene::Triangle { outline, .. }) => match outline {
                Outline::Vertices(vertices) => Plane::through(vertices),
                Outline::Centered(triangle) => Plane::across(triangle.normal, triangle.centroid),
            },
            Shape::Box(scene::Cuboid { min, max, .. }) => {
                let (axis, corner) = (usize::from(index / 2), [min, max][usize::from(index % 2)]);
                let at = corner[axis];
                Plane::Axial { axis, at }
            }
            Shape::Checkerboard(scene::Checkerboard { y, .. }) => Plane::Axial { axis: 1, at: y },
        })
    }

    /// The object in one precision.
    fn object<T: Real>(&self, camera: &Camera<T>) -> Object<T> {
        match self {
            Self::Sphere(center, radius) => Object::Sphere(Sphere::new(camera, *center, *radius)),
            Self::Other(other) => match &**other {
                (Shape::Box(cuboid), face) => {
                    Object::Convex(cuboid::prepare(camera, cuboid, *face))
                }
                (shape, _) => Object::new(camera, shape),
            },
        }
    }
}

impl Precision for f64 {
    #[inline]
    fn frame(geometry: &Geometry) -> &Frame<Self> {
        &geometry.fast
    }

    #[inline]
    fn object(geometry: &Geometry, index: usize) -> Held<'_, Self> {
        Held::Always(&geometry.objects[index])
    }
}

impl Precision for Double {
    fn frame(geometry: &Geometry) -> &Frame<Self> {
        &geometry.double
    }
}

impl Precision for Big {
    fn frame(geometry: &Geometry) -> &Frame<Self> {
        &geometry.big
    }
}
