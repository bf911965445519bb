//! Answers the requests of an interactive view of the picture: the object at a point, the lines to
//! draw over the picture, and the change of the text when a handle is dragged.
//!
//! In: a text and its scene, and points of the picture in pixels from its top left corner. Out:
//! points, and edits of the text. Points are computed in `f64`, which is accurate enough for a
//! screen; the tracer decides which object is visible.
//!
//! `lines` projects lines into the picture, and `silhouette` computes the silhouette of a sphere.
//! `handles` computes the handles of an object and moves the object, `camera` moves the camera, and
//! `edits` writes the changed fields into the text. `drag` combines these three. `add` writes new
//! blocks. `pick` examines one point of the picture, and `glass` one pixel. `observer` chooses a
//! second camera, which looks at the scene and at the scene's camera from outside. `outside` draws
//! the scene's camera in this second picture, and moves it there.

mod add;
mod camera;
mod drag;
mod edits;
mod glass;
mod handles;
mod lines;
mod observer;
mod outside;
mod overlays;
mod pick;
mod silhouette;

use super::analysis::Analysis;
use crate::{
    scene::{Object, Scene},
    source::Span,
};

pub use add::{Added, add, duplicate};
pub use drag::{Drag, Dragged, alone, drag};
pub use glass::{Glass, MethodErrors, SAMPLE_COUNTS, SeenColor, glass, seen_colors};
pub use handles::Along;
pub use lines::clip;
pub use observer::{Observer, USUAL_FOV, towards_observer};
pub use outside::{CameraHandle, CameraOverlay, PointedRay, camera_overlay};
pub use overlays::{
    MOST_OBJECTS, ObjectOverlay, Overlays, ShownObjects, Vanishing, hide, overlays,
};
pub use pick::{MOST_SAMPLES, PixelSamples, color_of, pick, samples};

/// Returns for each object the span that an editor selects when the object is clicked in the
/// picture: its name, or else the keyword of its block.
pub fn selections(analysis: &Analysis<'_>, scene: &Scene) -> Vec<Span> {
    let mut blocks = analysis.blocks().peekable();
    let selection = |object: &Object| {
        // A repeated block describes several objects with the same span, so the iterator stays at
        // the block until an object starts after it.
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
