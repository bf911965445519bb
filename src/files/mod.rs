//! The one place where files are opened, created and replaced.
//!
//! In: a path and a purpose. Out: a file, or an error in words. `kind` checks what a path leads to
//! before it is opened, so that nothing blocks on a pipe. `original` recognises a file that was
//! read. `write` writes every file completely or not at all, through a `temporary` one; the two
//! `exchange` their names if another program may save the old one meanwhile, and a file that cannot
//! be replaced is written `in_place`. `output_folder` replaces only files that Pinhole itself wrote
//! into a folder. `user_files` has small files for the user alone, in the `state` folder.
//! `error_words` turns the system's errors into plain words. The content of files is left to
//! others.
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
