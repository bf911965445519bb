//! Converts between the types of the editor module and the types of the language server protocol.
//! The protocol uses numbers for kinds; comments give the protocol's names for these numbers.

mod client;
mod completion;
mod converter;
mod tokens;

pub use client::{Client, FIX_ALL, QUICK_FIX, capabilities};
pub use converter::{Converter, changes, color};
