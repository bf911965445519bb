//! `diff`: pictures compared, and the mistakes in them named.

mod alike;
mod bytes;
mod faint;
mod mistakes;
mod numbers;
mod objects;
mod pairs;
mod pictures;
mod right;
mod samples;
mod ties;

use std::{fs, path::Path, process::Output};

use image::DynamicImage;
use serde_json::Value;
use tempfile::TempDir;

use crate::program::command;

/// A small scene that sees something of everything.
const SCENE: &str = "image { width 96 height 64 background navy }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) roll 10deg d 2.75 }
sampler { method exact }
sphere Ball { center (-1.6, 1, 0) }
triangle Sail { centroid (0.2, 1, 0.6) normal (0.3, 0, 1) sides (2, 2, 1) }
box Crate { center (2, 0.75, -0.5) }
checkerboard {}
";

/// A fresh folder with the scene in `a.scn` and its exact picture in `a.png`.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), SCENE).unwrap();
    render(&folder, &["-o", "a.png"]);
    folder
}

fn pinhole(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

fn render(folder: &TempDir, arguments: &[&str]) {
    let arguments = [&["render", "a.scn"], arguments].concat();
    let output = pinhole(folder.path(), &arguments);
    assert!(output.status.success(), "{output:?}");
}

fn diff(folder: &TempDir, arguments: &[&str]) -> (i32, String) {
    let output = pinhole(folder.path(), &[&["diff"], arguments].concat());
    assert_eq!(output.stdout, b"", "{arguments:?}");
    let text = String::from_utf8(output.stderr).unwrap();
    (output.status.code().unwrap(), text)
}

fn json(folder: &TempDir, arguments: &[&str]) -> Value {
    let all = [&["diff"], arguments, &["--format", "json"]].concat();
    let output = pinhole(folder.path(), &all);
    assert!(output.stderr.is_empty(), "{output:?}");
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    let status = if value["equal"] == true { 0 } else { 1 };
    assert_eq!(output.status.code(), Some(status), "{value}");
    value
}

/// The name of the first mistake that is found in `b.png`.
fn mistake(folder: &TempDir) -> String {
    let found = json(folder, &["b.png", "a.scn"]);
    found["likely"][0]["mistake"]
        .as_str()
        .unwrap_or("none")
        .to_owned()
}

fn open(folder: &TempDir, name: &str) -> DynamicImage {
    image::open(folder.path().join(name)).unwrap()
}

fn save(folder: &TempDir, name: &str, picture: impl Into<DynamicImage>) {
    picture.into().save(folder.path().join(name)).unwrap();
}
