//! From the editor's answers to the protocol's types, and back.

mod client;
mod completion;
mod converter;
mod tokens;

pub use client::{Client, capabilities};
pub use converter::{Converter, changes, color};
