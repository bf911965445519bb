//! Provides the current content of a file that is being edited.
//!
//! The file is read at the start and after each change. When the file is read again, the flag
//! [`Latest::stale`] tells the caller that the previous content is outdated. The module does not
//! depend on scenes or pictures. Its callers decide how to use the content, and when to stop work
//! on it.

mod latest;
mod watcher;

pub use self::{
    latest::Latest,
    watcher::{FileContent, watch},
};
