//! What the system says of files, in words for people.

use std::io;

/// An error with words in place of the system's number; any other error as it is.
pub fn in_words(error: io::Error) -> io::Error {
    use io::ErrorKind as Kind;
    let said = error.to_string();
    let Some((said, number)) = said.split_once(" (os error ") else {
        return error;
    };
    let kind = error.kind();
    let words = match kind {
        Kind::NotFound => "there is no such file or folder",
        // EPERM
        Kind::PermissionDenied if cfg!(unix) && number.starts_with("1)") => {
            "the system protects it from being changed"
        }
        Kind::PermissionDenied => "its permissions, or those of its folder, do not allow that",
        Kind::ReadOnlyFilesystem => "it lies where files can only be read",
        Kind::ResourceBusy => "it is in use, or something is mounted there",
        Kind::StorageFull => "there is no room left for it",
        Kind::QuotaExceeded => "your share of the disk is used up",
        Kind::FileTooLarge => "it would get larger than files may be here",
        _ => said,
    };
    io::Error::new(kind, words.to_owned())
}
