//! A file as it was when it was read, to be known again before it is replaced: another program may
//! have saved it meanwhile.

use std::{
    fmt,
    fs::{self, Metadata},
    io,
    path::Path,
};

use super::{kind::read, words::in_words};

/// What tells a file from another one that takes its place: its device, and its number there.
pub type FileId = (u64, u64);

/// The identity of a file that was found.
#[cfg(unix)]
pub fn id(found: &Metadata) -> FileId {
    use std::os::unix::fs::MetadataExt as _;
    (found.dev(), found.ino())
}

/// Elsewhere the library tells no number.
#[cfg(not(unix))]
pub fn id(_: &Metadata) -> FileId {
    (0, 0)
}

/// A file as it was when it was read: which one it was, and its bytes; or none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Original(Option<(FileId, Vec<u8>)>);

impl Original {
    /// Has `read` read the file at a path.
    pub fn read(path: &Path, read: impl FnOnce(&Path) -> io::Result<Vec<u8>>) -> io::Result<Self> {
        // One that takes its place in between has another number, and so counts as changed.
        let found = fs::metadata(path).map_err(in_words)?;
        Ok(Self(Some((id(&found), read(path)?))))
    }

    /// No file.
    pub fn missing() -> Self {
        Self(None)
    }

    /// Its bytes, if there was one.
    pub fn bytes(&self) -> Option<&[u8]> {
        self.0.as_ref().map(|(_, bytes)| bytes.as_slice())
    }

    /// Fails unless what is at the path now is what was read.
    pub(super) fn check(&self, path: &Path) -> io::Result<()> {
        let Some((original, bytes)) = &self.0 else {
            // The system makes sure of it when the file is made.
            return Ok(());
        };
        let is_same = || {
            let found = fs::metadata(path).ok()?;
            let now = read(path, bytes.len() as u64).ok()?;
            Some(id(&found) == *original && now == *bytes)
        };
        match is_same() {
            Some(true) => Ok(()),
            _ => Err(changed()),
        }
    }
}

/// Why a file is not replaced: it is no longer what was read.
#[derive(Debug)]
struct Changed;

impl fmt::Display for Changed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("another program has changed it since it was read, so it is left as it is")
    }
}

impl std::error::Error for Changed {}

pub(super) fn changed() -> io::Error {
    io::Error::other(Changed)
}

/// Whether a file was not replaced because another program has changed it.
pub fn is_changed(error: &io::Error) -> bool {
    error.get_ref().is_some_and(|cause| cause.is::<Changed>())
}
