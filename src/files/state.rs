//! Where the system has a place for what programs keep of a user.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

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

/// Makes such a folder, or one in it, where there is none yet. No other user can look into it.
pub(super) fn make(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

/// What stands in a file's name for something longer.
pub(super) fn digest(long: &[u8]) -> String {
    let digest = hmac_sha256::Hash::hash(long);
    let digits = digest[..16].iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}
