//! Studio: a page for editing a scene, with the text on the left and the picture on the right.
//!
//! The page and its host exchange messages, which `docs/protocol.md` describes. Most of them are
//! messages of the language server ([`crate::lsp::Server`]), each as one JSON text. A few others
//! are about the scene's file and about whole pictures ([`download`]).
//!
//! There are two hosts. The host in this module (`host`) serves the page over a WebSocket, on this
//! machine only. `access` decides which pages are admitted, `connection_limits` limits connections
//! without a token, and `conversation` serves one page. `scene_file` is the scene's file, which all
//! pages share, `threaded_download` renders a picture to a file on several threads, and `draft`
//! stores texts that are not saved. The other host is the crate `studio/engine`, which runs in the
//! browser itself.

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
