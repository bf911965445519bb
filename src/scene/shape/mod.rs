//! Shapes of objects, with their colours.
//!
//! Each kind of shape has a file, which defines how the shape is built from its block, its position
//! and extent, its fields, and its description. This file only dispatches to the kinds.
//!
//! A new kind begins with [`BlockKind`] and its row in the schema. From there, compiler errors and
//! failing tests lead to most other places that must be changed; CONTRIBUTING.md lists the rest.

mod checkerboard;
mod cuboid;
#[cfg(feature = "json")]
mod json;
mod sphere;
mod triangle;

pub use checkerboard::Checkerboard;
pub use cuboid::Cuboid;
pub use sphere::Sphere;
pub use triangle::{CenteredTriangle, Triangle, TriangleOutline};

use glam::DVec3;

use super::lowered_block::LoweredBlock;
use crate::{
    color::Color,
    diagnostic::Problems,
    schema::{self, BlockKind, FieldValue, Value},
};

/// A shape with its colours. Lengths are in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
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

/// Evaluates an expression with the struct that a [`Shape`] contains, such as [`Sphere`]. The same
/// expression is used for all kinds of shapes.
macro_rules! for_each_kind {
    ($shape:expr, $own:ident => $result:expr) => {
        match $shape {
            Shape::Sphere($own) => $result,
            Shape::Triangle($own) => $result,
            Shape::Box($own) => $result,
            Shape::Checkerboard($own) => $result,
        }
    };
}

impl From<Sphere> for Shape {
    fn from(sphere: Sphere) -> Self {
        Self::Sphere(sphere)
    }
}

impl From<Triangle> for Shape {
    fn from(triangle: Triangle) -> Self {
        Self::Triangle(triangle)
    }
}

impl From<Cuboid> for Shape {
    fn from(cuboid: Cuboid) -> Self {
        Self::Box(cuboid)
    }
}

impl From<Checkerboard> for Shape {
    fn from(board: Checkerboard) -> Self {
        Self::Checkerboard(board)
    }
}

impl Shape {
    /// Makes the shape of an object's block. Returns `None` if a value is missing or wrong. Reports
    /// only values that contradict each other; other problems were reported before.
    pub(super) fn lower(block: &LoweredBlock<'_>, problems: &mut Problems) -> Option<Self> {
        Some(match block.row.kind {
            BlockKind::Sphere => Self::Sphere(Sphere::lower(block)?),
            BlockKind::Triangle => Self::Triangle(Triangle::lower(block, problems)?),
            BlockKind::Box => Self::Box(Cuboid::lower(block, problems)?),
            BlockKind::Checkerboard => Self::Checkerboard(Checkerboard::lower(block)?),
            BlockKind::Image | BlockKind::Camera | BlockKind::Sampler => return None,
        })
    }

    /// Returns the kind of the shape's block.
    pub fn block_kind(&self) -> BlockKind {
        match self {
            Self::Sphere(_) => BlockKind::Sphere,
            Self::Triangle(_) => BlockKind::Triangle,
            Self::Box(_) => BlockKind::Box,
            Self::Checkerboard(_) => BlockKind::Checkerboard,
        }
    }

    /// Returns the keyword of the shape's block.
    pub fn kind(&self) -> &'static str {
        schema::of_kind(self.block_kind()).name
    }

    /// Returns three colours of the shape. For a box, they are the colours of the faces
    /// perpendicular to x, y and z. For a checkerboard, the first is the colour of the even
    /// squares, and the others are the colour of the odd squares. For any other shape, all three
    /// are its only colour.
    pub fn colors(&self) -> [Color; 3] {
        for_each_kind!(self, own => own.colors())
    }

    /// Returns the checkerboard, or `None` for any other shape.
    pub fn checkerboard(&self) -> Option<&Checkerboard> {
        match self {
            Self::Checkerboard(board) => Some(board),
            Self::Sphere(_) | Self::Triangle(_) | Self::Box(_) => None,
        }
    }

    /// Returns the shape as a box; `None` for any other shape.
    pub fn cuboid(&self) -> Option<&Cuboid> {
        match self {
            Self::Box(cuboid) => Some(cuboid),
            Self::Sphere(_) | Self::Triangle(_) | Self::Checkerboard(_) => None,
        }
    }

    /// Returns the centre of the shape's bounding sphere; `None` if the shape is infinite.
    pub fn center(&self) -> Option<DVec3> {
        self.bounding_sphere().map(|(center, _)| center)
    }

    /// Returns the corners with the least and the greatest coordinates of the shape's bounding box.
    /// Returns `None` if the shape is infinite. `vertices` computes the vertices of a triangle.
    pub fn bounding_box(
        &self,
        vertices: impl FnOnce(&Triangle) -> [DVec3; 3],
    ) -> Option<[DVec3; 2]> {
        match self {
            Self::Sphere(sphere) => Some(sphere.bounding_box()),
            Self::Triangle(triangle) => {
                let [a, b, c] = vertices(triangle);
                Some([a.min(b).min(c), a.max(b).max(c)])
            }
            Self::Box(cuboid) => Some([cuboid.min, cuboid.max]),
            Self::Checkerboard(_) => None,
        }
    }

    /// Returns centre and radius of a sphere that contains the shape; `None` if the shape is
    /// infinite.
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        for_each_kind!(self, own => own.bounding_sphere())
    }

    /// Returns the greatest of two kinds of lengths: the shape's own lengths, such as a radius, and
    /// the distances of its centre or vertices from the point `from` along each axis. For a
    /// checkerboard, returns its vertical distance from `from`.
    pub fn greatest_length(&self, from: DVec3) -> f64 {
        for_each_kind!(self, own => own.greatest_length(from))
    }

    /// Returns the fields with which the shape is written as a text, and their values. A box is
    /// written with its corners rather than its centre and size.
    pub(super) fn fields(mut self) -> impl Iterator<Item = (&'static str, Value)> {
        let row = schema::of_kind(self.block_kind());
        let value = move |name| Some((name, self.field_mut(name)?.value()));
        row.field_names().filter_map(value)
    }

    /// Returns a mutable reference to the field `name`. Returns `None` if the shape has no such
    /// field, and for the `center` and `size` of a box, because they are computed from the corners.
    pub(super) fn field_mut(&mut self, name: &str) -> Option<&mut dyn FieldValue> {
        for_each_kind!(self, own => own.field_mut(name))
    }

    /// Returns whether all fields of the shape meet the language's conditions. These are checked in
    /// `f64`, so a value within rounding error of a limit may be misjudged.
    pub fn is_possible(&self) -> bool {
        for_each_kind!(self, own => own.is_possible())
    }

    /// Describes the shape in one line. `vertices` computes the vertices of a triangle.
    pub fn summary(&self, vertices: impl FnOnce(&Triangle) -> [DVec3; 3]) -> String {
        match self {
            Self::Sphere(sphere) => sphere.summary(),
            Self::Triangle(triangle) => triangle.summary(vertices(triangle)),
            Self::Box(cuboid) => cuboid.summary(),
            Self::Checkerboard(board) => board.summary(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::iter;

    use crate::{
        scene::{FieldOwner, analyze, eval::literal},
        schema::{BLOCKS, BlockRow, FieldRow},
        source::{Source, Sources},
    };

    /// Returns lists of fields that together make a valid block of the kind `row`. Fields of
    /// different alternatives of a [`Choice`](crate::schema::Choice) exclude each other, so they
    /// are in different lists. Each field is in at least one list.
    fn ways(row: &'static BlockRow) -> impl Iterator<Item = Vec<&'static FieldRow>> {
        let most = row.choices.iter().map(|choice| choice.ways.len()).max();
        (0..most.unwrap_or(1)).map(move |way| {
            let excluded = row.choices.iter().flat_map(move |choice| {
                let taken = choice.ways[way.min(choice.ways.len() - 1)];
                row.excludes(taken[0])
            });
            let excluded: Vec<&str> = excluded.collect();
            let fields = row.fields.iter();
            fields.filter(|it| !excluded.contains(&it.name)).collect()
        })
    }

    #[test]
    fn every_field_of_an_object_is_read_and_changed_by_its_name() {
        let objects = BLOCKS.iter().filter(|row| row.is_object);
        for (row, fields) in objects.flat_map(|row| iter::repeat(row).zip(ways(row))) {
            let given = fields
                .iter()
                .map(|it| format!("{} {}", it.name, it.example));
            let text = format!("{} {{ {} }}", row.name, given.collect::<Vec<_>>().join(" "));
            let sources = Sources::new(Source::from_text("", text.clone()));
            let objects = analyze(&sources).parts.objects;
            let shape = objects.first().expect(&text).shape;
            let owner = FieldOwner::Shape(shape);
            assert_eq!(shape.kind(), row.name);
            for field in fields {
                let value = literal(field.example, field.takes);
                assert_eq!(owner.value(field.name), value, "{}: {text}", field.name);
                let same = owner.with(field.name, value.unwrap());
                assert_eq!(same, Some(owner), "{}: {text}", field.name);
            }
            assert!(shape.is_possible(), "{text}");
        }
    }
}
