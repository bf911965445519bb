//! Overwrites files that cannot be replaced by a new file, because their folder is read-only or
//! because something is mounted at their path.

use std::{
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use tempfile::{Builder, NamedTempFile};

use super::{
    error_words::in_words,
    kind::{FileKind, folder, without_waiting},
    original::Original,
    state::{self, digest, state_folder},
    temporary::{self, locked},
};

/// Returns whether a file should be overwritten in place because replacing it failed with `error`.
pub fn is_reason(error: &io::Error) -> bool {
    use io::ErrorKind;
    matches!(
        error.kind(),
        ErrorKind::PermissionDenied
            | ErrorKind::ReadOnlyFilesystem
            | ErrorKind::ResourceBusy
            | ErrorKind::CrossesDevices
    )
}

/// Overwrites the file at `path`, unless it has changed since it was read as `original`. During the
/// overwriting, a copy of the new content exists beside the file or in the user's state folder, so
/// that nothing is lost if this process is killed. If no copy can be created, fails with `reason`,
/// the error with which replacing the file failed.
pub fn write_in_place(
    path: &Path,
    original: &Original,
    content: &[u8],
    reason: io::Error,
) -> io::Result<()> {
    let Some(mut copy) = copy_beside(path) else {
        return Err(reason);
    };
    copy.write_all(content)?;
    copy.as_file().sync_all()?;
    let mut file = without_waiting(OpenOptions::new().write(true)).open(path)?;
    let found = file.metadata()?;
    if FileKind::of(&found) != FileKind::File {
        return Err(FileKind::of(&found).refused());
    }
    original.check(path)?;
    let written = file
        .write_all(content)
        .and_then(|()| file.set_len(content.len() as u64))
        .and_then(|()| file.sync_all());
    match written {
        Ok(()) => copy.close(),
        Err(error) => {
            let (_, copy) = copy.keep().map_err(|error| error.error)?;
            let copy = copy.display();
            let error = in_words(error);
            let message = format!("{error}; what should be in it is whole in {copy}");
            Err(io::Error::new(error.kind(), message))
        }
    }
}

/// Returns the copies that processes left when they were killed while they overwrote a file. A copy
/// may be incomplete. Searches beside the file and in the user's state folder.
pub fn copies_left(path: &Path) -> Vec<PathBuf> {
    // If the path is a symbolic link, copies lie beside the link's target and are named after the
    // target.
    let beside = match fs::read_link(path) {
        Ok(_) => fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()),
        Err(_) => path.to_owned(),
    };
    let names = |folder: &Path, prefix: &str| {
        let left = temporary::left(folder, prefix, "").into_iter();
        left.map(|(name, _)| name).collect::<Vec<_>>()
    };
    let copies = names(folder(&beside), &copy_prefix(&beside)).into_iter();
    let mut left: Vec<_> = copies.map(|name| beside.with_file_name(name)).collect();
    if let (Some(state), Ok(path)) = (state_folder(), fs::canonicalize(path)) {
        let copies = names(&state, &prefix_in_state(&path)).into_iter();
        left.extend(copies.map(|name| state.join(name)));
    }
    left.sort();
    left
}

/// Returns the prefix of the name of a copy beside its file.
fn copy_prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().take(50).collect();
    format!("{name}.copy-")
}

/// Returns the prefix of the name of a copy in the user's state folder. The folder contains copies
/// for files from all folders, so the prefix contains a hash of the file's path. This path, `path`,
/// must be canonical.
fn prefix_in_state(path: &Path) -> String {
    let digest = digest(path.as_os_str().as_encoded_bytes());
    format!("{digest}-{}", copy_prefix(path))
}

/// Creates an empty temporary file, into which the new content of the file at `path` can be
/// written. The temporary file lies beside `path` or, if that fails, in the user's state folder.
/// `path` must be canonical. Returns `None` if no file can be created in either folder.
fn copy_beside(path: &Path) -> Option<NamedTempFile> {
    let copy_in = |folder: &Path, prefix: &str| {
        let mut builder = Builder::new();
        builder.prefix(prefix);
        locked(|| builder.tempfile_in(folder)).ok()
    };
    copy_in(folder(path), &copy_prefix(path)).or_else(|| {
        let folder = state_folder()?;
        state::make(&folder).ok()?;
        copy_in(&folder, &prefix_in_state(path))
    })
}
