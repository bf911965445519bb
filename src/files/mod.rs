//! The only module that opens, creates and replaces files. Its errors say in plain words what is
//! wrong.
//!
//! - `kind` checks the kind of a file before it is opened, so that the program does not wait for a
//!   pipe.
//! - `original` recognises whether a file has changed since it was read.
//! - `write` writes files completely or not at all: a `temporary` file replaces the old one.
//!   `exchange` exchanges the names of the temporary and the old file, in case another program
//!   saves the old file at the same moment. `in_place` overwrites a file that cannot be replaced.
//! - `output_folder` replaces only files that Pinhole itself wrote into a folder.
//! - `user_files` stores small private files in the user's `state` folder.
//! - `system` reads text files of the operating system, such as `/proc/meminfo`.
//! - `error_words` replaces the system's error messages by plain words.
#![allow(
    clippy::disallowed_methods,
    reason = "everything else opens, makes and replaces files by this module"
)]

#[cfg(feature = "files")]
mod error_words;
#[cfg(feature = "files")]
mod exchange;
#[cfg(feature = "files")]
mod in_place;
#[cfg(feature = "files")]
mod kind;
#[cfg(feature = "files")]
mod original;
#[cfg(feature = "cli")]
mod output_folder;
#[cfg(feature = "files")]
mod state;
mod system;
#[cfg(feature = "files")]
mod temporary;
#[cfg(all(feature = "studio", not(target_family = "wasm")))]
mod user_files;
#[cfg(feature = "files")]
mod write;

#[cfg(feature = "cli")]
pub use self::output_folder::{NotWritten, OutputFolder};
pub use self::system::read_system_text;
#[cfg(all(feature = "studio", not(target_family = "wasm")))]
pub use self::user_files::{forget, forget_older, keep, kept_folder, name_of};
#[cfg(feature = "files")]
pub use self::{
    in_place::copies_left,
    kind::{folder, open, open_argument, read, read_from},
    original::{FileId, Original, id, is_changed},
    write::{Purpose, Sink, check_writable, write, write_stream},
};
