//! Provides the current content of a file that is being edited.
//!
//! Reads the file at the start and after each change, and sets a flag when the content taken last
//! is outdated. The module does not depend on scenes or pictures. Its callers decide how to use the
//! content, and when to stop work on it.

mod latest;
mod watcher;

pub use self::{
    latest::Latest,
    watcher::{FileContent, watch},
};
