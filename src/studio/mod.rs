//! Studio: a scene as a page, its text on the left and its picture on the right.
//!
//! The page and the engine hold the conversation that `docs/protocol.md` describes: messages of the
//! language server ([`crate::lsp::Server`]), one JSON text each, and a few of the host's own, about
//! the scene's file and whole pictures ([`download`]). There are two hosts. One is here: `host`
//! serves the page on this machine alone and carries the conversation over a web socket; `access`
//! says who may do what, `strangers` limits connections without a token, `conversation` talks to
//! one page, `scene_file` is the scene's file, which all pages share, `watched` makes the file of a
//! picture, and `draft` keeps what is not saved of it. The other one is the crate `studio/engine`,
//! which runs in the browser itself.

#[cfg(feature = "studio")]
mod access;
#[cfg(feature = "studio")]
mod conversation;
pub mod download;
#[cfg(feature = "studio")]
mod draft;
#[cfg(feature = "studio")]
mod host;
#[cfg(feature = "studio")]
mod scene_file;
#[cfg(feature = "studio")]
mod strangers;
#[cfg(feature = "studio")]
mod watched;

#[cfg(feature = "studio")]
pub use self::{host::Host, scene_file::SceneFile};
