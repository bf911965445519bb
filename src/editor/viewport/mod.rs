//! What an interactive view of the picture needs: what is seen at a point, what to draw over it,
//! and what moving a handle does to the text.
//!
//! In: a text and its scene, and points of the picture in pixels from its top left corner. Out:
//! points, and edits of the text. Nothing here is told to anybody before it was computed from the
//! scene's numbers, so `f64` is exact enough; what is seen the tracer decides.
//!
//! `lines` says where lines of the world are seen. `handles` knows where an object's handles are
//! and how one moves the object, `camera` how the pointer moves the camera; `edits` writes the
//! fields that change into the text. `drag` is all of that together. `add` writes blocks that
//! are new.

mod add;
mod camera;
mod drag;
mod edits;
mod handles;
mod lines;
mod overlays;
mod pick;

use super::analysis::Analysis;
use crate::{
    scene::{Object, Scene},
    source::Span,
};

pub use add::{Added, add, duplicate};
pub use drag::{Drag, Dragged, alone, drag};
pub use handles::Along;
pub use overlays::{MOST_OBJECTS, Outline, Overlays, Shown, Vanishing, hide, overlays};
pub use pick::{MOST_SAMPLES, PixelSamples, pick, samples};

/// For each object the place that stands for it: its name, or the keyword of its block.
pub fn selections(analysis: &Analysis<'_>, scene: &Scene) -> Vec<Span> {
    let mut blocks = analysis.blocks().peekable();
    let selection = |object: &Object| {
        // Several objects may stand in one block.
        while blocks
            .next_if(|block| block.span.start < object.span.start)
            .is_some()
        {}
        let block = blocks.peek().filter(|block| block.span == object.span);
        block.map_or(object.span, |block| {
            block.name.map_or(block.keyword(), |name| name.span)
        })
    };
    scene.objects.iter().map(selection).collect()
}
