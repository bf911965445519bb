//! Texts of files that cannot be replaced by renaming another one: in a folder that cannot be
//! written to, or that something is mounted on.

use std::{
    fs::{self, OpenOptions},
    io::{self, Write},
    path::{Path, PathBuf},
};

use tempfile::{Builder, NamedTempFile};

use super::{
    kind::{self, Kind, folder, without_waiting},
    original::Original,
    state::state_folder,
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
    // As long as it is locked, nobody takes it for a leftover.
    let _ = copy.as_file().lock();
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
/// in part: beside it, and of files of its name in the user's folder for such things.
pub fn copies_left(path: &Path) -> Vec<PathBuf> {
    let path = match fs::read_link(path) {
        Ok(_) => fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()),
        Err(_) => path.to_owned(),
    };
    let prefix = copy_prefix(&path);
    let copies_in = |listed: &Path, named: &Path| -> Vec<PathBuf> {
        let entries = fs::read_dir(listed).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name());
        let copies = names.filter(|name| name.to_string_lossy().starts_with(&prefix));
        copies.map(|name| named.join(name)).collect()
    };
    let mut left = copies_in(folder(&path), path.parent().unwrap_or(Path::new("")));
    if let Some(state) = state_folder() {
        left.extend(copies_in(&state, &state));
    }
    // One that is locked is in use.
    left.retain(|copy| kind::open(copy).is_ok_and(|file| file.try_lock().is_ok()));
    left.sort();
    left
}

/// What the name of a copy begins with.
fn copy_prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let name: String = name.chars().take(50).collect();
    format!("{name}.copy-")
}

/// An empty file for the copy, if there is a place for one.
fn copy_beside(path: &Path) -> Option<NamedTempFile> {
    let prefix = copy_prefix(path);
    let copy_in = |folder: &Path| Builder::new().prefix(&prefix).tempfile_in(folder).ok();
    copy_in(folder(path)).or_else(|| {
        let folder = state_folder()?;
        fs::create_dir_all(&folder).ok()?;
        copy_in(&folder)
    })
}
