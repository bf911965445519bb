//! Provides the current content of a file that is being edited.
//!
//! The file is read at the start and after each change. When it is read again, a flag tells the
//! caller that the content it has taken is outdated. The module does not depend on scenes or
//! pictures. Its callers decide how to use the content, and when to stop work on it.

mod latest;
mod watcher;

pub use self::{
    latest::Latest,
    watcher::{FileContent, watch},
};
