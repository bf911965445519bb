//! The language server: the editor's answers, spoken in the Language Server Protocol.
//!
//! In: messages. Out: messages. [`Server`] is a value that holds the open texts (`documents`) and
//! knows neither threads nor streams, so that any host can carry it; [`stdio`] does over standard
//! input and output. [`crate::editor`] has the answers, `text_requests` asks it, and `convert`
//! makes of them what the protocol has (`protocol`). `picture_requests` and `frames` answer about a
//! text's picture, which `scene_version` keeps at hand, by requests of our own that
//! docs/protocol.md describes.

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

pub use params::{Answer, Refusal, optional, response};
pub use server::Server;
pub(crate) use server::unharmed;
