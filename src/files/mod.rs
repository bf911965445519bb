//! The only module that opens, creates and replaces files.
//!
//! In: a path, and the purpose of the file. Out: an open file, or an error in plain words.
//!
//! - `kind` checks the kind of a file before it is opened, so that the program does not wait for a
//!   pipe.
//! - `original` recognises whether a file has changed since it was read.
//! - `write` writes files completely or not at all: a `temporary` file replaces the old one.
//!   `exchange` exchanges the names of both, in case another program saves the old file at the same
//!   moment. `in_place` overwrites a file that cannot be replaced.
//! - `output_folder` replaces only files that Pinhole itself wrote into a folder.
//! - `user_files` stores small private files in the user's `state` folder.
//! - `error_words` replaces the system's error messages by plain words.
#![allow(
    clippy::disallowed_methods,
    reason = "everything else opens, makes and replaces files by this module"
)]

mod error_words;
mod exchange;
mod in_place;
mod kind;
mod original;
#[cfg(feature = "cli")]
mod output_folder;
mod state;
mod temporary;
#[cfg(feature = "studio")]
mod user_files;
mod write;

#[cfg(feature = "cli")]
pub use self::output_folder::{NotWritten, OutputFolder};
#[cfg(feature = "studio")]
pub use self::user_files::{forget, forget_older, keep, kept_folder, name_of};
pub use self::{
    in_place::copies_left,
    kind::{folder, open, open_argument, read, read_from, read_system_text},
    original::{FileId, Original, id, is_changed},
    write::{Purpose, Sink, check_writable, write, write_stream},
};
