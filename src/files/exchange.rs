//! A file is replaced in such a way that what was there can still be looked at, and brought back.

use std::{
    fs::{self, File},
    io,
    path::Path,
};

use tempfile::NamedTempFile;

use super::{
    kind,
    original::{Original, changed, id},
};

/// Has a temporary file take the place of what was read.
///
/// Another program may save the file right then, after it was looked at for the last time. So the
/// two exchange their names, and what was there is looked at again: if it is not what was read,
/// they exchange them back. Where the system cannot do that, the file is replaced without another
/// look.
pub fn replace(temporary: NamedTempFile, path: &Path, original: &Original) -> io::Result<()> {
    // It will have the name of a temporary file, and nobody may take it for one that was left.
    let found = kind::open(path).ok();
    let _is_locked = found.as_ref().map(File::try_lock);
    original.check(path)?;
    match exchange(temporary.path(), path) {
        Ok(()) if original.check(temporary.path()).is_ok() => Ok(()),
        Ok(()) => {
            bring_back(&temporary, path)?;
            Err(changed())
        }
        Err(error) if is_not_known(&error) => match temporary.persist(path) {
            Ok(_) => Ok(()),
            Err(error) => Err(error.error),
        },
        Err(error) => Err(error),
    }
}

/// Gives what has a temporary file's name now its own one back. But what was saved at that place
/// in the meantime is newer, and keeps it.
fn bring_back(temporary: &NamedTempFile, path: &Path) -> io::Result<()> {
    let mut at_path = id(&temporary.as_file().metadata()?);
    loop {
        let brought_back = id(&fs::symlink_metadata(temporary.path())?);
        exchange(temporary.path(), path)?;
        if id(&fs::symlink_metadata(temporary.path())?) == at_path {
            return Ok(());
        }
        at_path = brought_back;
    }
}

/// Exchanges the names of two files at once.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Whether the system, or the file system, cannot exchange names.
fn is_not_known(error: &io::Error) -> bool {
    use io::ErrorKind as Kind;
    matches!(error.kind(), Kind::Unsupported | Kind::InvalidInput)
}

#[cfg(test)]
mod tests {
    use std::{hint, thread};

    use tempfile::tempdir;

    use super::*;

    /// The last round of saving beside another program.
    const LAST: u32 = 400;

    /// Another program saves the file at all times from before it is replaced to after that.
    #[test]
    fn what_is_saved_meanwhile_stays() {
        let folder = tempdir().unwrap();
        let path = folder.path().join("a.scn");
        let (mut replaced, mut left) = (0, 0);
        for round in 0..=LAST {
            fs::write(&path, "old").unwrap();
            let original = Original::read(&path, |path| fs::read(path)).unwrap();
            let temporary = NamedTempFile::new_in(folder.path()).unwrap();
            fs::write(temporary.path(), "new").unwrap();
            let theirs = folder.path().join("theirs");
            fs::write(&theirs, "theirs").unwrap();
            let save = || fs::rename(&theirs, &path).unwrap();
            // Before all of it in the first round, and after all of it in the last: on a full
            // machine the thread may never be in time.
            let done = match round {
                0 => {
                    save();
                    replace(temporary, &path, &original)
                }
                LAST => {
                    let done = replace(temporary, &path, &original);
                    save();
                    done
                }
                _ => thread::scope(|scope| {
                    scope.spawn(|| {
                        for _ in 0..round * 25 {
                            hint::spin_loop();
                        }
                        save();
                    });
                    replace(temporary, &path, &original)
                }),
            };
            match done {
                Ok(()) => replaced += 1,
                Err(_) => left += 1,
            }
            assert_eq!(fs::read_to_string(&path).unwrap(), "theirs", "{round}");
            assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "{round}");
        }
        assert!(replaced > 0 && left > 0, "{replaced} {left}");
    }

    #[test]
    fn what_is_saved_while_something_is_brought_back_is_newer() {
        let folder = tempdir().unwrap();
        let path = folder.path().join("a.scn");
        let temporary = NamedTempFile::new_in(folder.path()).unwrap();
        // What was at the path has the temporary name, and what is there now is not ours.
        fs::remove_file(temporary.path()).unwrap();
        fs::write(temporary.path(), "older").unwrap();
        fs::write(&path, "newer").unwrap();
        bring_back(&temporary, &path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "newer");
    }
}
