//! Small files that are kept of a user, for the user alone.

use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
    time::Duration,
};

use super::{
    kind::folder,
    state::{self, digest, state_folder},
    words::in_words,
    write::{Purpose, write},
};

/// Where the folder of this name is for what is kept, if the system has a place for it.
pub fn kept_folder(name: &str) -> Option<PathBuf> {
    Some(state_folder()?.join(name))
}

/// Keeps a text in a file of such a folder. No other user can read it.
pub fn keep(path: &Path, text: &str) -> io::Result<()> {
    let folder = folder(path);
    state::make(folder).map_err(in_words)?;
    let purpose = Purpose::Private(folder);
    write(path, purpose, &AtomicBool::new(false), |file| {
        file.write_all(text.as_bytes())
    })
}

/// Removes a file that is kept. It is no matter if there is none.
pub fn forget(path: &Path) {
    let _ = fs::remove_file(path);
}

/// Removes the files in a folder that are older than this.
pub fn forget_older(folder: &Path, age: Duration) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let changed = entry.metadata().and_then(|found| found.modified());
        if changed.is_ok_and(|at| at.elapsed().is_ok_and(|elapsed| elapsed > age)) {
            forget(&entry.path());
        }
    }
}

/// The name of the file that belongs to something that has a longer name.
pub fn name_of(long: &[u8]) -> String {
    digest(long) + ".json"
}
