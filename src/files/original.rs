//! A copy of a file as it was read. Before the file is replaced, it is compared with the copy,
//! since another program may have saved it meanwhile.

use std::{
    fmt,
    fs::{self, Metadata},
    io,
    path::Path,
};

use super::{error_words::in_words, kind::read};

/// Identity of a file: the number of its device, and its inode number on the device. Another file
/// at the same path has another identity.
pub type FileId = (u64, u64);

/// Returns the identity of the file that the metadata describe.
#[cfg(unix)]
pub fn id(found: &Metadata) -> FileId {
    use std::os::unix::fs::MetadataExt as _;
    (found.dev(), found.ino())
}

/// Returns (0, 0), since the standard library provides no inode numbers on this system. Files are
/// then distinguished only by their contents.
#[cfg(not(unix))]
pub fn id(_: &Metadata) -> FileId {
    (0, 0)
}

/// A copy of a file as it was read: its identity and its bytes. It is empty if there was no file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Original(Option<(FileId, Vec<u8>)>);

impl Original {
    /// Reads the file at `path` by the function `read`, and records the file's identity.
    pub fn read(path: &Path, read: impl FnOnce(&Path) -> io::Result<Vec<u8>>) -> io::Result<Self> {
        // Another program may replace the file after its identity is recorded and before its
        // content is read. The recorded identity is then that of the old file. The new file will
        // therefore be taken for changed and not be replaced, so nothing is lost.
        let found = fs::metadata(path).map_err(in_words)?;
        Ok(Self(Some((id(&found), read(path)?))))
    }

    /// Returns the empty copy, for a file that does not exist.
    pub fn missing() -> Self {
        Self(None)
    }

    /// Returns the bytes that were read, or `None` if there was no file.
    pub fn bytes(&self) -> Option<&[u8]> {
        self.0.as_ref().map(|(_, bytes)| bytes.as_slice())
    }

    /// Fails if the file at `path` has changed since it was read. Does nothing if no file existed
    /// when it was read.
    pub(super) fn check(&self, path: &Path) -> io::Result<()> {
        let Some((original, bytes)) = &self.0 else {
            // No file existed, so there is nothing to compare. If another program has created a
            // file since then, the function that writes the new file fails.
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

/// Error: a file was not replaced, because another program has changed it since it was read.
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

/// Returns whether an error says that a file was not replaced because another program has changed
/// it.
pub fn is_changed(error: &io::Error) -> bool {
    error.get_ref().is_some_and(|cause| cause.is::<Changed>())
}
