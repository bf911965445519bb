//! The folder for the user's private Pinhole files, usually `~/.local/state/pinhole`.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

/// Returns the path of Pinhole's state folder, in which it keeps private files of the user. Returns
/// `None` if no environment variable gives an absolute path for it.
pub(super) fn state_folder() -> Option<PathBuf> {
    let absolute = |name| {
        env::var_os(name)
            .map(PathBuf::from)
            .filter(|p| p.is_absolute())
    };
    let base = if cfg!(windows) {
        absolute("LOCALAPPDATA")?
    } else {
        absolute("XDG_STATE_HOME").or_else(|| Some(absolute("HOME")?.join(".local/state")))?
    };
    Some(base.join("pinhole"))
}

/// Creates the state folder, or a folder in it, if it is missing. Other users can neither read nor
/// list it.
pub(super) fn make(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

/// Returns a short text for `long`, for use in a file name: the first 128 bits of its SHA-256, in
/// hexadecimal.
pub(super) fn digest(long: &[u8]) -> String {
    let digest = hmac_sha256::Hash::hash(long);
    let digits = digest[..16].iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}
