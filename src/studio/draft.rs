//! The drafts of a scene: what its pages have written and not saved, kept for the user alone.
//!
//! They stand in a file of their own in the user's folder for such things, named by the scene's
//! canonical path, since what a browser keeps belongs to a port, and the host has another one each
//! time. Each page keeps one, under a key of its own, so that no page writes over another's. Saving
//! their text removes them, and so does time.

use std::{
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use serde::{Deserialize, Serialize};

use crate::files;

/// What reads a file, up to the length that scenes have.
pub type Read = fn(&Path) -> io::Result<Vec<u8>>;

/// How long a draft is kept that nobody asks for.
const LIFETIME: Duration = Duration::from_secs(30 * 24 * 60 * 60);

/// Maximum number of drafts of a scene; with one more, the oldest is forgotten.
const MOST: usize = 10;

/// A text that was not saved.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Unsaved {
    /// The key that its page has given it.
    pub id: String,
    /// What its scene is called.
    pub name: Option<String>,
    pub text: String,
    /// What was in the file that it was made from.
    base: Option<String>,
    /// When it was kept, in seconds since 1970.
    time: u64,
}

impl Unsaved {
    /// A text of now.
    pub fn new(id: &str, name: Option<&str>, text: &str, base: Option<&str>) -> Self {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            id: id.to_owned(),
            name: name.map(str::to_owned),
            text: text.to_owned(),
            base: base.map(str::to_owned),
            time: now.map_or(0, |now| now.as_secs()),
        }
    }
}

/// Where the drafts of a scene are; nowhere if the system has no place for them.
#[derive(Debug, Default)]
pub struct Drafts(Option<PathBuf>);

impl Drafts {
    /// The drafts of the scene in a file; of a new scene, of the folder that it would be saved in.
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

    /// What is kept, the newest first.
    pub fn kept(&self, read: Read) -> Vec<Unsaved> {
        let read = || serde_json::from_slice(&read(self.0.as_deref()?).ok()?).ok();
        read().unwrap_or_default()
    }

    /// Keeps the first of these, which are the newest ones, in the place of what is kept.
    ///
    /// # Errors
    ///
    /// Why they are not kept, in words.
    pub fn keep(&self, drafts: &[Unsaved]) -> Result<(), String> {
        if drafts.is_empty() {
            if let Some(path) = &self.0 {
                files::forget(path);
            }
            return Ok(());
        }
        let path = self.0.as_deref();
        let path = path.ok_or("this system has no folder for drafts")?;
        let newest = &drafts[..drafts.len().min(MOST)];
        let text = serde_json::to_string(newest).map_err(|error| error.to_string())?;
        let kept = files::keep(path, &text);
        kept.map_err(|error| format!("the draft is not kept: {error}"))
    }
}
