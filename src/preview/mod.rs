//! The current content of a file that is being edited.
//!
//! In: a path. Out: the file's content, at the start and whenever it has changed, and a flag that
//! is set when the content that was taken is no longer the newest. This module knows nothing of
//! scenes or pictures; its callers decide what to make of a content, and when to give it up.

mod latest;
mod watcher;

pub use self::{
    latest::Latest,
    watcher::{FileContent, watch},
};
