//! The language server: the editor's answers, spoken in the Language Server Protocol.
//!
//! In: messages. Out: messages. [`Server`] is a value that holds the open texts (`documents`) and knows neither threads nor streams, so that any host can carry
//! it; [`stdio`] does over standard input and output. [`crate::editor`] has the answers, `answers` asks it, and `convert` makes the protocol's types of them. `pictures` and `frames`
//! answer about a text's picture, by requests of our own that docs/protocol.md describes.

mod answers;
mod convert;
mod documents;
mod frames;
pub mod messages;
mod params;
mod pictures;
mod prepared;
mod server;
pub mod stdio;

pub use server::Server;
