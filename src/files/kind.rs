//! What a path leads to, which is looked at before it is opened: opening a pipe may wait without
//! end, and opening a device may do something.

use std::{
    fmt,
    fs::{self, File, Metadata, OpenOptions},
    io::{self, Read},
    path::Path,
};

use super::words::in_words;

/// What there can be at a path, links followed.
#[cfg_attr(
    not(unix),
    allow(dead_code, reason = "other systems do not tell these kinds")
)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A file with bytes.
    File,
    /// A folder.
    Folder,
    /// A named pipe, a FIFO.
    Pipe,
    /// A device of characters, such as `/dev/null` or a terminal.
    Device,
    /// A device of blocks, such as a disk.
    Disk,
    /// A socket.
    Socket,
}

impl Kind {
    /// The kind of what was found.
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

    /// Why this is not taken for a file.
    pub fn refused(self) -> io::Error {
        let kind = match self {
            Self::Folder => io::ErrorKind::IsADirectory,
            _ => io::ErrorKind::InvalidInput,
        };
        io::Error::new(kind, format!("it is {self}, not a file"))
    }
}

impl fmt::Display for Kind {
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

/// The folder that a file lies in.
pub fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// Opens a file to be read. Whatever else there is at the path, or at the end of a link there, is
/// refused, and never waited for.
pub fn open(path: &Path) -> io::Result<File> {
    open_if(path, |kind| kind == Kind::File)
}

/// Whether a path names something that this process has open already: `/dev/stdin`, or the
/// `/dev/fd/63` that a shell writes for `<(…)`.
fn is_argument(path: &Path) -> bool {
    path == Path::new("/dev/stdin")
        || [Path::new("/dev/fd"), Path::new("/proc/self/fd")]
            .iter()
            .any(|folder| path.parent() == Some(folder))
}

/// Opens what the command line names to be read: a file, or whatever the shell has connected.
pub fn open_argument(path: &Path) -> io::Result<File> {
    if !is_argument(path) {
        return open(path);
    }
    let file = open_if(path, |kind| kind != Kind::Folder)?;
    // Who connected it means it to be waited for.
    wait_for_it(&file)?;
    Ok(file)
}

fn open_if(path: &Path, is_wanted: impl Fn(Kind) -> bool) -> io::Result<File> {
    open_at_once(path, is_wanted).map_err(in_words)
}

fn open_at_once(path: &Path, is_wanted: impl Fn(Kind) -> bool) -> io::Result<File> {
    let check = |found: &Metadata| match Kind::of(found) {
        kind if is_wanted(kind) => Ok(()),
        kind => Err(kind.refused()),
    };
    check(&fs::metadata(path)?)?;
    let file = without_waiting(OpenOptions::new().read(true)).open(path)?;
    // It may have become something else meanwhile.
    check(&file.metadata()?)?;
    Ok(file)
}

/// Has a file opened without waiting for whoever is at the other end of a pipe, and no terminal
/// take this process over.
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

/// Has reading from and writing to an open pipe wait again.
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

/// Reads a file of at most so many bytes.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = open(path)?;
    read_from(file, most)
}

/// Reads what the system tells in a file, such as `/proc/meminfo`, if it does.
pub fn read_system_text(path: impl AsRef<Path>) -> Option<String> {
    /// Maximum number of bytes: a table has a few thousand for each processor.
    const LIMIT: u64 = 16 << 20;
    String::from_utf8(read(path.as_ref(), LIMIT).ok()?).ok()
}

/// Reads to the end of a stream of at most so many bytes.
pub fn read_from(from: impl Read, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut from = from.take(most.saturating_add(1));
    from.read_to_end(&mut bytes).map_err(in_words)?;
    match bytes.len() as u64 > most {
        true => Err(io::ErrorKind::FileTooLarge.into()),
        false => Ok(bytes),
    }
}
