//! The language server from outside: the binary, and what goes through its standard input and output.

pub mod client;
mod frames;
mod neovim;
mod session;
mod talk;
mod transcripts;
