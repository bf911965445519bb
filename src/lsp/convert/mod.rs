//! Converts between the types of the editor module and the types of the language server protocol.
//! The protocol identifies kinds of completions, symbols and so on by numbers; comments give their
//! names.

mod client;
mod completion;
mod converter;
mod tokens;

pub use client::{Client, FIX_ALL, QUICK_FIX, capabilities};
pub use converter::{Converter, changes, color};
