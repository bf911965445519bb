//! `pinhole studio` from a browser's side: access, the conversation, and the scene's file.

mod access;
pub mod client;
mod conversation;
mod files;
mod highlighting;
