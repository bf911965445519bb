//! Converts between the types of the editor module and those of the protocol. Kinds are numbers in
//! the protocol; comments beside them have their names there.

mod client;
mod completion;
mod converter;
mod tokens;

pub use client::{Client, FIX_ALL, QUICK_FIX, capabilities};
pub use converter::{Converter, changes, color};
