//! The program as it is called from outside.

use std::{
    path::Path,
    process::{Command, Stdio},
};

/// The program in a folder, whatever the environment says of languages and terminals.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
    command
        .args(arguments)
        .current_dir(folder)
        .env("LC_ALL", "C.UTF-8")
        .env_remove("NO_COLOR")
        .env_remove("NO_GRAPHICS")
        .stdin(Stdio::null());
    command
}
