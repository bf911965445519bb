//! Tests of values that `--set` arguments override.

use pinhole::{
    scene::{self, Reading},
    source::Sources,
};

use crate::{scenes::sources, table::rows};

pub const SCENE: &str = "let h = 1
let middle = (0, h, 0)
camera { eye (0, 2, 8) lookat middle d 3 }
sphere Ball { center middle radius h }
let late = 7
box Crate { center middle size (1, 1, 1) }
checkerboard { }
";

/// Returns two texts: the settings of a scene, and its shapes. Panics if the scene has errors.
pub fn meaning(sources: &Sources) -> [String; 2] {
    let Reading {
        scene, diagnostics, ..
    } = scene::read(sources);
    let scene = scene.unwrap_or_else(|| panic!("{diagnostics:#?}"));
    let shapes: Vec<_> = scene.objects.iter().map(|object| object.shape).collect();
    let settings = (scene.image, scene.camera, scene.sampler);
    [format!("{settings:?}"), format!("{shapes:?}")]
}

/// Each row has `--set` arguments, a part of the text, and a replacement for this part. The
/// arguments must have the same effect as the replacement.
#[test]
fn a_set_argument_equals_the_edited_text() {
    let table = "
        camera.roll=30deg -> d 3 -> d 3 roll 30deg
        Ball.center=(0, 2, 0) -> Ball { center middle -> Ball { center (0, 2, 0)
        h=1.5 -> let h = 1 -> let h = 1.5
        Ball . radius = h + 1 -> radius h -> radius h + 1
        -- A block that the file leaves out.
        image.width=10 -> let h -> image { width 10 } let h
        -- The last one wins.
        h=2; h=nothing; h=3 -> let h = 1 -> let h = 3
        Ball.radius=2; Ball.radius=red; Ball.radius=3 -> radius h -> radius 3
        -- Alternatives are replaced.
        camera.direction=(0, 0, -1) -> lookat middle -> direction (0, 0, -1)
        camera.fov=40deg -> d 3 -> fov 40deg
        camera.fov=40deg; camera.d=4 -> d 3 -> d 4
        sampler.per_pixel=4; sampler.total=1e6 -> let h -> sampler { total 1e6 } let h
        Crate.min=(0, 0, 0); Crate.max=(1, 2, 3) -> center middle size (1, 1, 1) -> min (0, 0, 0) max (1, 2, 3)
        -- A field sees all names, and a definition those before it.
        Ball.radius=late -> radius h -> radius 7
        late=h + 1 -> let late = 7 -> let late = 2
    ";
    for [sets, before, after] in rows(table) {
        assert!(SCENE.contains(before), "{before}");
        let written = meaning(&sources(&SCENE.replacen(before, after, 1)));
        let set = sources(SCENE).with_sets(sets.split("; "));
        assert_eq!(meaning(&set), written, "{sets}");
    }
}
