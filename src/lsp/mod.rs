//! The language server: the editor's answers, spoken in the Language Server Protocol.
//!
//! In: messages, as an editor writes them to standard input. Out: messages to standard output, and nothing else there.
//! `documents` has the open texts, [`crate::editor`] the answers, `convert` makes the protocol's types of them; `pages` keeps what
//! codes link to; `server` is one loop on one thread that takes messages in their order.

mod convert;
mod documents;
mod pages;
mod server;
mod uri;

pub use server::{Ended, serve};
