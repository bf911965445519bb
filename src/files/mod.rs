//! Files of the system: the one place where they are opened, made and replaced.
//!
//! In: a path, and what somebody wants with it. Out: a file, or why there is none. `kind` looks at
//! what a path leads to before it is opened, so that nothing waits for a pipe; `original` knows a
//! file again that was read; `write` writes every file whole or not at all, by way of a `temporary`
//! one, and has the two `exchange` their names where somebody else may save the old one; and `output_folder` replaces in a folder only what was made there; `kept` has the small
//! files that are kept of a user, in the folder that `state` knows. What the system says when that
//! fails, `words` says to people. What is in the files is left to others.
#![allow(
    clippy::disallowed_methods,
    reason = "everything else opens, makes and replaces files by this module"
)]

mod exchange;
mod in_place;
#[cfg(feature = "studio")]
mod kept;
mod kind;
mod original;
#[cfg(feature = "cli")]
mod output_folder;
mod state;
mod temporary;
mod words;
mod write;

#[cfg(feature = "studio")]
pub use self::kept::{forget, forget_older, keep, kept_folder, name_of};
#[cfg(feature = "cli")]
pub use self::output_folder::{NotWritten, OutputFolder};
pub use self::{
    in_place::copies_left,
    kind::{folder, open, open_argument, read, read_from, read_system_text},
    original::{FileId, Original, id, is_changed},
    write::{Purpose, Sink, check_writable, write, write_stream},
};
