//! The picture's answers to one who writes a scene: handles that are moved, and what becomes of the text.

mod any_drag;
mod drags;

use glam::{DVec2, DVec3, dvec2};
use pinhole::{
    diagnostic::{Fix, apply},
    editor::{
        Analysis,
        viewport::{Along, Drag, drag},
    },
    inspect::inspect,
    scene::Scene,
    source::SourceId,
};

use crate::scenes::{read, sources};

/// A text after a handle was moved; or why it cannot be.
fn dragged(text: &str, moved: Drag<'_>) -> Result<String, String> {
    let sources = sources(text);
    let analysis = Analysis::new(&sources);
    let dragged = drag(&analysis, &read(text), &moved)?;
    let fix = Fix::new("", dragged.edits);
    Ok(apply(&fix, SourceId::File, text))
}

fn object<'a>(handle: &'a str, to: [f64; 2], word: &str) -> Drag<'a> {
    Drag {
        object: Some(0),
        handle,
        from: DVec2::from(to),
        to: DVec2::from(to),
        along: Along::named(word),
    }
}

/// Where a point is seen, by the numbers of `pinhole inspect`.
fn seen(scene: &Scene, point: DVec3) -> DVec2 {
    let camera = inspect(scene, &sources("").file).camera;
    let from_eye = point - camera.eye;
    let (width, height) = (f64::from(scene.image.width), f64::from(scene.image.height));
    let scale = camera.d * height / camera.view_height / -from_eye.dot(camera.w);
    dvec2(
        width / 2.0 + from_eye.dot(camera.u) * scale,
        height / 2.0 - from_eye.dot(camera.v) * scale,
    )
}

fn near(a: DVec2, b: DVec2, text: &str) {
    assert!(a.distance(b) <= 0.5 + 1e-6, "{a} is not near {b}\n{text}");
}
