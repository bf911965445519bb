//! Texts of files that cannot be replaced by renaming another one: in a folder that cannot be
//! written to, or that something is mounted on.

use std::{
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use tempfile::{Builder, NamedTempFile};

use super::{
    kind::{Kind, folder, without_waiting},
    original::Original,
    state::{self, digest, state_folder},
    temporary::{self, locked},
    words::in_words,
};

/// Whether a file that cannot be replaced for this reason may be written in place.
pub fn is_reason(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    matches!(
        error.kind(),
        Kind::PermissionDenied
            | Kind::ReadOnlyFilesystem
            | Kind::ResourceBusy
            | Kind::CrossesDevices
    )
}

/// Writes over a file that is still what was read. A copy of all that is to be in it stands beside
/// it, or else in the user's folder for such things, until that is done: whatever happens
/// meanwhile, one of the two is whole. Where no copy can be made, `reason` stays what kept the file
/// from being replaced.
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
    if Kind::of(&found) != Kind::File {
        return Err(Kind::of(&found).refused());
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

/// The copies of a file that were left by processes that were killed while they wrote it, whole or
/// in part: beside it, and in the user's folder for such things.
pub fn copies_left(path: &Path) -> Vec<PathBuf> {
    // A file beside one that no link leads to is named as that is.
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

/// What the name of a copy beside its file begins with.
fn copy_prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().take(50).collect();
    format!("{name}.copy-")
}

/// What it begins with where files of all folders have theirs, for a canonical path.
fn prefix_in_state(path: &Path) -> String {
    let digest = digest(path.as_os_str().as_encoded_bytes());
    format!("{digest}-{}", copy_prefix(path))
}

/// An empty file for the copy of what is at a canonical path, if there is a place for one.
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
