//! Helpers for scenes: the scenes of the repository, scenes from texts, and their pictures.

use std::{
    fs,
    num::NonZero,
    path::{Path, PathBuf},
};

use pinhole::{
    area::Area,
    film::{Film, Pixel},
    inspect::Inspection,
    render::{Control, Exact, Rendered, render_as_asked, render_exact},
    sampling::Sampling,
    scene::{self, Count, Method, Sampler, Scene},
    source::{Source, Sources},
    tracer::World,
};

/// Returns the paths of the scenes in a folder, sorted by name.
pub fn scenes(folder: impl AsRef<Path>) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "scn");
    let mut scenes: Vec<_> = paths.filter(is_scene).collect();
    scenes.sort();
    scenes
}

pub fn examples() -> Vec<String> {
    let names = example_names().into_iter();
    names.map(|name| example_text(&name)).collect()
}

/// Returns the names of the example scenes.
pub fn example_names() -> Vec<String> {
    let paths = scenes("examples").into_iter();
    let name = |path: PathBuf| path.file_stem().unwrap().to_str().unwrap().to_owned();
    paths.map(name).collect()
}

pub fn example_text(name: &str) -> String {
    let path = format!("{}/examples/{name}.scn", env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(path).unwrap()
}

/// Returns an example scene with another width and height.
pub fn example(name: &str, width: u32, height: u32) -> Scene {
    resized(read(&example_text(name)), width, height)
}

pub fn resized(mut scene: Scene, width: u32, height: u32) -> Scene {
    (scene.image.width, scene.image.height) = (width, height);
    scene
}

pub fn with_samples(scene: &Scene, method: Method, count: Count) -> Scene {
    let sampler = Sampler {
        method,
        count,
        seed: 5,
    };
    Scene {
        sampler,
        ..scene.clone()
    }
}

pub fn whole(scene: &Scene) -> Area {
    Area::whole(scene.image.width, scene.image.height)
}

/// Returns settings with which only the calling thread renders.
pub fn one_thread() -> Control<'static> {
    Control {
        threads: NonZero::new(1),
        ..Control::default()
    }
}

pub fn sources(text: &str) -> Sources {
    Sources::new(Source::from_text("test.scn", text))
}

/// Reads a scene. Panics if it has errors; warnings are allowed.
pub fn read(text: &str) -> Scene {
    read_with(text, [])
}

/// Reads a scene with `--set` arguments. Panics if there are errors; warnings are allowed.
pub fn read_with<'s>(text: &str, sets: impl IntoIterator<Item = &'s str>) -> Scene {
    let reading = scene::read(&sources(text).with_sets(sets));
    let found = &reading.diagnostics;
    reading
        .scene
        .unwrap_or_else(|| panic!("{text}\n{found:#?}"))
}

/// Returns the picture of a scene by the sampling method that the scene selects.
pub fn sampled(scene: &Scene) -> Film {
    rendered(scene, whole(scene), &Control::default()).into_film()
}

/// Renders an area of a scene's picture by the method that the scene selects.
pub fn rendered<P: Pixel>(scene: &Scene, part: Area, control: &Control<'_>) -> Rendered<P> {
    render_as_asked(&World::new(scene), &sampling(scene), part, control).unwrap()
}

/// Returns the sampling that a scene specifies.
pub fn sampling(scene: &Scene) -> Sampling {
    Sampling::new(&scene.sampler, scene.image.width, scene.image.height)
}

/// Returns the exact picture of a scene.
pub fn exact(scene: &Scene) -> Exact {
    render_exact(&World::new(scene), whole(scene), &Control::default()).unwrap()
}

/// Returns the contents of those fenced code blocks of a document that begin with three backticks
/// and `kind`.
pub fn fenced<'p>(text: &'p str, kind: &str) -> Vec<&'p str> {
    let start = format!("```{kind}\n");
    let parts = text.split(&start).skip(1);
    parts
        .map(|part| part.split_once("```").expect("a fence ends").0)
        .collect()
}

/// Returns the result of `inspect` as JSON.
pub fn json_of(inspection: &Inspection) -> serde_json::Value {
    let mut text = Vec::new();
    inspection.write_json(&mut text).unwrap();
    serde_json::from_slice(&text).unwrap()
}
