//! From the editor's answers to those of the protocol, and back. Their kinds are numbers, whose
//! names in the protocol stand beside them.

mod client;
mod completion;
mod converter;
mod tokens;

pub use client::{Client, FIX_ALL, QUICK_FIX, capabilities};
pub use converter::{Converter, changes, color};
