//! Writes files completely or not at all, and only where a file's purpose allows it.

use std::{
    fs::{self, File, Metadata, OpenOptions},
    io::{self, BufWriter, Cursor, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

use tempfile::{Builder, NamedTempFile};

use super::{
    error_words::in_words,
    exchange, in_place,
    kind::{self, FileKind, folder, without_waiting},
    original::{Original, changed},
    temporary::{self, locked},
};

/// Destination to which bytes can be written at any position, such as a file.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Purpose of a file that is written. The purpose decides whether an existing file may be replaced.
#[derive(Clone, Copy, Debug)]
pub enum Purpose<'a> {
    /// The user named the file. An existing file is replaced, and links are followed. A pipe or a
    /// device is also allowed; nothing is written to it until the content is complete.
    Named,
    /// Pinhole chose the name of a file in this folder. An existing file is replaced. Links are
    /// followed, unless they lead out of the folder.
    Within(&'a Path),
    /// Pinhole chose the name of a file in a folder, and has tried to read the file before. If the
    /// file existed then, it is replaced only if it has not changed since. If it did not exist
    /// then, writing fails if it exists now.
    Again {
        /// The folder in which the file must lie after links are followed.
        within: &'a Path,
        /// The file as it was read before, or [`Original::missing`] if it did not exist.
        original: &'a Original,
    },
    /// Pinhole chose the name of a private file in this folder, which no other user can read. An
    /// existing file is replaced. Links are followed, unless they lead out of the folder.
    Private(&'a Path),
    /// The file must be new. If a file exists already, it stays unchanged, and writing fails.
    New,
    /// The program changes a file that it has read. The file is replaced only if no other program
    /// has changed it since. Links are followed.
    Change(&'a Original),
}

impl<'a> Purpose<'a> {
    /// Returns the folder in which the file must lie after links are followed, or `None` if it may
    /// lie anywhere.
    fn outer(self) -> Option<&'a Path> {
        match self {
            Self::Within(outer) | Self::Private(outer) | Self::Again { within: outer, .. } => {
                Some(outer)
            }
            Self::Named | Self::New | Self::Change(_) => None,
        }
    }

    /// Returns the file as it was read before, or `None` if it was not read. Before the file is
    /// replaced, its present content is compared with the content that was read.
    fn original(self) -> Option<&'a Original> {
        match self {
            Self::Change(original) | Self::Again { original, .. } => Some(original),
            Self::Named | Self::Within(_) | Self::Private(_) | Self::New => None,
        }
    }
}

/// Writes the file at `path` with the content that the function `write` produces. The old file
/// stays unchanged until the new content is complete.
///
/// The content goes into a temporary file in the same folder, which then replaces the old file. The
/// new file gets the old file's owner, if the system allows it, and the old permissions except
/// setuid, setgid and the sticky bit. Other hard links to the old file keep its content.
///
/// With [`Purpose::Change`], a file that cannot be replaced, for example because its folder is
/// read-only, is overwritten in place. A copy of the new content then exists until the file is
/// complete.
///
/// If `cancel` is set or an error occurs, the temporary file is removed. If this process is killed,
/// the temporary file stays until a process writes to the same `path` again.
pub fn write(
    path: &Path,
    purpose: Purpose<'_>,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    write_at_once(path, purpose, cancel, write).map_err(|error| writing_error(path, error))
}

fn write_at_once(
    path: &Path,
    purpose: Purpose<'_>,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let target = match target(path, purpose)? {
        WriteTarget::File(target) => target,
        WriteTarget::Stream => return write_device(path, cancel, write),
    };
    let Purpose::Change(original) = purpose else {
        return replace(&target, purpose, cancel, write);
    };
    let mut content = Checked {
        sink: Cursor::new(Vec::new()),
        cancel,
    };
    write(&mut content)?;
    let content = content.sink.into_inner();
    let replaced = replace(&target, purpose, cancel, |out| out.write_all(&content));
    match replaced {
        Err(error) if target.found.is_some() && in_place::is_reason(&error) => {
            in_place::write_in_place(&target.path, original, &content, error)
        }
        replaced => replaced,
    }
}

/// Writes the content that the function `write` produces to a stream, such as standard output.
/// Fails if `cancel` is set before everything is written. Bytes that were written before `cancel`
/// was set cannot be taken back.
pub fn write_stream(
    sink: impl Write,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, Checked { sink, cancel });
    write(&mut out)?;
    out.flush()
}

/// Checks whether a file can be written at `path`, so that the user learns of an error before a
/// long render. Some errors, such as a full disk, cannot be found in advance.
pub fn check_writable(path: &Path, purpose: Purpose<'_>) -> io::Result<()> {
    let is_writable = match target(path, purpose) {
        Ok(WriteTarget::File(target)) => temporary(&target, purpose).and_then(NamedTempFile::close),
        Ok(WriteTarget::Stream) => Ok(()),
        Err(error) => Err(error),
    };
    is_writable.map_err(|error| writing_error(path, error))
}

/// Replaces the message of an error that occurred while writing to `path` by plain words.
fn writing_error(path: &Path, error: io::Error) -> io::Error {
    match error.kind() {
        kind @ io::ErrorKind::NotFound if !folder(path).exists() => {
            io::Error::new(kind, "there is no such folder")
        }
        _ => in_words(error),
    }
}

/// Kind of the destination at a path.
enum WriteTarget {
    File(FileTarget),
    /// A pipe or a device.
    Stream,
}

/// A file that will be created or replaced: its path after links are followed, and the metadata of
/// the old file if there is one.
struct FileTarget {
    path: PathBuf,
    found: Option<Metadata>,
}

fn target(path: &Path, purpose: Purpose<'_>) -> io::Result<WriteTarget> {
    if matches!(purpose, Purpose::New) {
        let path = path.to_owned();
        return match fs::symlink_metadata(&path) {
            Ok(_) => Err(exists()),
            Err(_) => Ok(WriteTarget::File(FileTarget { path, found: None })),
        };
    }
    let target = behind_links(path)?;
    match &target {
        WriteTarget::Stream if matches!(purpose, Purpose::Named) => {}
        WriteTarget::Stream => return Err(FileKind::of(&fs::metadata(path)?).refused()),
        WriteTarget::File(target) => {
            check_folder(target, purpose)?;
            let is_there = target.found.is_some();
            let original = purpose.original().map(Original::bytes);
            if original.is_some_and(|bytes| bytes.is_some() != is_there) {
                return Err(changed());
            }
        }
    }
    Ok(target)
}

/// Fails if the file lies outside of the folder that `purpose` allows. Another program may change a
/// link at any time, so this check is repeated just before the file is replaced.
fn check_folder(target: &FileTarget, purpose: Purpose<'_>) -> io::Result<()> {
    let Some(outer) = purpose.outer() else {
        return Ok(());
    };
    let inner = fs::canonicalize(folder(&target.path))?;
    if !inner.starts_with(fs::canonicalize(outer)?) {
        let message = "a link leads out of its folder from there";
        return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
    }
    Ok(())
}

fn behind_links(path: &Path) -> io::Result<WriteTarget> {
    match fs::metadata(path) {
        Ok(found) => match FileKind::of(&found) {
            FileKind::File => {
                // Opening the file for writing tests its permissions. The system lets anyone who
                // may write to the folder replace the file, but its owner may have made it
                // read-only to protect it.
                without_waiting(OpenOptions::new().write(true)).open(path)?;
                Ok(WriteTarget::File(FileTarget {
                    path: fs::canonicalize(path)?,
                    found: Some(found),
                }))
            }
            FileKind::Pipe | FileKind::Device => Ok(WriteTarget::Stream),
            kind => Err(kind.refused()),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => match fs::read_link(path) {
            // The link leads to a file that does not exist, so the new file is created at the end
            // of the link. If links form a cycle, the error is not `NotFound`, so the recursion
            // ends.
            Ok(target) => behind_links(&folder(path).join(target)),
            Err(_) => Ok(WriteTarget::File(FileTarget {
                path: path.to_owned(),
                found: None,
            })),
        },
        Err(error) => Err(error),
    }
}

/// Writes the content to a temporary file, which then replaces the target.
fn replace(
    target: &FileTarget,
    purpose: Purpose<'_>,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let temporary = temporary(target, purpose)?;
    // The bytes are written to the [`File`], not to the [`NamedTempFile`], whose error messages
    // would contain the temporary path.
    let sink = temporary.as_file();
    let mut out = BufWriter::with_capacity(1 << 16, Checked { sink, cancel });
    write(&mut out)?;
    out.flush()?;
    drop(out);
    // Some systems report a full disk only when the file is synchronised.
    temporary.as_file().sync_all()?;
    check(cancel)?;
    check_folder(target, purpose)?;
    // If the file was read before, another program may have changed it while the new content was
    // written. So the file is compared with `original` again just before it is replaced.
    let (must_be_new, refused) = match purpose.original() {
        Some(original) if original.bytes().is_some() => {
            return exchange::replace(temporary, &target.path, original);
        }
        Some(_) => (true, changed()),
        None => (matches!(purpose, Purpose::New), exists()),
    };
    let persisted = if must_be_new {
        temporary.persist_noclobber(&target.path)
    } else {
        temporary.persist(&target.path)
    };
    match persisted {
        Ok(_) => Ok(()),
        Err(error) if error.error.kind() == io::ErrorKind::AlreadyExists => Err(refused),
        Err(error) => Err(error.error),
    }
}

fn exists() -> io::Error {
    let message = "there is something of this name already, which stays as it is";
    io::Error::new(io::ErrorKind::AlreadyExists, message)
}

/// Writes the content to a pipe or a device once the content is complete. Fails if no program has
/// opened the pipe's other end. Waits while the pipe is full.
fn write_device(
    path: &Path,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let sink = Cursor::new(Vec::new());
    let mut content = Checked { sink, cancel };
    write(&mut content)?;
    let mut device = without_waiting(OpenOptions::new().write(true))
        .open(path)
        .map_err(
            |error| match fs::metadata(path).map(|found| FileKind::of(&found)) {
                Ok(FileKind::Pipe) if error.kind() != io::ErrorKind::PermissionDenied => {
                    io::Error::new(error.kind(), "it is a pipe that nobody reads")
                }
                _ => error,
            },
        )?;
    match FileKind::of(&device.metadata()?) {
        FileKind::Pipe | FileKind::Device => {}
        kind => return Err(io::Error::other(format!("it has become {kind}"))),
    }
    kind::wait_for_it(&device)?;
    device.write_all(content.sink.get_ref())?;
    device.flush()
}

/// Suffix of the name of a temporary file.
const SUFFIX: &str = ".tmp";

/// Creates a temporary file in the target's folder. First removes temporary files that killed
/// processes left for the same target.
fn temporary(target: &FileTarget, purpose: Purpose<'_>) -> io::Result<NamedTempFile> {
    let FileTarget { path, found } = target;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // Most systems limit a name to 255 bytes. A character has at most four bytes, so 50 characters
    // leave room for the prefix, the six random characters and the suffix.
    let name: String = name.chars().take(50).collect();
    let prefix = format!(".pinhole-{name}-");
    remove_leftovers(folder(path), &prefix);
    // By default, other users cannot read a temporary file. A private file keeps these permissions.
    let is_private = matches!(purpose, Purpose::Private(_));
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    if found.is_none() && !is_private {
        // A new file gets the usual permissions. The system removes those that the user's umask
        // forbids.
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    }
    let temporary = locked(|| builder.tempfile_in(folder(path)))?;
    if let Some(found) = found
        && !is_private
    {
        keep_owner(temporary.as_file(), found)?;
    }
    Ok(temporary)
}

/// Removes temporary files that killed processes left in the folder. Their names begin with
/// `prefix`. Errors are ignored.
fn remove_leftovers(folder: &Path, prefix: &str) {
    // Each file stays locked until it is removed, so that no other process starts to write to it.
    for (name, _lock) in temporary::left(folder, prefix, SUFFIX) {
        let _ = fs::remove_file(folder.join(name));
    }
}

/// Gives a file the owner and the permissions of another file, described by `found`, as far as the
/// system allows. Only root may change owners; other users may choose among their groups.
#[cfg(unix)]
fn keep_owner(file: &File, found: &Metadata) -> io::Result<()> {
    use std::{
        fs::Permissions,
        os::unix::fs::{MetadataExt, PermissionsExt, fchown},
    };

    let (owner, group) = (Some(found.uid()), Some(found.gid()));
    let has_group = fchown(file, owner, group)
        .or_else(|_| fchown(file, None, group))
        .is_ok();
    let mode = found.mode() & 0o777;
    let allowed = if has_group {
        mode
    } else {
        of_other_group(mode)
    };
    file.set_permissions(Permissions::from_mode(allowed))
}

/// Returns the permissions of a file whose group could not be kept: the new group gets at most the
/// permissions that all other users have.
#[cfg(unix)]
fn of_other_group(mode: u32) -> u32 {
    mode & (0o707 | mode << 3)
}

#[cfg(not(unix))]
fn keep_owner(file: &File, found: &Metadata) -> io::Result<()> {
    file.set_permissions(found.permissions())
}

/// A destination whose writes fail once `cancel` is set.
struct Checked<'a, S> {
    sink: S,
    cancel: &'a AtomicBool,
}

fn check(cancel: &AtomicBool) -> io::Result<()> {
    if cancel.load(Ordering::Relaxed) {
        // The error must not have the kind `Interrupted`, after which callers would write again.
        return Err(io::Error::other("interrupted"));
    }
    Ok(())
}

impl<S: Write> Write for Checked<'_, S> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        check(self.cancel)?;
        self.sink.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sink.flush()
    }
}

impl<S: Seek> Seek for Checked<'_, S> {
    fn seek(&mut self, position: SeekFrom) -> io::Result<u64> {
        self.sink.seek(position)
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn another_group_gets_what_all_others_have() {
        for (mode, expected) in [
            (0o600, 0o600),
            (0o640, 0o600),
            (0o660, 0o600),
            (0o664, 0o644),
            (0o666, 0o666),
            (0o644, 0o644),
            (0o754, 0o744),
            (0o707, 0o707),
        ] {
            assert_eq!(of_other_group(mode), expected, "{mode:o}");
        }
    }
}
