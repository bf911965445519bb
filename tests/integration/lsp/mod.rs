//! Tests of the language server. Some start the program and talk to it over pipes (`session`,
//! `neovim`, `emacs`). Others use a server in their own process, which they can advance in small
//! steps.

pub mod client;
mod emacs;
mod frames;
pub mod local_client;
mod neovim;
mod session;
mod sliders;
mod transcripts;
mod view;
mod viewport;

use std::{env, ffi::OsString, path::Path};

/// Returns a search path that begins with the folder of the tested program, for an editor that
/// starts the server by its name.
fn path_with_program() -> OsString {
    let program = Path::new(env!("CARGO_BIN_EXE_pinhole"));
    let own = [program.parent().expect("a folder").to_owned()];
    let others = env::var_os("PATH").unwrap_or_default();
    let folders = own.into_iter().chain(env::split_paths(&others));
    env::join_paths(folders).expect("a path")
}
