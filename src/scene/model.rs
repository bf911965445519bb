//! A scene as plain data. The tracer is built from it.

use std::sync::Arc;

use glam::DVec3;

use super::shape::Shape;
use crate::{
    color::Color,
    diagnostic::Diagnostic,
    math::{Angle, Real},
    schema::Method,
    source::{SourceId, Span},
};

/// The smallest scene that shows something: a sphere on a floor.
pub const SMALLEST: &str = "\
camera { eye (0, 2, 8)  lookat (0, 1, 0) }
sphere { center (0, 1, 0) }
checkerboard {}
";

/// Result of reading a scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Reading {
    /// The scene, unless there is an error.
    pub scene: Option<Scene>,
    /// Errors and warnings in the order of the text: those of the file, then those of the `--set`
    /// arguments.
    pub diagnostics: Vec<Diagnostic>,
}

/// A whole scene: the objects, the camera, and how the picture is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The picture's size and background.
    pub image: Image,
    /// The camera.
    pub camera: Camera,
    /// The method, the number of samples, and the seed of the random numbers.
    pub sampler: Sampler,
    /// Objects in the order of the file. If two objects are at the same distance, the first one is
    /// visible. Several scenes can share the objects, for example while the camera moves.
    pub objects: Arc<Vec<Object>>,
}

/// The picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image {
    /// Width in pixels, from 1 to 2^20.
    pub width: u32,
    /// Height in pixels, from 1 to 2^20.
    pub height: u32,
    /// Colour where no object is hit.
    pub background: Color,
}

/// The pinhole camera, described by the fields that a scene file gives. Lengths are in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, through which all rays pass.
    pub eye: DVec3,
    /// The view direction. If it is given by a point, the point differs from the eye, so the
    /// direction is not zero.
    pub view: View,
    /// The up vector, not zero; it may be parallel to the view direction.
    pub up: DVec3,
    /// The roll about the view direction; a positive roll lowers the right side of the camera.
    pub roll: Angle,
    /// The field of view.
    pub lens: Lens,
    /// The height of the window in metres, > 0. The window is the part of the view plane that the
    /// picture shows.
    pub view_height: f64,
    /// Depth of the near plane in metres, ≥ 0; nothing nearer is visible.
    pub near: f64,
    /// Depth of the far plane in metres, > near; nothing farther is visible. `None` if there is no
    /// far plane.
    pub far: Option<f64>,
}

/// The view direction of a camera, in either of the language's two forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// Towards a point other than the eye.
    Lookat(DVec3),
    /// Along a vector other than zero, of any length.
    Direction(DVec3),
}

/// Returns the direction that determines the top of the picture if a camera's up vector is parallel
/// to its view direction: −z, or +y if up is parallel to z.
///
/// Let h be the component of this direction that is perpendicular to up. The top of the picture
/// points along −h if the camera looks along up, and along h if it looks in the opposite direction.
/// The picture is the same as if the camera first looked along h and were then tilted up or down by
/// 90°.
pub fn level_direction(up: DVec3) -> DVec3 {
    if up.x == 0.0 && up.y == 0.0 {
        DVec3::Y
    } else {
        DVec3::NEG_Z
    }
}

/// Field of view of a camera, in one of the language's three forms. Angles are between 0 and 180
/// degrees, exclusive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Lens {
    /// Distance from the eye to the view plane in metres, > 0.
    Distance(f64),
    /// Angle that the window's height subtends at the eye.
    Fov(Angle),
    /// Angle that the window's width subtends at the eye.
    HorizontalFov(Angle),
}

/// Method of sampling, number of samples, and seed of the random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    /// Sampling technique, or `exact` for exact integration.
    pub method: Method,
    /// Number of samples.
    pub count: Count,
    /// Seed of the random numbers, less than 2^53.
    pub seed: u64,
}

/// Number of samples, for each pixel or for the whole picture. The whole picture has at most 2^53
/// samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Count {
    /// The number of samples in each pixel, ≥ 1.
    PerPixel(u64),
    /// The number of samples in the whole picture, ≥ 1.
    Total(u64),
}

/// One object of the scene. Two objects are equal if their names, indices and shapes are equal.
/// Their spans may differ, so that scenes of different texts can be equal.
#[derive(Clone, Debug)]
pub struct Object {
    /// The unique name, if the object has one: `Ball`, or `Ball[3, 1]` if the block is repeated.
    pub name: Option<String>,
    /// Values of the indices of a repeated block, in the order of `for`; empty if the block is not
    /// repeated.
    pub indices: Box<[u32]>,
    /// The shape.
    pub shape: Shape,
    /// Span of the whole block in the text.
    pub span: Span,
}

impl PartialEq for Object {
    fn eq(&self, other: &Self) -> bool {
        let Self {
            name,
            indices,
            shape,
            span: _,
        } = self;
        *name == other.name && *indices == other.indices && *shape == other.shape
    }
}

impl Object {
    /// Makes an object without a name. Its span is empty, because the object does not come from a
    /// text.
    pub fn new(shape: impl Into<Shape>) -> Self {
        Self {
            name: None,
            indices: Box::default(),
            shape: shape.into(),
            span: Span::new(SourceId::File, 0, 0),
        }
    }

    /// Returns a copy of the object with the name `name`. The copy has no indices, even if the
    /// object was made by a block that `for` repeats. No other object of the scene may have this
    /// name.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: Some(name.into()),
            indices: Box::default(),
            ..self
        }
    }

    fn is_named(&self, name: &str) -> bool {
        self.name.as_deref() == Some(name)
    }

    /// Returns whether two objects come from the same block, i.e. are repetitions of one object.
    pub fn is_beside(&self, other: &Self) -> bool {
        !self.indices.is_empty() && self.span == other.span
    }
}

impl Scene {
    /// Returns the object whose name is `name`, such as `Ball` or `Ball[3, 1]`.
    ///
    /// ```
    /// let scene = pinhole::Scene::parse(
    ///     "camera { eye (0, 2, 8)  lookat (0, 1, 0) }  sphere Ball { center (0, 1, 0) }",
    /// )?;
    /// let mut data = scene.data().clone();
    /// assert_eq!(data.object("Ball").unwrap().shape.kind(), "sphere");
    /// assert_eq!(data.object("Bell"), None);
    /// data.object_mut("Ball").unwrap().name = Some("Moon".to_owned());
    /// assert!(pinhole::Scene::from_data(&data)?.to_string().contains("sphere Moon"));
    /// # Ok::<(), pinhole::Mistakes>(())
    /// ```
    pub fn object(&self, name: &str) -> Option<&Object> {
        self.objects.iter().find(|object| object.is_named(name))
    }

    /// Returns a mutable reference to the object whose name is `name`. The objects are copied first
    /// if another scene shares them.
    pub fn object_mut(&mut self, name: &str) -> Option<&mut Object> {
        let index = self
            .objects
            .iter()
            .position(|object| object.is_named(name))?;
        self.objects_mut().get_mut(index)
    }

    /// Returns a mutable reference to the objects. They are copied first if another scene shares
    /// them.
    pub fn objects_mut(&mut self) -> &mut Vec<Object> {
        Arc::make_mut(&mut self.objects)
    }
}

impl View {
    /// Returns two points such that the view direction leads from the first to the second: the eye
    /// and the point that is looked at, or the origin and the tip of the `direction`.
    pub fn ends(&self, eye: DVec3) -> (DVec3, DVec3) {
        match *self {
            Self::Lookat(point) => (eye, point),
            Self::Direction(direction) => (DVec3::ZERO, direction),
        }
    }
}

/// Returns the side of a pixel at depth 1, in metres. If the camera has a distance d from the eye
/// to the view plane, the side is
///
///   view_height / (height · d),
///
/// where view_height is the height of the window in metres, and height is the height of the picture
/// in pixels. If the camera has a field of view, the side is 2·tan(angle/2) divided by the
/// picture's height or width in pixels. `tan_half` computes tan(angle/2) in the precision that the
/// caller needs.
pub fn pixel_size<T: Real>(camera: &Camera, image: &Image, tan_half: impl Fn(Angle) -> T) -> T {
    let [width, height] = [image.width, image.height].map(|pixels| T::from_f64(pixels.into()));
    let slope = |angle| T::from_f64(2.0).times(&tan_half(angle));
    match camera.lens {
        Lens::Distance(d) => T::from_f64(camera.view_height)
            .over(&T::from_f64(d))
            .over(&height),
        Lens::Fov(angle) => slope(angle).over(&height),
        Lens::HorizontalFov(angle) => slope(angle).over(&width),
    }
}
