//! Studio: a page for editing a scene, with the text on the left and the picture on the right.
//!
//! The page and its host exchange the messages that `docs/protocol.md` describes: those of the
//! language server ([`crate::lsp::Server`]), each as one JSON text, and a few messages of the
//! host's own about the scene's file and about whole pictures ([`download`]). There are two hosts.
//! The one in this module serves the page on this machine only, over a WebSocket (`host`). `access`
//! decides which pages are admitted, `connection_limits` limits connections without a token, and
//! `conversation` serves one page. `scene_file` is the scene's file, which all pages share,
//! `threaded_download` renders a picture's file on several threads, and `draft` stores texts that
//! are not saved. The other host is the crate `studio/engine`, which runs in the browser itself.

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
