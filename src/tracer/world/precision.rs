//! The camera and the objects in each precision: `f64`, double-double, and big numbers, the highest
//! precision.
//!
//! In: the numbers of the scene. Out: the camera, the near and the far plane, and the objects, in
//! the requested precision. In precisions higher than `f64`, objects are prepared when they are
//! first requested. If the error bounds of one precision leave a decision uncertain, it is made in
//! the next precision. The highest precision decides everything.

use glam::{DVec2, DVec3};

use super::precise_cache::{ObjectCache, ObjectRef};
use crate::{
    math::{Ball, Big, Double, Real, predicates::Plane},
    scene::{self, Scene, Shape},
    tracer::{
        camera::{Basis, Camera},
        crossing::SurfacePart,
        form::Form,
        object::{Object, exact_plane},
        sphere::Sphere,
    },
};

/// Evaluates `$answer` for a ray's direction `$r`, in one precision after the other, until the
/// answer is certain. Yields the answer, and `true` if a precision below the highest one was enough
/// for it. The highest precision always gives an answer, because it treats numbers as equal if it
/// cannot distinguish them.
macro_rules! first_certain {
    ($geometry:expr, $point:expr, |$r:ident| $answer:expr) => {{
        let (geometry, point): (&Geometry, &PicturePoint) = ($geometry, $point);
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

/// The numbers of the scene from which an object is prepared.
#[derive(Debug)]
pub enum Numbers {
    /// A sphere's centre and radius.
    Sphere(DVec3, f64),
    /// The numbers of a shape other than a sphere. If the object is a single face of a box, also
    /// the number of the face.
    Other(Box<(Shape, Option<u8>)>),
}

/// The camera and the objects in each precision.
#[derive(Debug)]
pub struct Geometry {
    /// The numbers from which the objects are prepared.
    pub numbers: Vec<Numbers>,
    /// The objects in `f64`.
    pub objects: Vec<Object<f64>>,
    pub fast: SceneFrame<f64>,
    pub double: SceneFrame<Double>,
    pub big: SceneFrame<Big>,
}

/// The camera, the near and the far plane, and cached objects of a scene in one precision.
#[derive(Debug)]
pub struct SceneFrame<T: Real> {
    pub camera: Camera<T>,
    /// Cached objects. The cache has no slots for `f64`, whose objects are all in
    /// [`Geometry::objects`].
    pub(in crate::tracer) cache: ObjectCache<T>,
    pub near: Option<Form<T>>,
    pub far: Option<Form<T>>,
}

impl<T: Real> SceneFrame<T> {
    /// Prepares the camera and the clip planes in the precision `T`. The cache has slots for at
    /// most `slots` objects.
    pub(super) fn new(basis: &Basis, scene: &Scene, reach: DVec2, slots: usize) -> Self {
        let scene::Camera { near, far, .. } = scene.camera;
        let camera = Camera::new(basis, scene, reach);
        // A point λr of a ray with the direction r has the depth λZ, where Z is the forward
        // component of r. The inverse depth 1/λ of a plane at the depth `depth` is therefore
        // Z/`depth`.
        let clip = |depth: f64| {
            let zero = Ball::exact(0.0);
            let inverse = Ball::exact(1.0) / camera.length(depth);
            Form::new(&camera, &[zero.clone(), zero, inverse])
        };
        Self {
            near: (near > 0.0).then(|| clip(near)),
            far: far.map(clip),
            cache: ObjectCache::new(slots),
            camera,
        }
    }
}

/// A precision in which the scene is prepared.
pub trait Precision: Real {
    fn frame(geometry: &Geometry) -> &SceneFrame<Self>;

    /// Returns the object with the index `index` in the precision of `Self`. Prepares it if it is
    /// not cached.
    fn object(geometry: &Geometry, index: usize) -> ObjectRef<'_, Self> {
        let SceneFrame { camera, cache, .. } = Self::frame(geometry);
        let prepare = || geometry.numbers[index].object(camera);
        cache.object(index, prepare)
    }
}

impl Numbers {
    pub(super) fn new(object: &scene::Object, face: Option<u8>) -> Self {
        match &object.shape {
            Shape::Sphere(sphere) => Self::Sphere(sphere.center, sphere.radius),
            other => Self::Other(Box::new((*other, face))),
        }
    }

    /// Returns the exact plane of a flat surface part. Returns `None` for a part that is not flat.
    pub(super) fn plane(&self, part: SurfacePart) -> Option<Plane> {
        match (self, part) {
            (Self::Other(other), SurfacePart::Plane(index)) => exact_plane(&other.0, index),
            _ => None,
        }
    }

    /// Prepares the object in the precision `T`.
    fn object<T: Real>(&self, camera: &Camera<T>) -> Object<T> {
        match self {
            Self::Sphere(center, radius) => Object::Sphere(Sphere::new(camera, *center, *radius)),
            Self::Other(other) => Object::new(camera, &other.0, other.1),
        }
    }
}

impl Precision for f64 {
    #[inline]
    fn frame(geometry: &Geometry) -> &SceneFrame<Self> {
        &geometry.fast
    }

    #[inline]
    fn object(geometry: &Geometry, index: usize) -> ObjectRef<'_, Self> {
        ObjectRef::Borrowed(&geometry.objects[index])
    }
}

impl Precision for Double {
    fn frame(geometry: &Geometry) -> &SceneFrame<Self> {
        &geometry.double
    }
}

impl Precision for Big {
    fn frame(geometry: &Geometry) -> &SceneFrame<Self> {
        &geometry.big
    }
}
