//! Reads, watches and saves the file of a scene. Besides this file, Studio reads and writes only
//! drafts, and new scenes in the same folder.

use std::{
    io,
    path::{Path, PathBuf},
    sync::{Arc, atomic::AtomicBool},
};

use super::draft::{Drafts, Read, Unsaved};
use crate::{
    files::{self, Original, Purpose},
    preview::{self, FileContent, Latest},
    source::Source,
};

/// Content found at a path: a text, or `None` if there is no file. The error says why a file cannot
/// be read as text; such a file must not be overwritten.
pub type FileText = Result<Option<String>, String>;

/// The file of a scene, or a new scene that has no file yet.
#[derive(Debug)]
pub struct SceneFile {
    read: Read,
    /// Folder in which a new scene is saved.
    folder: PathBuf,
    path: Option<PathBuf>,
    /// Content of the file when it was last read or saved.
    content: FileText,
    /// Version number of `content`, which increases by one with each change.
    version: u64,
    /// Slot in which the watcher puts the file's content after each change. It is `None` if the
    /// file cannot be watched; a change by another program is then noticed only when the scene is
    /// saved.
    watch: Option<Arc<Latest<FileContent>>>,
    drafts: Drafts,
    /// Paths of the new scenes that pages have saved in the same folder under another name. A later
    /// save may overwrite these files, because Studio has created them.
    beside: Vec<PathBuf>,
}

/// Reason why a text was not saved.
#[derive(Debug, PartialEq, Eq)]
pub enum NotSaved {
    /// The file has changed since the page read it. Contains the file's current content.
    Changed(Option<String>),
    /// The text cannot be saved. Contains the reason in words.
    Refused(String),
}

/// Returns the error that the file `name` could not be written, with advice for the user.
fn refused(name: &str, path: &Path, error: &io::Error) -> NotSaved {
    let is_gone = !files::folder(path).exists();
    let advice = match error.kind() {
        io::ErrorKind::NotFound if is_gone => {
            return NotSaved::Refused(format!(
                "{name} is not saved: its folder is gone; make it again, or download the scene"
            ));
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "allow it to be changed, or download the scene"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "make room, or download the scene"
        }
        io::ErrorKind::AlreadyExists => {
            "choose another name, or start Studio with that file to change it"
        }
        _ => "try again, or download the scene",
    };
    NotSaved::Refused(format!("{name} is not saved: {error}; {advice}"))
}

impl SceneFile {
    /// Opens the file at `path`.
    ///
    /// # Errors
    ///
    /// Returns a message if the file cannot be read or is not a text.
    pub fn open(path: &Path, read: Read) -> Result<Self, String> {
        let text = text(read(path)).map_err(|error| error.to_string())?;
        Ok(Self {
            read,
            folder: path.parent().unwrap_or(Path::new("")).to_owned(),
            beside: Vec::new(),
            path: Some(path.to_owned()),
            content: Ok(Some(text)),
            version: 1,
            watch: preview::watch(path, read).ok(),
            drafts: Drafts::of(path),
        })
    }

    /// Makes a new scene. It has no file yet; its file will be in `folder`.
    pub fn new(folder: PathBuf, read: Read) -> Self {
        Self {
            read,
            drafts: Drafts::of(&folder),
            folder,
            beside: Vec::new(),
            path: None,
            content: Ok(None),
            version: 1,
            watch: None,
        }
    }

    /// Returns the path of the file; `None` for a new scene.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Returns the file's name, or a suggestion for the name of a new scene.
    pub fn name(&self) -> String {
        let name = self.path().and_then(Path::file_name);
        name.map_or("scene.scn".into(), |name| name.to_string_lossy())
            .into_owned()
    }

    /// Returns the file's content at the time when the file was last read or saved.
    pub fn content(&self) -> &FileText {
        &self.content
    }

    /// Returns the drafts whose text differs from the file's content, the newest first.
    pub fn drafts(&self) -> Vec<Unsaved> {
        let content = self.content.as_ref().ok().and_then(Option::as_deref);
        let mut drafts = self.drafts.kept(self.read);
        drafts.retain(|it| Some(&*it.text) != content);
        drafts
    }

    /// Replaces the draft that a page has stored under the key `id`. If `unsaved` is `None`,
    /// removes it.
    ///
    /// # Errors
    ///
    /// Returns a message if the draft cannot be stored.
    pub fn keep_draft(&self, id: &str, unsaved: Option<Unsaved>) -> Result<(), String> {
        let mut drafts = self.drafts.kept(self.read);
        drafts.retain(|it| it.id != id);
        drafts.splice(0..0, unsaved);
        self.drafts.keep(&drafts)
    }

    /// Reads the file again if the watcher reports a change, and returns the version number. The
    /// content from the watcher itself is not used: a page may have saved a newer text after the
    /// watcher read the file.
    pub fn refresh(&mut self) -> u64 {
        if let (Some(path), Some(watch)) = (&self.path, &self.watch)
            && watch.try_take().is_some()
        {
            let found = self.found(path);
            self.set_content(found);
        }
        self.version
    }

    fn set_content(&mut self, content: FileText) {
        self.version += u64::from(self.content != content);
        self.content = content;
    }

    fn found(&self, path: &Path) -> FileText {
        match text((self.read)(path)) {
            Ok(text) => Ok(Some(text)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        }
    }

    /// Saves the text `new` if the file still contains `base`, the content that the page began to
    /// edit. If `name` is not the name of the file, saves the text as a new scene with this name in
    /// the same folder. This fails if a file with this name exists, unless a page has created it by
    /// an earlier save. Removes drafts with the text `new`. Returns the version number of the
    /// content.
    ///
    /// # Errors
    ///
    /// Returns the reason if the text is not saved. In this case, no file is changed.
    pub fn save(
        &mut self,
        new: &str,
        base: Option<&str>,
        name: Option<&str>,
    ) -> Result<u64, NotSaved> {
        let mut drafts = self.drafts.kept(self.read);
        let own = self.name();
        let other = name.filter(|name| *name != own && self.path.is_some());
        let other = other.map(|name| (name, self.folder.join(name)));
        let is_other = other.is_some();
        let is_new = |path: &PathBuf| !self.beside.contains(path);
        match (&self.path, other) {
            (Some(_), Some((name, path))) if is_new(&path) => {
                create(name, &path, new)?;
                self.beside.push(path);
            }
            (Some(own_path), other) => {
                let (own, path) = other.map_or((own, own_path.clone()), |(name, path)| {
                    (name.to_owned(), path)
                });
                let path = path.as_path();
                let unread = |why| {
                    NotSaved::Refused(format!(
                        "{own} is not saved, as it cannot be read: {why}; save under another name"
                    ))
                };
                let original = match Original::read(path, self.read) {
                    Ok(original) => original,
                    Err(error) if error.kind() == io::ErrorKind::NotFound => Original::missing(),
                    Err(error) => return Err(unread(error.to_string())),
                };
                let found = original.bytes().map(|bytes| text(Ok(bytes.to_owned())));
                let found = found
                    .transpose()
                    .map_err(|error| unread(error.to_string()))?;
                if found.as_deref() != Some(new) {
                    if found.as_deref() != base {
                        return Err(NotSaved::Changed(found));
                    }
                    match write(path, new, Purpose::Change(&original)) {
                        Err(error) if files::is_changed(&error) => {
                            let found = self.found(path).map_err(unread)?;
                            return Err(NotSaved::Changed(found));
                        }
                        written => written.map_err(|error| refused(&own, path, &error))?,
                    }
                }
            }
            (None, _) => {
                let name = name.unwrap_or_default();
                let path = self.folder.join(name);
                create(name, &path, new)?;
                self.watch = preview::watch(&path, self.read).ok();
                let _ = self.drafts.keep(&[]);
                self.drafts = Drafts::of(&path);
                self.path = Some(path);
                self.version += 1;
            }
        }
        // Only the drafts with the saved text are removed.
        drafts.retain(|it| it.text != new);
        let _ = self.drafts.keep(&drafts);
        if !is_other {
            self.set_content(Ok(Some(new.to_owned())));
        }
        Ok(self.version)
    }
}

/// Creates the file of a new scene. Fails if the file exists or its name is not allowed.
fn create(name: &str, path: &Path, text: &str) -> Result<(), NotSaved> {
    check_name(name).map_err(|why| NotSaved::Refused(why.to_owned()))?;
    write(path, text, Purpose::New).map_err(|error| refused(name, path, &error))
}

fn text(bytes: io::Result<Vec<u8>>) -> io::Result<String> {
    let bytes = bytes?;
    let no_text = |why| io::Error::new(io::ErrorKind::InvalidData, why);
    // In UTF-16, about half of the bytes of a scene are zero. So the encoding needs to be checked
    // only if the text contains a zero byte.
    if bytes.contains(&0) && Source::from_bytes("", bytes.clone()).is_utf16() {
        return Err(no_text("it is UTF-16, not UTF-8: save it as UTF-8"));
    }
    String::from_utf8(bytes).map_err(|_| no_text("it is not a text in UTF-8"))
}

/// Rejects names that could lead out of the folder on any operating system, or do not end in
/// `.scn`.
fn check_name(name: &str) -> Result<(), &'static str> {
    let is_odd = |letter: char| ":*?\"<>|".contains(letter) || letter.is_control();
    let stem = name.strip_suffix(".scn");
    match stem {
        None | Some("") => Err("the name of a scene's file ends in .scn"),
        Some(_) if name.contains(['/', '\\']) || name.starts_with('.') => {
            Err("the name is that of a file in the current folder, and no path")
        }
        // Windows does not allow these characters in names. A colon can even lead to another drive.
        Some(_) if name.contains(is_odd) => {
            Err("the name of a file has none of `: * ? \" < > |`, and no control character")
        }
        // On Windows, these names are devices, even if a dot and more text follow them.
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

fn write(path: &Path, text: &str, purpose: Purpose) -> io::Result<()> {
    files::write(path, purpose, &AtomicBool::new(false), |file| {
        file.write_all(text.as_bytes())
    })
}

#[cfg(test)]
#[allow(
    clippy::disallowed_methods,
    reason = "the tests are another program here"
)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_is_saved_between_reading_and_writing_is_kept() {
        /// Reads a file. If it contains `mine`, overwrites it right after reading, like another
        /// program that saves at this moment.
        fn read_and_saved(path: &Path) -> io::Result<Vec<u8>> {
            let bytes = files::read(path, 99)?;
            if bytes == b"mine" {
                fs::write(path, "theirs")?;
            }
            Ok(bytes)
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.scn");
        fs::write(&path, "old").unwrap();
        let mut file = SceneFile::open(&path, read_and_saved).unwrap();
        file.watch = None;
        file.save("mine", Some("old"), None).unwrap();
        let saved = file.save("more", Some("mine"), None);
        assert_eq!(saved, Err(NotSaved::Changed(Some("theirs".to_owned()))));
        assert_eq!(fs::read(&path).unwrap(), b"theirs");
    }

    #[test]
    fn a_scene_beside_the_file_is_new_and_saved_again_but_takes_the_place_of_none() {
        let read: Read = |path| files::read(path, 99);
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("a.scn"), "own").unwrap();
        fs::write(at("there.scn"), "theirs").unwrap();
        let mut file = SceneFile::open(&at("a.scn"), read).unwrap();
        let version = file.refresh();
        for name in ["there.scn", "../b.scn", "b", "c/b.scn"] {
            for base in [None, Some("theirs")] {
                let saved = file.save("new", base, Some(name));
                assert!(matches!(saved, Err(NotSaved::Refused(_))), "{name}");
            }
        }
        let mut save = |text, base| file.save(text, base, Some("new.scn"));
        assert_eq!(save("one", None), Ok(version));
        let found = || Err(NotSaved::Changed(Some("one".to_owned())));
        assert_eq!(save("two", None), found());
        assert_eq!(save("two", Some("own")), found());
        assert_eq!(save("two", Some("one")), Ok(version));
        let texts = ["a.scn", "there.scn", "new.scn"].map(|name| fs::read(at(name)).unwrap());
        assert_eq!(texts, [&b"own"[..], b"theirs", b"two"]);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
        assert_eq!(file.content(), &Ok(Some("own".to_owned())));
    }

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
            "a?.scn",
            "a<b>|.scn",
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
