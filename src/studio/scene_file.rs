//! The scene's own file: the only one that Studio reads or writes.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::{Arc, atomic::AtomicBool},
    time::Instant,
};

use crate::{
    film,
    preview::{self, Content, Latest},
    scene::SMALLEST,
};

/// What reads a file, up to the length that scenes have.
pub type Read = fn(&Path) -> io::Result<Vec<u8>>;

/// A scene's file, or a new scene that has none yet.
#[derive(Debug)]
pub struct SceneFile {
    read: Read,
    /// Where a new scene is saved.
    folder: PathBuf,
    path: Option<PathBuf>,
    /// What was there when it was looked at last.
    held: Held,
    /// When a page has saved it last.
    saved: Option<Instant>,
}

/// What there is at a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Held {
    /// A text.
    Text(String),
    /// No file.
    Nothing,
    /// Something that is not to be overwritten: why it cannot be read as a text.
    Unreadable(String),
}

impl Held {
    fn new(bytes: io::Result<Vec<u8>>) -> Self {
        match bytes.map(String::from_utf8) {
            Ok(Ok(text)) => Self::Text(text),
            Ok(Err(_)) => Self::Unreadable(NO_TEXT.to_owned()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Self::Nothing,
            Err(error) => Self::Unreadable(error.to_string()),
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Why there is something and no text, in words.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Unreadable(reason) => Some(reason),
            _ => None,
        }
    }
}

const NO_TEXT: &str = "it is not a text in UTF-8";

/// Why a text was not saved.
#[derive(Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// What is in the file is not what the text was made from.
    Changed(Option<String>),
    /// Why it cannot be done, in words.
    Refused(String),
}

impl SceneFile {
    /// The file at a path.
    ///
    /// # Errors
    ///
    /// It cannot be read, or holds no text.
    pub fn open(path: &Path, read: Read) -> io::Result<Self> {
        let text = String::from_utf8(read(path)?)
            .map_err(|_| io::Error::new(io::ErrorKind::InvalidData, NO_TEXT))?;
        Ok(Self {
            read,
            folder: PathBuf::new(),
            path: Some(path.to_owned()),
            held: Held::Text(text),
            saved: None,
        })
    }

    /// A new scene, the smallest one. It is saved in this folder.
    pub fn new(folder: PathBuf, read: Read) -> Self {
        Self {
            read,
            folder,
            path: None,
            held: Held::Text(SMALLEST.to_owned()),
            saved: None,
        }
    }

    /// Where it is, if it is anywhere.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Watches the file, if there is one and the system can.
    pub fn watch(&self) -> Option<Arc<Latest<Content>>> {
        preview::watch(self.path()?, self.read).ok()
    }

    /// What it is called; for a new scene what it might be called.
    pub fn name(&self) -> String {
        let name = self.path().and_then(Path::file_name);
        name.map_or("scene.scn".into(), |name| name.to_string_lossy())
            .into_owned()
    }

    /// What was there when it was looked at last.
    pub fn held(&self) -> &Held {
        &self.held
    }

    /// Takes in what is there now. Says whether that is new.
    pub fn look(&mut self, content: Content) -> bool {
        let Some(path) = self.path() else {
            return false;
        };
        // What was seen may be older than what a page has saved since.
        let is_old = self.saved.is_some_and(|saved| content.since < saved);
        let held = Held::new(match is_old {
            true => (self.read)(path),
            false => content.bytes,
        });
        let is_new = self.held != held;
        self.held = held;
        is_new
    }

    /// Saves a text, if the file still holds what it was made from, `base`; a new scene under a name that no file has.
    ///
    /// # Errors
    ///
    /// It is not saved, and no file has changed.
    pub fn save(
        &mut self,
        text: &str,
        base: Option<&str>,
        name: Option<&str>,
    ) -> Result<(), NotSaved> {
        let refused = |error: io::Error| NotSaved::Refused(error.to_string());
        match &self.path {
            Some(_) if name.is_some_and(|name| name != self.name()) => {
                let message = format!("this scene is in {}", self.name());
                return Err(NotSaved::Refused(message));
            }
            Some(path) => {
                let found = Held::new((self.read)(path));
                if let Some(reason) = found.reason() {
                    let message = format!("{} cannot be read: {reason}", self.name());
                    return Err(NotSaved::Refused(message));
                }
                if found.text() != Some(text) {
                    if found.text() != base {
                        return Err(NotSaved::Changed(found.text().map(str::to_owned)));
                    }
                    film::write_whole(path, &AtomicBool::new(false), |file| {
                        file.write_all(text.as_bytes())
                    })
                    .map_err(refused)?;
                }
            }
            None => {
                let name = name.unwrap_or_default();
                check_name(name).map_err(|message| NotSaved::Refused(message.to_owned()))?;
                let path = self.folder.join(name);
                create(&path, text).map_err(refused)?;
                self.path = Some(path);
            }
        }
        self.held = Held::Text(text.to_owned());
        self.saved = Some(Instant::now());
        Ok(())
    }
}

/// A name for a new file in a folder, and no path that leads elsewhere, on any system.
fn check_name(name: &str) -> Result<(), &'static str> {
    let is_elsewhere = |letter: char| matches!(letter, '/' | '\\' | ':') || letter.is_control();
    let stem = name.strip_suffix(".scn");
    match stem {
        None | Some("") => Err("the name of a scene's file ends in .scn"),
        Some(_) if name.contains(is_elsewhere) || name.starts_with('.') => {
            Err("the name is that of a file in the current folder, and no path")
        }
        // Windows has devices of these names, whatever follows behind a dot.
        Some(stem) if is_device(stem.split('.').next().unwrap_or_default()) => {
            Err("the name is that of a device")
        }
        Some(_) => Ok(()),
    }
}

fn is_device(name: &str) -> bool {
    let name = name.trim_end().to_ascii_lowercase();
    let is_port = |kind| {
        let number = name.strip_prefix(kind).map(str::as_bytes);
        matches!(number, Some([b'0'..=b'9']))
    };
    ["con", "prn", "aux", "nul"].contains(&&*name) || is_port("com") || is_port("lpt")
}

/// Makes a file, whole or not at all, where there is none.
fn create(path: &Path, text: &str) -> io::Result<()> {
    // It holds the name until the text is there; who had it before keeps it.
    fs::OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(path)?;
    let written = film::write_whole(path, &AtomicBool::new(false), |file| {
        file.write_all(text.as_bytes())
    });
    if written.is_err() {
        let _ = fs::remove_file(path);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_leads_nowhere_else() {
        for right in ["a.scn", "my scene.scn", "ä.b.scn", "cone.scn", "com.scn"] {
            assert_eq!(check_name(right), Ok(()), "{right}");
        }
        let wrong = [
            "",
            ".scn",
            "a",
            "a.png",
            "a.scn/",
            "/a.scn",
            "../a.scn",
            "..\\a.scn",
            "b/a.scn",
            "c:a.scn",
            "a\0.scn",
            "a\n.scn",
            ".a.scn",
            "..scn",
            "CON.scn",
            "nul.x.scn",
            "com1.scn",
        ];
        for wrong in wrong {
            assert!(check_name(wrong).is_err(), "{wrong:?}");
        }
    }
}
