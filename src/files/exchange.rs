//! Replaces a file without losing what another program saves at the same moment.

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

/// Replaces the file at `path` by the temporary file. Fails if the file at `path` has changed since
/// its content was recorded in `original`.
///
/// Another program may save the file between the check and the replacement. Therefore, the two
/// files exchange their names, and the replaced file is checked once more. If it differs from
/// `original`, the names are exchanged back, and the function fails. On systems that cannot
/// exchange names, the file is replaced without this second check.
pub fn replace(temporary: NamedTempFile, path: &Path, original: &Original) -> io::Result<()> {
    // After the exchange, the old file has the temporary name. Other processes of this program
    // remove files with such names unless they are locked, so the old file is locked.
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

/// Undoes an exchange: the file that has the temporary name returns to `path`. If another program
/// has meanwhile saved a newer file at `path`, the newer file stays there.
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

/// Exchanges the names of two files in one step, so that no other program sees an intermediate
/// state.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// Returns whether the error says that the system or the file system cannot exchange names.
fn is_not_known(error: &io::Error) -> bool {
    use io::ErrorKind;
    matches!(
        error.kind(),
        ErrorKind::Unsupported | ErrorKind::InvalidInput
    )
}

#[cfg(test)]
mod tests {
    use std::{hint, thread};

    use tempfile::tempdir;

    use super::*;

    /// Number of the test's last round, counted from 0. In each round, the other program saves the
    /// file a little later after the start of [`replace`] than in the round before. With 400
    /// rounds, the program saves before, during and after the call. With far fewer rounds, it would
    /// never save after the call.
    const LAST: u32 = 400;

    /// Another program saves a file while [`replace`] replaces the file. In each round, the program
    /// saves a little later than in the round before. Its text must never be lost.
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
            // On a busy machine, the other program's thread may always run too late, or always too
            // early. Therefore, the first round saves the file before the call of `replace`, and
            // the last after it.
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
        // The older file now has the temporary name, and another program has saved a newer one at
        // the path.
        fs::remove_file(temporary.path()).unwrap();
        fs::write(temporary.path(), "older").unwrap();
        fs::write(&path, "newer").unwrap();
        bring_back(&temporary, &path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "newer");
    }
}
