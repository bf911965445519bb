//! The shape `checkerboard`: how it is lowered, its fields, its extent and its description.

use glam::DVec3;
use serde_json::{Value as Json, json};

use super::json_colors;
use crate::{
    color::Color,
    numbers::short,
    scene::{field_ref::FieldRef, lowered_block::LoweredBlock},
    schema::{CHECKERBOARD, CheckerboardFields},
};

/// The infinite checkerboard in a horizontal plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// Height of the plane in metres, i.e. its y coordinate.
    pub y: f64,
    /// Side of a square in metres, > 0.
    pub square: f64,
    /// The colours of the even and of the odd squares. A square is even if floor(x/square) +
    /// floor(z/square) is even in it.
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

    pub(super) fn field_mut(&mut self, name: &str) -> Option<FieldRef<'_>> {
        Some(match name {
            _ if name == CHECKERBOARD.y.name => FieldRef::Number(&mut self.y),
            _ if name == CHECKERBOARD.square.name => FieldRef::Number(&mut self.square),
            _ if name == CHECKERBOARD.colors.name => FieldRef::Colors(&mut self.colors),
            _ => return None,
        })
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

    pub(super) fn facts(&self) -> Vec<(&'static str, Json)> {
        let Self { y, square, colors } = *self;
        vec![
            ("y", json!(y)),
            ("square", json!(square)),
            ("colors", json_colors(&colors)),
        ]
    }
}
