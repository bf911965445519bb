//! The scenes that stand beside the source.

use std::{
    fs,
    path::{Path, PathBuf},
};

/// The scenes in a folder, by name.
pub fn scenes(folder: &str) -> Vec<PathBuf> {
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
