//! Objects, built once all fields of their blocks have values.

use super::lowering::Lowering;
use crate::{
    scene::{lowered_block::LoweredBlock, model::Object, shape::Shape},
    schema::CHECKERBOARD,
};

impl<'s> Lowering<'s> {
    /// Builds an object of a block at some values of its indices. Returns whether it is built: not
    /// if a value is missing or wrong.
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
