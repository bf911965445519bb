//! Studio: a page for editing a scene, with the text on the left and the picture on the right.
//!
//! The page and its host exchange messages, which `docs/protocol.md` describes. Most of them are
//! messages of the language server ([`crate::lsp::Server`]), each as one JSON text. Other messages
//! concern the scene's file, or a picture that is rendered to a file for the user to download
//! ([`download`]).
//!
//! There are two hosts. The host in this module (`host`) serves the page over a WebSocket, on this
//! machine only. `access` decides which pages are admitted, `connection_limits` limits connections
//! without a token, and `conversation` serves one page. `scene_file` reads and saves the scene's
//! file, which all pages share, `lesson_file` reads a teacher's lesson, `threaded_download` renders
//! a picture to a file on several threads, and `draft` stores texts that are not saved. The other
//! host is the crate `studio/engine`, which runs in the browser itself.

#[cfg(not(target_family = "wasm"))]
mod access;
#[cfg(not(target_family = "wasm"))]
mod connection_limits;
#[cfg(not(target_family = "wasm"))]
mod conversation;
pub mod download;
#[cfg(not(target_family = "wasm"))]
mod draft;
#[cfg(not(target_family = "wasm"))]
mod host;
#[cfg(not(target_family = "wasm"))]
mod lesson_file;
#[cfg(not(target_family = "wasm"))]
mod scene_file;
#[cfg(not(target_family = "wasm"))]
mod threaded_download;

#[cfg(not(target_family = "wasm"))]
pub use self::{host::Host, lesson_file::LessonFile, scene_file::SceneFile};
