//! Tests of `pinhole studio` as a browser sees it: access, messages, and the scene's file.

mod access;
pub mod client;
mod conversation;
mod files;
mod highlighting;
