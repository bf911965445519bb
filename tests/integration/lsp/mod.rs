//! The language server: the binary over pipes (`session`, `neovim`, `emacs`), and in this process,
//! where it is known what it has done by when.

pub mod client;
mod emacs;
mod frames;
mod neovim;
mod ranges;
mod session;
pub mod talk;
mod transcripts;
mod viewport;

use std::{env, ffi::OsString, path::Path};

/// The path for an editor that starts the server by its name: the program under test comes first.
fn path_with_program() -> OsString {
    let program = Path::new(env!("CARGO_BIN_EXE_pinhole"));
    let own = [program.parent().expect("a folder").to_owned()];
    let others = env::var_os("PATH").unwrap_or_default();
    let folders = own.into_iter().chain(env::split_paths(&others));
    env::join_paths(folders).expect("a path")
}
