//! Expresses the system's errors about files in plain words.

use std::io;

/// Replaces the message of an operating system's error by plain words. Other errors are returned
/// unchanged.
pub fn in_words(error: io::Error) -> io::Error {
    use io::ErrorKind;
    let said = error.to_string();
    let Some((said, number)) = said.split_once(" (os error ") else {
        return error;
    };
    let kind = error.kind();
    let words = match kind {
        ErrorKind::NotFound => "there is no such file or folder",
        // On Unix, the error number 1 is EPERM. It occurs, for example, if a program changes a file
        // that is marked as immutable.
        ErrorKind::PermissionDenied if cfg!(unix) && number.starts_with("1)") => {
            "the system protects it from being changed"
        }
        ErrorKind::PermissionDenied => "its permissions, or those of its folder, do not allow that",
        ErrorKind::ReadOnlyFilesystem => "it lies where files can only be read",
        ErrorKind::ResourceBusy => "it is in use, or something is mounted there",
        ErrorKind::StorageFull => "there is no room left for it",
        ErrorKind::QuotaExceeded => "your share of the disk is used up",
        ErrorKind::FileTooLarge => "it would get larger than files may be here",
        _ => said,
    };
    io::Error::new(kind, words.to_owned())
}
