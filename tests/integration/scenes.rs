//! Scenes: those that stand beside the source, those of a text, and their pictures.

use std::{
    fs,
    num::NonZero,
    path::{Path, PathBuf},
};

use pinhole::{
    area::Area,
    film::Film,
    render::{Control, render},
    sampling::Sampling,
    scene::{self, Scene},
    source::{Source, Sources},
    tracer::World,
};

/// The scenes in a folder, by name.
pub fn scenes(folder: impl AsRef<Path>) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "scn");
    let mut scenes: Vec<_> = paths.filter(is_scene).collect();
    scenes.sort();
    scenes
}

/// The texts of the examples.
pub fn examples() -> Vec<String> {
    let texts = scenes("examples").into_iter().map(fs::read_to_string);
    texts.map(|text| text.expect("a text")).collect()
}

/// How a picture is rendered by the calling thread alone.
pub fn one_thread() -> Control<'static> {
    Control {
        threads: NonZero::new(1),
        ..Control::default()
    }
}

pub fn sources(text: &str) -> Sources {
    Sources::new(Source::from_text("test.scn", text))
}

/// A scene without errors; its warnings may be some.
pub fn read(text: &str) -> Scene {
    let reading = scene::read(&sources(text));
    let found = &reading.diagnostics;
    reading
        .scene
        .unwrap_or_else(|| panic!("{text}\n{found:#?}"))
}

/// A part of a scene's picture by its own samples.
pub fn sampled(scene: &Scene, part: Area) -> Film {
    sampled_by(scene, part, &Control::default())
}

pub fn sampled_by(scene: &Scene, part: Area, control: &Control<'_>) -> Film {
    let sampling = Sampling::new(&scene.sampler, scene.image.width, scene.image.height);
    render(&World::new(scene), &sampling, part, control).unwrap()
}

/// The contents of a document's fences of this kind.
pub fn fenced<'p>(text: &'p str, kind: &str) -> Vec<&'p str> {
    let start = format!("```{kind}\n");
    let parts = text.split(&start).skip(1);
    parts
        .map(|part| part.split_once("```").expect("a fence ends").0)
        .collect()
}
