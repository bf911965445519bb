//! Studio: a page to edit a scene, with its text on the left and its picture on the right.
//!
//! The page and its host exchange the messages that `docs/protocol.md` describes: those of the
//! language server ([`crate::lsp::Server`]), one JSON text each, and a few of the host's own, about
//! the scene's file and about whole pictures ([`download`]). There are two hosts. One is here:
//! `host` serves the page on this machine only, over a web socket; `access` decides which pages are
//! admitted, `connection_limits` limits connections without a token, `conversation` serves one
//! page, `scene_file` is the scene's file, which all pages share, `threaded_download` renders a
//! picture's file on threads, and `draft` keeps texts that are not saved. The other host is the
//! crate `studio/engine`, which runs in the browser itself.

#[cfg(feature = "studio")]
mod access;
#[cfg(feature = "studio")]
mod connection_limits;
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
mod threaded_download;

#[cfg(feature = "studio")]
pub use self::{host::Host, scene_file::SceneFile};
