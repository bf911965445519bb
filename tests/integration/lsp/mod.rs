//! The language server: the binary over pipes (`session`, `neovim`), and in this process, where it is known what it has done by when.

pub mod client;
mod frames;
mod neovim;
mod session;
pub mod talk;
mod transcripts;
mod viewport;
