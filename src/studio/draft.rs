//! The draft of a scene: what a page has written and not saved, kept for the user alone, and what
//! earlier pages have, as long as nobody has said what is to become of it.
//!
//! It stands in a file of its own in the user's folder for such things, named by the scene's
//! canonical path, since what a browser keeps belongs to a port, and the host has another one each
//! time. Saving removes it, and so does time.

use std::{
    io, iter,
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

use serde::{Deserialize, Serialize};

use crate::files;

/// What reads a file, up to the length that scenes have.
pub type Read = fn(&Path) -> io::Result<Vec<u8>>;

/// How long a draft is kept that nobody asks for.
const LIFETIME: Duration = Duration::from_secs(30 * 24 * 60 * 60);

/// Maximum number of texts of earlier pages that are kept beside the newest one.
const MOST_EARLIER: usize = 3;

/// A text that was not saved.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Unsaved {
    pub text: String,
    /// What was in the file that it was made from.
    base: Option<String>,
    /// When it was kept, in seconds since 1970.
    time: u64,
}

impl Unsaved {
    /// A text of now.
    pub fn new(text: &str, base: Option<&str>) -> Self {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            text: text.to_owned(),
            base: base.map(str::to_owned),
            time: now.map_or(0, |now| now.as_secs()),
        }
    }
}

/// All that is kept of a scene, as it stands in the draft's file and goes to the page.
#[derive(Debug, Deserialize, Serialize)]
pub struct Kept {
    #[serde(flatten)]
    newest: Unsaved,
    /// The newest of them first.
    #[serde(default)]
    earlier: Vec<Unsaved>,
}

impl Kept {
    /// Some texts, the newest first; none if there is none.
    pub fn new(texts: impl IntoIterator<Item = Unsaved>) -> Option<Self> {
        let mut texts = texts.into_iter();
        Some(Self {
            newest: texts.next()?,
            earlier: texts.take(MOST_EARLIER).collect(),
        })
    }

    /// The texts, the newest first.
    pub fn texts(self) -> impl Iterator<Item = Unsaved> {
        iter::once(self.newest).chain(self.earlier)
    }
}

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

    /// What is kept.
    pub fn kept(&self, read: Read) -> Option<Kept> {
        let bytes = read(self.0.as_deref()?).ok()?;
        serde_json::from_slice(&bytes).ok()
    }

    /// Keeps this in the place of what is kept.
    ///
    /// # Errors
    ///
    /// Why it is not kept, in words.
    pub fn keep(&self, kept: Option<&Kept>) -> Result<(), String> {
        let Some(kept) = kept else {
            if let Some(path) = &self.0 {
                files::forget(path);
            }
            return Ok(());
        };
        let path = self.0.as_deref();
        let path = path.ok_or("this system has no folder for drafts")?;
        let text = serde_json::to_string(kept).map_err(|error| error.to_string())?;
        let kept = files::keep(path, &text);
        kept.map_err(|error| format!("the draft is not kept: {error}"))
    }
}
