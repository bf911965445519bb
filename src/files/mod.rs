//! The only module that opens, creates and replaces files.
//!
//! In: a path and a purpose. Out: a file, or an error in words. `kind` checks what kind of file a
//! path names before it is opened, so that nothing blocks on a pipe. `original` recognises a file
//! that was read. `write` writes every file completely or not at all, through a `temporary` file
//! that then replaces the old one. In `exchange`, the two files exchange their names if another
//! program may save the old one meanwhile. A file that cannot be replaced is written `in_place`.
//! `output_folder` replaces only files that Pinhole itself wrote into a folder. `user_files` stores
//! small files for the user alone in the `state` folder. `system` has what the system says of itself. `error_words` expresses the system's
//! errors in plain words. Other modules decide what files contain.
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
