//! A file that is being edited, as it is now.
//!
//! In: a path. Out: the file's content, at the start and whenever it has changed, and a flag that
//! says when what was taken is no longer the newest. Nothing here knows of scenes or pictures: what
//! is made of a content, and when it is given up, is for others.

mod latest;
mod watcher;

pub use self::{
    latest::Latest,
    watcher::{Content, watch},
};
