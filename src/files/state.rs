//! The folder for the state of programs, for each user.

use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

/// Returns Pinhole's folder in the user's folder for the state of programs; `None` if no absolute
/// path is known.
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

/// Creates the state folder, or a folder in it, if it is missing. No other user can read it.
pub(super) fn make(folder: &Path) -> io::Result<()> {
    let mut builder = fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

/// Returns 128 bits of the SHA-256 of a key in hexadecimal, as a part of a file's name.
pub(super) fn digest(long: &[u8]) -> String {
    let digest = hmac_sha256::Hash::hash(long);
    let digits = digest[..16].iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}
