//! The language server: the editor's answers, spoken in the Language Server Protocol.
//!
//! In: messages. Out: messages. [`Server`] is a value that holds the open texts (`documents`) and knows neither threads nor streams, so that any host can carry
//! it; [`stdio`] does over standard input and output. [`crate::editor`] has the answers, `answers` asks it, and `convert` makes the protocol's types of them.

mod answers;
mod convert;
mod documents;
pub mod json;
mod params;
mod server;
pub mod stdio;

pub use server::Server;
