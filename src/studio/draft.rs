//! The draft of a scene: what a page has written and not saved, kept for the user alone.
//!
//! It stands in a file of its own in the user's folder for such things, named by the scene's
//! canonical path, since what a browser keeps belongs to a port, and the host has another one each
//! time. Saving removes it, and so does time.

use std::{
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use serde_json::{Value, json};

use crate::files;

/// What reads a file, up to the length that scenes have.
pub type Read = fn(&Path) -> io::Result<Vec<u8>>;

/// How long a draft is kept that nobody asks for.
const LIFETIME: Duration = Duration::from_secs(30 * 24 * 60 * 60);

/// Where the draft of a scene is; nowhere if the system has no place for it.
#[derive(Debug, Default)]
pub struct Draft(Option<PathBuf>);

impl Draft {
    /// The draft of the scene in a file; of a new scene, of the folder that it would be saved in.
    pub fn of(path: &Path) -> Self {
        let place = || {
            let folder = files::kept_folder("drafts")?;
            files::forget_older(&folder, LIFETIME);
            let path = std::path::absolute(path).ok()?;
            let path = path.canonicalize().unwrap_or(path);
            let name = files::name_of(path.as_os_str().as_encoded_bytes());
            Some(folder.join(name))
        };
        Self(place())
    }

    /// What is kept: the text, what it was made from, and when, in seconds since 1970.
    pub fn kept(&self, read: Read) -> Option<Value> {
        let bytes = read(self.0.as_deref()?).ok()?;
        let kept: Value = serde_json::from_slice(&bytes).ok()?;
        kept["text"].is_string().then_some(kept)
    }

    /// Keeps a text.
    ///
    /// # Errors
    ///
    /// Why it is not kept, in words.
    pub fn keep(&self, text: &str, base: Option<&str>) -> Result<(), String> {
        let path = self.0.as_deref();
        let path = path.ok_or("this system has no folder for drafts")?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        let time = now.map_or(0, |now| now.as_secs());
        let draft = json!({ "text": text, "base": base, "time": time });
        let kept = files::keep(path, &draft.to_string());
        kept.map_err(|error| format!("the draft is not kept: {error}"))
    }

    /// Removes what is kept.
    pub fn forget(&self) {
        if let Some(path) = &self.0 {
            files::forget(path);
        }
    }
}
