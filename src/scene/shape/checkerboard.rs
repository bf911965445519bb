//! The shape `checkerboard`. This file builds it from its block, gives access to its fields,
//! computes its extent, and describes it.

use glam::DVec3;

use crate::{
    color::Color,
    numbers::short,
    scene::lowered_block::LoweredBlock,
    schema::{CHECKERBOARD, CheckerboardFields, FieldValue},
};

/// The infinite checkerboard in a horizontal plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// Height of the plane in metres, i.e. its y coordinate.
    pub y: f64,
    /// Side of a square in metres, > 0.
    pub square: f64,
    /// The colours of the even and of the odd squares. A square is even if floor(x/square) +
    /// floor(z/square) is even for its points.
    pub colors: [Color; 2],
}

impl Checkerboard {
    pub(super) fn lower(block: &LoweredBlock<'_>) -> Option<Self> {
        let CheckerboardFields { y, square, colors } = CHECKERBOARD;
        Some(Self {
            y: block.value(y)?,
            square: block.value(square)?,
            colors: block.value(colors)?,
        })
    }

    pub(super) fn field_mut(&mut self, name: &str) -> Option<&mut dyn FieldValue> {
        let field = CHECKERBOARD.y.of(name, &mut self.y);
        let field = field.or(CHECKERBOARD.square.of(name, &mut self.square));
        field.or(CHECKERBOARD.colors.of(name, &mut self.colors))
    }

    pub(super) fn is_possible(&self) -> bool {
        self.square > 0.0 && self.square.is_finite() && self.y.is_finite()
    }

    pub(super) fn colors(&self) -> [Color; 3] {
        let [even, odd] = self.colors;
        [even, odd, odd]
    }

    pub(super) fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        None
    }

    pub(super) fn greatest_length(&self, from: DVec3) -> f64 {
        (self.y - from.y).abs()
    }

    pub(super) fn summary(&self) -> String {
        let Self { y, square, colors } = *self;
        let [even, odd] = colors;
        let (y, square) = (short(y), short(square));
        format!("y {y}, squares of {square}, {even} and {odd}")
    }
}
