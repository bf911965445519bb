//! Where the system has a place for what programs keep of a user.

use std::{env, path::PathBuf};

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
