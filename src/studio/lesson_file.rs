//! Reads a teacher's lesson, which the host offers to its pages.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::draft::Read;
use crate::source::Source;

/// The file of a lesson. The lesson's scene is beside it, in a file with the ending .scn.
#[derive(Debug)]
pub struct LessonFile {
    path: PathBuf,
    read: Read,
}

impl LessonFile {
    /// Makes the lesson in the file at `path`, without reading it yet. The function `read` will
    /// read this file and the file of the lesson's scene.
    pub fn new(path: &Path, read: Read) -> Self {
        let path = path.to_owned();
        Self { path, read }
    }

    /// Reads the lesson for a page that has just connected. It is read anew for each page, so that
    /// a teacher can change it and load the page again. Returns null if a file cannot be read.
    pub fn for_page(&self) -> Value {
        let text = |path: &Path| {
            let bytes = (self.read)(path).ok()?;
            Some(Source::from_bytes("", bytes).text().to_owned())
        };
        let name = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let texts = text(&self.path).zip(text(&self.path.with_extension("scn")));
        texts.map_or(
            Value::Null,
            |(text, start)| json!({ "name": name, "text": text, "start": start }),
        )
    }
}
