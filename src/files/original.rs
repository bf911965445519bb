//! A file as it was read. Before the file is replaced, it is compared with this copy, since another
//! program may have saved it meanwhile.

use std::{
    fmt,
    fs::{self, Metadata},
    io,
    path::Path,
};

use super::{error_words::in_words, kind::read};

/// Identity of a file: the number of its device and its inode number there. If another file
/// replaces the file, the identity at the path changes.
pub type FileId = (u64, u64);

/// Returns the identity of the file that the metadata describe.
#[cfg(unix)]
pub fn id(found: &Metadata) -> FileId {
    use std::os::unix::fs::MetadataExt as _;
    (found.dev(), found.ino())
}

/// Returns (0, 0), since the standard library has no file numbers on this system.
#[cfg(not(unix))]
pub fn id(_: &Metadata) -> FileId {
    (0, 0)
}

/// A file as it was read, with its identity and its bytes; or the fact that there was no file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Original(Option<(FileId, Vec<u8>)>);

impl Original {
    /// Reads the file at `path` with the function `read`, and remembers its identity.
    pub fn read(path: &Path, read: impl FnOnce(&Path) -> io::Result<Vec<u8>>) -> io::Result<Self> {
        // Another file may replace this one between the two calls. The identity that is stored here
        // then differs from that of the new file, which counts as changed.
        let found = fs::metadata(path).map_err(in_words)?;
        Ok(Self(Some((id(&found), read(path)?))))
    }

    /// Makes the original of a file that does not exist.
    pub fn missing() -> Self {
        Self(None)
    }

    /// Returns the bytes that were read; `None` if there was no file.
    pub fn bytes(&self) -> Option<&[u8]> {
        self.0.as_ref().map(|(_, bytes)| bytes.as_slice())
    }

    /// Fails if the file at `path` is not the file that was read. Does nothing if no file was read.
    pub(super) fn check(&self, path: &Path) -> io::Result<()> {
        let Some((original, bytes)) = &self.0 else {
            // No file was read. If one exists by the time of writing, creating the new file fails.
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

/// Error: a file was not replaced, because it is no longer the file that was read.
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

/// Returns whether an error says that another program has changed the file, so that it was not
/// replaced.
pub fn is_changed(error: &io::Error) -> bool {
    error.get_ref().is_some_and(|cause| cause.is::<Changed>())
}
