//! Builds an object when all fields of its block have values.

use super::lowering::Lowering;
use crate::{
    scene::{lowered_block::LoweredBlock, model::Object, shape::Shape},
    schema::CHECKERBOARD,
};

impl<'s> Lowering<'s> {
    /// Builds the object of a block for the values `indices` of its indices. Returns `false`, and
    /// builds nothing, if a value is missing or wrong.
    pub(super) fn object(&mut self, block: &LoweredBlock<'s>, indices: &[u32]) -> bool {
        let Some(shape) = Shape::lower(block, &mut self.problems) else {
            return false;
        };
        if let Shape::Checkerboard(board) = shape {
            self.boards.push((board, block.place(CHECKERBOARD.square)));
        }
        let name = block.name.map(|name| match indices {
            [] => name.text.to_owned(),
            _ => format!("{}[{}]", name.text, listed(indices)),
        });
        self.objects.push(Object {
            name,
            indices: indices.into(),
            shape,
            span: block.span,
        });
        true
    }
}

fn listed(indices: &[u32]) -> String {
    indices
        .iter()
        .map(u32::to_string)
        .collect::<Vec<_>>()
        .join(", ")
}
