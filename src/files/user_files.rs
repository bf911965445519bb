//! Small private files of the user, in Pinhole's state folder. Other users cannot read them.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Duration,
};

use super::{
    error_words::in_words,
    kind::folder,
    state::{self, digest, state_folder},
    write::{Purpose, write},
};

/// Returns the path of the folder `name` in Pinhole's state folder, or `None` if the system has no
/// state folder.
pub fn kept_folder(name: &str) -> Option<PathBuf> {
    Some(state_folder()?.join(name))
}

/// Writes a text to a private file, which no other user can read. Creates its folder if it is
/// missing. The folder should come from [`kept_folder`].
pub fn keep(path: &Path, text: &str) -> io::Result<()> {
    let folder = folder(path);
    state::make(folder).map_err(in_words)?;
    let purpose = Purpose::Private(folder);
    write(path, purpose, &AtomicBool::new(false), |file| {
        file.write_all(text.as_bytes())
    })
}

/// Removes a file that [`keep`] wrote, if it exists. Errors are ignored.
pub fn forget(path: &Path) {
    let _ = fs::remove_file(path);
}

/// Removes the files in a folder that were last changed longer than `age` ago. Errors are ignored.
pub fn forget_older(folder: &Path, age: Duration) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let changed = entry.metadata().and_then(|found| found.modified());
        if changed.is_ok_and(|at| at.elapsed().is_ok_and(|elapsed| elapsed > age)) {
            forget(&entry.path());
        }
    }
}

/// Returns a short file name for a key of any length, made from a hash of the key.
pub fn name_of(long: &[u8]) -> String {
    digest(long) + ".json"
}
