//! Answers for an interactive view of the picture: what is seen at a point, what to draw over it,
//! and how moving a handle changes the text.
//!
//! In: a text and its scene, and points of the picture in pixels from its top left corner. Out:
//! points, and edits of the text. Points are computed from the scene's numbers, for which `f64` is
//! exact enough; the tracer decides what is seen.
//!
//! `lines` projects lines of the world. `handles` places the handles of an object and moves the
//! object, `camera` moves the camera, and `edits` writes the changed fields into the text. `drag`
//! puts these together. `add` writes new blocks.

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
pub use lines::clip;
pub use overlays::{
    MOST_OBJECTS, ObjectOverlay, Overlays, ShownObjects, Vanishing, hide, overlays,
};
pub use pick::{MOST_SAMPLES, PixelSamples, pick, samples};

/// Returns for each object the span that is selected for it: its name, or the keyword of its block.
pub fn selections(analysis: &Analysis<'_>, scene: &Scene) -> Vec<Span> {
    let mut blocks = analysis.blocks().peekable();
    let selection = |object: &Object| {
        // A repeated block has several objects.
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
