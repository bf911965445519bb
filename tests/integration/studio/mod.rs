//! `pinhole studio` as a browser meets it: who is let in, what the conversation says, and what
//! becomes of the file.

mod access;
pub mod client;
mod conversation;
mod files;
mod highlighting;
