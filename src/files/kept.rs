//! Small files that programs keep of a user, for the user alone, in a folder that the system has
//! for them.

use std::{env, path::PathBuf};
#[cfg(feature = "studio")]
use std::{fs, io, path::Path, sync::atomic::AtomicBool, time::Duration};

#[cfg(feature = "studio")]
use super::write::{Purpose, write};

/// The folder for what programs keep of a user, where the system has one.
pub(super) fn state_folder() -> Option<PathBuf> {
    let absolute = |name| {
        env::var_os(name)
            .map(PathBuf::from)
            .filter(|p| p.is_absolute())
    };
    let base = match cfg!(windows) {
        true => absolute("LOCALAPPDATA")?,
        false => {
            absolute("XDG_STATE_HOME").or_else(|| Some(absolute("HOME")?.join(".local/state")))?
        }
    };
    Some(base.join("pinhole"))
}

/// Where the folder of this name is for what is kept, if the system has a place for it.
#[cfg(feature = "studio")]
pub fn kept_folder(name: &str) -> Option<PathBuf> {
    Some(state_folder()?.join(name))
}

/// Keeps a text in a file of such a folder, which no other user can look into.
#[cfg(feature = "studio")]
pub fn keep(path: &Path, text: &str) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)?;
    let purpose = Purpose::Within(folder);
    write(path, purpose, &AtomicBool::new(false), |file| {
        file.write_all(text.as_bytes())
    })
}

/// Removes a file that is kept. It is no matter if there is none.
#[cfg(feature = "studio")]
pub fn forget(path: &Path) {
    let _ = fs::remove_file(path);
}

/// Removes the files in a folder that are older than this.
#[cfg(feature = "studio")]
pub fn forget_older(folder: &Path, age: Duration) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let changed = entry.metadata().and_then(|found| found.modified());
        if changed.is_ok_and(|at| at.elapsed().is_ok_and(|elapsed| elapsed > age)) {
            forget(&entry.path());
        }
    }
}

/// The name of the file that belongs to something that has a longer name.
#[cfg(feature = "studio")]
pub fn name_of(long: &[u8]) -> String {
    let digest = hmac_sha256::Hash::hash(long);
    let digits = digest[..16].iter().map(|byte| format!("{byte:02x}"));
    digits.collect::<String>() + ".json"
}
