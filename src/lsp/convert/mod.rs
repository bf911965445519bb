//! From the editor's answers to the protocol's types, and back.

mod client;
mod completion;
mod page;
mod tokens;

pub use client::{Client, capabilities};
pub use page::{Page, changes, color};
