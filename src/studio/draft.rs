//! Stores drafts of a scene, i.e. texts that were edited on a page but not saved. Only the user can
//! read them.
//!
//! All drafts of a scene are in one file in the user's state folder, named after the scene's
//! canonical path. A browser's own storage is not suitable, because it is separate for each port,
//! and the host has another port in each run. Each page stores its draft under a key of its own, so
//! that pages do not overwrite each other's drafts. A draft is removed when its text is saved or
//! when it is too old.

use std::{
    io,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use serde::{Deserialize, Serialize};

use crate::files;

/// A function that reads a file up to the maximum length of a scene.
pub type Read = fn(&Path) -> io::Result<Vec<u8>>;

/// Time after which the file with the drafts of a scene is removed if it does not change: 30 days.
/// With a shorter time, drafts could be lost too early. With a longer time, many forgotten texts
/// would be stored.
const LIFETIME: Duration = Duration::from_secs(30 * 24 * 60 * 60);

/// Maximum number of drafts that are stored for a scene. If there are more, the oldest are removed.
/// Each open page stores one draft, and users rarely have more than a few pages open.
const MOST: usize = 10;

/// A draft, i.e. a text that was edited on a page but not saved.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Unsaved {
    /// Key under which the draft is stored. Each page has a key of its own.
    pub id: String,
    /// File name of a new scene, if the user has chosen one.
    pub name: Option<String>,
    pub text: String,
    /// Content of the scene's file when the page began to edit it; `None` for a new scene without a
    /// file.
    base: Option<String>,
    /// Time at which the draft was made, in seconds since 1970.
    time: u64,
}

impl Unsaved {
    /// Makes a draft with the current time.
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

/// Path of the file with the drafts of a scene; `None` if the system has no folder for them.
#[derive(Debug, Default)]
pub struct Drafts(Option<PathBuf>);

impl Drafts {
    /// Returns the location of the drafts of the scene at `path`. For a new scene, `path` is the
    /// folder in which it would be saved. Also removes old drafts, of this and all other scenes.
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

    /// Reads the drafts, the newest first. Returns an empty list if they cannot be read.
    pub fn kept(&self, read: Read) -> Vec<Unsaved> {
        let read = || serde_json::from_slice(&read(self.0.as_deref()?).ok()?).ok();
        read().unwrap_or_default()
    }

    /// Stores the first [`MOST`] of `drafts` in place of the previous ones. The newest draft must
    /// come first.
    ///
    /// # Errors
    ///
    /// Returns a message if the drafts cannot be stored.
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
