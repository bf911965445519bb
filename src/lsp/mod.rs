//! Language server: makes the answers of the editor module available through the Language Server
//! Protocol.
//!
//! [`Server`] receives messages, holds the open texts (`documents`), and returns messages. It uses
//! neither threads nor streams, so that any host can run it; [`stdio`] runs it on standard input
//! and output. `text_requests` calls [`crate::editor`] for the answers, and `convert` converts them
//! to the types of the protocol (`protocol`).
//!
//! `picture_requests` and `frames` answer requests about the picture of a text. These requests are
//! Pinhole's additions to the protocol; docs/protocol.md describes them. `scene_version` caches the
//! scene and the tracer's data, from which they are answered. A request may ask for the picture of
//! a second camera, which shows the scene from outside; `view` reads this camera.

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
