//! What a scene is: plain data, which the tracer is built from.

use std::sync::Arc;

use glam::DVec3;

use crate::{color::Color, diagnostic::Diagnostic, math::Angle, schema::Method, source::Span};

/// The smallest scene that shows something: a sphere on a floor.
pub const SMALLEST: &str = "\
camera { eye (0, 2, 8)  lookat (0, 1, 0) }
sphere { center (0, 1, 0) }
checkerboard {}
";

/// What reading a scene yields.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The scene, unless there is an error.
    pub scene: Option<Scene>,
    /// Errors and warnings, in the order of the text, the file's before the arguments'.
    pub diagnostics: Vec<Diagnostic>,
}

/// A whole scene: what is rendered, through which camera, with which samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The picture's size and background.
    pub image: Image,
    /// Where it is seen from.
    pub camera: Camera,
    /// Where its samples lie.
    pub sampler: Sampler,
    /// What is seen, in the order of the file: on a tie the first one wins. Shared by scenes that
    /// differ in the rest.
    pub objects: Arc<Vec<Object>>,
}

/// The picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image {
    /// Columns of pixels, 1 to 2^20.
    pub width: u32,
    /// Rows of pixels, 1 to 2^20.
    pub height: u32,
    /// What is seen where nothing is hit.
    pub background: Color,
}

/// The pinhole camera, as the file gives it. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, through which all rays pass.
    pub eye: DVec3,
    /// Where it looks; not undefined.
    pub view: View,
    /// The up vector, not zero; it may be parallel to the view direction.
    pub up: DVec3,
    /// The roll about the view direction; positive dips the right side.
    pub roll: Angle,
    /// How much it sees.
    pub lens: Lens,
    /// The height of the window in the view plane, > 0.
    pub view_height: f64,
    /// Nothing at this depth or nearer is seen, ≥ 0.
    pub near: f64,
    /// Nothing at this depth or farther is seen, > near.
    pub far: Option<f64>,
}

/// The direction that a camera looks in, in either of the language's two ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// Towards a point other than the eye.
    Lookat(DVec3),
    /// Along a vector other than zero, of any length.
    Direction(DVec3),
}

/// The level direction of cameras whose up vector is parallel to their view direction: they show
/// the picture that one gets on tilting the camera from looking along it. It is −z, or +y where up
/// is parallel to that.
///
/// So, looking against up, the top of the picture is the part of this direction that is
/// perpendicular to up; looking along up, the opposite.
pub fn level_direction(up: DVec3) -> DVec3 {
    if up.x == 0.0 && up.y == 0.0 {
        DVec3::Y
    } else {
        DVec3::NEG_Z
    }
}

/// How much a camera sees, in one of the language's three ways. Angles lie between 0 and 180
/// degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// The distance from the eye to the view plane, > 0.
    Distance(f64),
    /// The angle that the window's height takes up.
    Fov(Angle),
    /// The angle that the window's width takes up.
    HorizontalFov(Angle),
}

/// Where samples lie, how many, and the seed of the random ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampler {
    /// The technique.
    pub method: Method,
    /// How many samples.
    pub count: Count,
    /// The seed, below 2^53.
    pub seed: u64,
}

/// A number of samples; `per_pixel` times the number of pixels, or `total`, is at most 2^53.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Count {
    /// So many in each pixel, ≥ 1.
    PerPixel(u64),
    /// So many in the whole picture, ≥ 1.
    Total(u64),
}

/// One object of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    /// Its name, unique if it has one: `Ball`, or `Ball[3, 1]` where its block stands for several.
    pub name: Option<String>,
    /// The values of its block's indices, in their order.
    pub indices: Box<[u32]>,
    /// What it is.
    pub shape: Shape,
    /// Its whole block in the text.
    pub span: Span,
}

impl Object {
    /// Whether it stands with another one in a block that is repeated.
    pub fn is_beside(&self, other: &Self) -> bool {
        !self.indices.is_empty() && self.span == other.span
    }
}

/// A shape with its colour. Lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Triangle(Triangle),
    /// A box.
    Box(Cuboid),
    /// A checkerboard.
    Checkerboard(Checkerboard),
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub center: DVec3,
    /// Its radius, > 0.
    pub radius: f64,
    /// Its colour.
    pub color: Color,
}

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Where its vertices are.
    pub outline: Outline,
    /// Its colour.
    pub color: Color,
}

/// The vertices of a triangle, in either of the language's two ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// The vertices themselves, which do not lie on one line.
    Vertices([DVec3; 3]),
    /// By centroid, normal and sides.
    Centered(CenteredTriangle),
}

/// A triangle by centroid and normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CenteredTriangle {
    /// The mean of its vertices.
    pub centroid: DVec3,
    /// Its normal, not zero, of any length.
    pub normal: DVec3,
    /// The lengths (a, b, c) of its sides, c the base; they form a triangle.
    pub sides: DVec3,
    /// Its turn in its own plane, counter-clockwise seen from the tip of the normal.
    pub spin: Angle,
}

impl Outline {
    /// The mean of its vertices, rounded.
    pub fn centroid(&self) -> DVec3 {
        match self {
            // Divided first, so that no sum is too large.
            Self::Vertices(vertices) => vertices.iter().map(|vertex| *vertex / 3.0).sum(),
            Self::Centered(centered) => centered.centroid,
        }
    }
}

/// A closed, axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The corner of least coordinates.
    pub min: DVec3,
    /// The corner of greatest coordinates, > min on every axis.
    pub max: DVec3,
    /// Its colour, if all of its faces have one.
    pub color: Color,
    /// The colours of its faces across x, y and z, in the place of `color`.
    pub faces: Option<[Color; 3]>,
}

/// The infinite checkerboard in a horizontal plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// The height of its plane.
    pub y: f64,
    /// The side of a square, > 0.
    pub square: f64,
    /// The colours of the even and of the odd squares.
    pub colors: [Color; 2],
}

impl Shape {
    /// The word of its block in the language.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Sphere(_) => "sphere",
            Self::Triangle(_) => "triangle",
            Self::Box(_) => "box",
            Self::Checkerboard(_) => "checkerboard",
        }
    }

    /// Its colours: of a box those of the faces across x, y and z, of a checkerboard those of the
    /// even and of the odd squares, and then again the last.
    pub fn colors(&self) -> [Color; 3] {
        match self {
            Self::Sphere(Sphere { color, .. }) | Self::Triangle(Triangle { color, .. }) => {
                [*color; 3]
            }
            Self::Box(cuboid) => cuboid.faces.unwrap_or([cuboid.color; 3]),
            Self::Checkerboard(Checkerboard { colors, .. }) => [colors[0], colors[1], colors[1]],
        }
    }
}
