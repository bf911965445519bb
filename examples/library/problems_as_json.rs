//! Prints the mistakes and warnings of a scene as JSON of one's own: a list of places, messages and
//! what could be written instead.
//!
//! `cargo run --example problems_as_json -- SCENE`
#![allow(
    clippy::disallowed_methods,
    reason = "only Pinhole itself opens all files by one module"
)]

use std::{error::Error, fs};

use pinhole::{Diagnostic, Scene, source::Sources};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which scene?")?;
    println!("{:#}", problems(&fs::read_to_string(path)?));
    Ok(())
}

/// Returns the problems of a text.
pub fn problems(text: &str) -> Value {
    match Scene::parse(text) {
        Ok(scene) => list(scene.diagnostics(), scene.sources()),
        Err(mistakes) => list(&mistakes, mistakes.sources()),
    }
}

fn list<'a>(problems: impl IntoIterator<Item = &'a Diagnostic>, sources: &Sources) -> Value {
    let problem = |it: &Diagnostic| {
        let place = it.labels.first().map(|label| sources.place(label.span));
        json!({
            "line": place.map(|place| place.line),
            "column": place.map(|place| place.column),
            "severity": it.severity.word(),
            "message": it.message,
            "instead": it.fixes.first().map(|fix| &fix.title),
        })
    };
    problems.into_iter().map(problem).collect()
}
