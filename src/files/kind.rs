//! Determines the kind of a file before it is opened. Otherwise, opening a pipe could wait forever,
//! and opening a device could have effects.

use std::{
    fmt,
    fs::{self, File, Metadata, OpenOptions},
    io::{self, Read},
    path::Path,
};

use super::error_words::in_words;

/// Kind of file at a path, after links are followed.
#[cfg_attr(
    not(unix),
    allow(dead_code, reason = "other systems do not tell these kinds")
)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A regular file.
    File,
    /// A folder.
    Folder,
    /// A named pipe (FIFO).
    Pipe,
    /// A character device, such as `/dev/null` or a terminal.
    Device,
    /// A block device, such as a disk.
    Disk,
    /// A socket.
    Socket,
}

impl FileKind {
    /// Returns the kind of file that the metadata describe.
    pub fn of(found: &Metadata) -> Self {
        if found.is_dir() {
            return Self::Folder;
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::FileTypeExt as _;
            let kind = found.file_type();
            if kind.is_fifo() {
                return Self::Pipe;
            } else if kind.is_char_device() {
                return Self::Device;
            } else if kind.is_block_device() {
                return Self::Disk;
            } else if kind.is_socket() {
                return Self::Socket;
            }
        }
        Self::File
    }

    /// Returns the error for a file of this kind where a regular file is needed.
    pub fn refused(self) -> io::Error {
        let kind = match self {
            Self::Folder => io::ErrorKind::IsADirectory,
            _ => io::ErrorKind::InvalidInput,
        };
        io::Error::new(kind, format!("it is {self}, not a file"))
    }
}

impl fmt::Display for FileKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::File => "a file",
            Self::Folder => "a folder",
            Self::Pipe => "a pipe",
            Self::Device => "a device",
            Self::Disk => "a disk",
            Self::Socket => "a socket",
        })
    }
}

/// Returns the folder that contains a file; `.` if the path is only a name.
pub fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// Opens a regular file for reading. Links are followed. Fails for any other kind of file, without
/// waiting if it is a pipe.
pub fn open(path: &Path) -> io::Result<File> {
    open_if(path, |kind| kind == FileKind::File)
}

/// Returns whether a path stands for a file descriptor that is already open: `/dev/stdin`, or a
/// path such as `/dev/fd/63`, which a shell passes for `<(command)`.
fn is_argument(path: &Path) -> bool {
    path == Path::new("/dev/stdin")
        || [Path::new("/dev/fd"), Path::new("/proc/self/fd")]
            .iter()
            .any(|folder| path.parent() == Some(folder))
}

/// Opens a file for reading. Its path is an argument on the command line, and must lead to a
/// regular file, or stand for a descriptor that the shell has opened. Such a descriptor may also be
/// a pipe or a device.
pub fn open_argument(path: &Path) -> io::Result<File> {
    if !is_argument(path) {
        return open(path);
    }
    let file = open_if(path, |kind| kind != FileKind::Folder)?;
    // If the argument is a pipe, the user expects the program to wait for its data.
    wait_for_it(&file)?;
    Ok(file)
}

fn open_if(path: &Path, is_wanted: impl Fn(FileKind) -> bool) -> io::Result<File> {
    open_at_once(path, is_wanted).map_err(in_words)
}

fn open_at_once(path: &Path, is_wanted: impl Fn(FileKind) -> bool) -> io::Result<File> {
    let check = |found: &Metadata| match FileKind::of(found) {
        kind if is_wanted(kind) => Ok(()),
        kind => Err(kind.refused()),
    };
    check(&fs::metadata(path)?)?;
    let file = without_waiting(OpenOptions::new().read(true)).open(path)?;
    // Another program may have replaced the file before it was opened, so its kind is checked
    // again.
    check(&file.metadata()?)?;
    Ok(file)
}

/// Sets flags for opening files: opening a named pipe does not wait for another process to open it,
/// and opening a terminal does not make it the controlling terminal of this process.
#[cfg(unix)]
pub(super) fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    use rustix::fs::OFlags;
    use std::os::unix::fs::OpenOptionsExt as _;
    options.custom_flags((OFlags::NONBLOCK | OFlags::NOCTTY).bits() as _)
}

#[cfg(not(unix))]
pub(super) fn without_waiting(options: &mut OpenOptions) -> &mut OpenOptions {
    options
}

/// Makes an open pipe or device blocking: reading waits for data, and writing waits for space.
#[cfg(unix)]
pub(super) fn wait_for_it(file: &File) -> io::Result<()> {
    use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
    let flags = fcntl_getfl(file)?;
    Ok(fcntl_setfl(file, flags - OFlags::NONBLOCK)?)
}

#[cfg(not(unix))]
pub(super) fn wait_for_it(_: &File) -> io::Result<()> {
    Ok(())
}

/// Reads a regular file. Fails if it has more than `most` bytes.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    read_from(file, most)
}

/// Reads a stream to its end. Fails if it has more than `most` bytes.
pub fn read_from(from: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut from = from.take(most.saturating_add(1));
    from.read_to_end(&mut bytes).map_err(in_words)?;
    if bytes.len() as u64 > most {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    Ok(bytes)
}
