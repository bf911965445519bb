//! Temporary files. Each lies beside the final file until its content is complete. A process locks
//! its temporary files, so an unlocked one was left by a process that was killed.

use std::{
    ffi::OsString,
    fs::{self, File, TryLockError},
    io,
    path::Path,
};

use tempfile::NamedTempFile;

use super::kind;

/// Maximum number of attempts to create and lock a temporary file. An attempt fails if another
/// process, which looks for leftover files, locks the new file for a moment. A hundred such
/// failures in a row are very unlikely. Without a limit, the loop would never end if a program
/// removed every new file.
const MOST_TRIES: usize = 100;

/// Calls `make`, which creates a file, until the file can be locked, at most [`MOST_TRIES`] times.
/// Does not wait for locks of other processes.
pub fn locked(mut make: impl FnMut() -> io::Result<NamedTempFile>) -> io::Result<NamedTempFile> {
    for _ in 0..MOST_TRIES {
        let file = make()?;
        // If the file system does not support locks, no other process can lock the file. The file
        // is therefore used without a lock.
        let is_locked = !matches!(file.as_file().try_lock(), Err(TryLockError::WouldBlock));
        // Before the file was locked, another process may have removed it as a leftover, so the
        // function checks that it still exists.
        if is_locked && file.path().exists() {
            return Ok(file);
        }
    }
    let message = "another program locks or removes every file that is begun in its folder";
    Err(io::Error::other(message))
}

/// Returns the unlocked files in a folder, with their names. Processes lock their temporary files,
/// so the unlocked ones were left by processes that were killed. A name must consist of `prefix`,
/// six random characters and `suffix`; other files are ignored. The returned files are locked until
/// they are closed.
pub fn left(folder: &Path, prefix: &str, suffix: &str) -> Vec<(OsString, File)> {
    let is_ours = |name: &OsString| {
        let name = name.to_str();
        name.and_then(|name| name.strip_prefix(prefix)?.strip_suffix(suffix))
            .is_some_and(|random| {
                random.len() == 6 && random.bytes().all(|it| it.is_ascii_alphanumeric())
            })
    };
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let left = entries.filter_map(|entry| {
        let name = Some(entry.file_name()).filter(is_ours)?;
        entry.file_type().ok().filter(fs::FileType::is_file)?;
        let file = kind::open(&entry.path()).ok()?;
        file.try_lock().ok()?;
        Some((name, file))
    });
    left.collect()
}

#[cfg(test)]
mod tests {
    use tempfile::tempdir;

    use super::*;

    #[test]
    fn a_file_that_others_lock_first_is_not_waited_for() {
        let folder = tempdir().unwrap();
        for (locked_first, is_made) in [(0, true), (3, true), (usize::MAX, false)] {
            let mut others = Vec::new();
            let made = locked(|| {
                let file = NamedTempFile::new_in(folder.path())?;
                if others.len() < locked_first {
                    let other = file.reopen()?;
                    other.lock()?;
                    others.push(other);
                }
                Ok(file)
            });
            assert_eq!(made.is_ok(), is_made, "{locked_first}");
            assert_eq!(others.len(), locked_first.min(MOST_TRIES));
            drop(made);
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }
}
