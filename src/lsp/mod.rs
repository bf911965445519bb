//! Language server: provides the answers of the editor module by the Language Server Protocol.
//!
//! [`Server`] receives messages, holds the open texts (`documents`), and returns messages. It uses
//! neither threads nor streams, so that any host can run it; [`stdio`] runs it on standard input
//! and output. `text_requests` calls [`crate::editor`] for the answers, and `convert` converts them
//! to the types of the protocol (`protocol`). `picture_requests` and `frames` answer requests about
//! the picture of a text. These requests are Pinhole's own; docs/protocol.md describes them.
//! `scene_version` caches the data for these answers, and `view` reads from where a picture is seen
//! that is not the picture of the scene's own camera.

mod convert;
mod documents;
mod frames;
pub mod messages;
mod params;
mod picture_requests;
mod protocol;
mod scene_version;
mod server;
pub mod stdio;
mod text_requests;
mod view;

pub use params::{Answer, Refusal, optional, response};
pub use server::Server;
#[doc(hidden)]
pub use server::catch_panics;
