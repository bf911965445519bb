//! The one writer: files are written whole or not at all, and only where they are meant to go.

use std::{
    fs::{self, File, Metadata, OpenOptions},
    io::{self, BufWriter, Cursor, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

use tempfile::{Builder, NamedTempFile};

use super::{
    exchange, in_place,
    kind::{self, Kind, folder, without_waiting},
    original::{Original, changed},
    temporary::{self, locked},
    words::in_words,
};

/// What a file's content is written to.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// What a file is written for, which says what may be at its path.
#[derive(Clone, Copy, Debug)]
pub enum Purpose<'a> {
    /// It has a name that somebody gave: what is there is replaced, a link is followed, and a pipe
    /// or a device gets the content once it is complete.
    Named,
    /// It has a name of our own in this folder, or below it: a file is replaced, also one that a
    /// link there leads to, but none outside of the folder.
    Within(&'a Path),
    /// The same, if there still is what was read, or still nothing.
    Again {
        /// The folder.
        within: &'a Path,
        /// What was read.
        original: &'a Original,
    },
    /// The same as `Within`, and no other user can read it.
    Private(&'a Path),
    /// It is new: whatever is there stays.
    New,
    /// The text of a file is changed, if it still is what was read; a link is followed.
    Change(&'a Original),
}

impl<'a> Purpose<'a> {
    /// The folder that it must not lead out of.
    fn outer(self) -> Option<&'a Path> {
        match self {
            Self::Within(outer) | Self::Private(outer) | Self::Again { within: outer, .. } => {
                Some(outer)
            }
            Self::Named | Self::New | Self::Change(_) => None,
        }
    }

    /// What must still be there.
    fn original(self) -> Option<&'a Original> {
        match self {
            Self::Change(original) | Self::Again { original, .. } => Some(original),
            Self::Named | Self::Within(_) | Self::Private(_) | Self::New => None,
        }
    }
}

/// Has `write` write the content of the file at `path`, which stays as it was until the new content
/// is complete.
///
/// The content goes into a temporary file in the same folder, which then takes the place of the old
/// one, with its permissions and, where that is allowed, its owner; but it never runs as its owner
/// (setuid). A hard link is cut: its other names keep the old content. Where the text of a file is
/// changed that cannot be replaced so, it is written in place, with a complete copy elsewhere
/// meanwhile. When `cancel` is set, or an error occurs, the temporary file is removed; where this
/// process is killed, the next one that writes the file does it.
pub fn write(
    path: &Path,
    purpose: Purpose<'_>,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    write_at_once(path, purpose, cancel, write).map_err(|error| told(path, error))
}

fn write_at_once(
    path: &Path,
    purpose: Purpose<'_>,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let place = match place(path, purpose)? {
        Place::File(place) => place,
        Place::Stream => return write_device(path, cancel, write),
    };
    let Purpose::Change(original) = purpose else {
        return replace(&place, purpose, cancel, write);
    };
    let mut content = Checked {
        sink: Cursor::new(Vec::new()),
        cancel,
    };
    write(&mut content)?;
    let content = content.sink.into_inner();
    let replaced = replace(&place, purpose, cancel, |out| out.write_all(&content));
    match replaced {
        Err(error) if place.found.is_some() && in_place::is_reason(&error) => {
            in_place::write_in_place(&place.path, original, &content, error)
        }
        replaced => replaced,
    }
}

/// Has `write` write a stream, such as standard output, until `cancel` is set. What was written by
/// then cannot be taken back.
pub fn write_stream(
    sink: impl Write,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, Checked { sink, cancel });
    write(&mut out)?;
    out.flush()
}

/// Whether a file could be written at `path`, as far as one can tell beforehand: nobody wants to
/// learn it after a long render.
pub fn check_writable(path: &Path, purpose: Purpose<'_>) -> io::Result<()> {
    let is_writable = match place(path, purpose) {
        Ok(Place::File(place)) => temporary(&place, purpose).and_then(NamedTempFile::close),
        Ok(Place::Stream) => Ok(()),
        Err(error) => Err(error),
    };
    is_writable.map_err(|error| told(path, error))
}

/// Why nothing can be written at a path, in words.
fn told(path: &Path, error: io::Error) -> io::Error {
    match error.kind() {
        kind @ io::ErrorKind::NotFound if !folder(path).exists() => {
            io::Error::new(kind, "there is no such folder")
        }
        _ => in_words(error),
    }
}

/// Where the content goes.
enum Place {
    File(FilePlace),
    /// A pipe or a device, which must not be replaced.
    Stream,
}

/// A file that is made or replaced, behind all links, and what there is to know about the one that
/// exists already.
struct FilePlace {
    path: PathBuf,
    found: Option<Metadata>,
}

fn place(path: &Path, purpose: Purpose<'_>) -> io::Result<Place> {
    if matches!(purpose, Purpose::New) {
        let path = path.to_owned();
        return match fs::symlink_metadata(&path) {
            Ok(_) => Err(exists()),
            Err(_) => Ok(Place::File(FilePlace { path, found: None })),
        };
    }
    let place = behind_links(path)?;
    match &place {
        Place::Stream if matches!(purpose, Purpose::Named) => {}
        Place::Stream => return Err(Kind::of(&fs::metadata(path)?).refused()),
        Place::File(place) => {
            check_folder(place, purpose)?;
            let is_there = place.found.is_some();
            let original = purpose.original().map(Original::bytes);
            if original.is_some_and(|bytes| bytes.is_some() != is_there) {
                return Err(changed());
            }
        }
    }
    Ok(place)
}

/// Fails if what is written to a place would now lie outside of the folder that it is meant for.
fn check_folder(place: &FilePlace, purpose: Purpose<'_>) -> io::Result<()> {
    let Some(outer) = purpose.outer() else {
        return Ok(());
    };
    let inner = fs::canonicalize(folder(&place.path))?;
    match inner.starts_with(fs::canonicalize(outer)?) {
        true => Ok(()),
        false => {
            let message = "a link leads out of its folder from there";
            Err(io::Error::new(io::ErrorKind::InvalidInput, message))
        }
    }
}

fn behind_links(path: &Path) -> io::Result<Place> {
    match fs::metadata(path) {
        Ok(found) => match Kind::of(&found) {
            Kind::File => {
                // Replacing a file only takes the right to write to its folder; not to touch a file
                // that is write-protected is what its owner expects.
                without_waiting(OpenOptions::new().write(true)).open(path)?;
                Ok(Place::File(FilePlace {
                    path: fs::canonicalize(path)?,
                    found: Some(found),
                }))
            }
            Kind::Pipe | Kind::Device => Ok(Place::Stream),
            kind => Err(kind.refused()),
        },
        Err(error) if error.kind() == io::ErrorKind::NotFound => match fs::read_link(path) {
            // A link to nothing: the file that it would create. Links in a circle are another
            // error.
            Ok(target) => behind_links(&folder(path).join(target)),
            Err(_) => Ok(Place::File(FilePlace {
                path: path.to_owned(),
                found: None,
            })),
        },
        Err(error) => Err(error),
    }
}

/// Writes a temporary file, and has it take its place.
fn replace(
    place: &FilePlace,
    purpose: Purpose<'_>,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    let temporary = temporary(place, purpose)?;
    // Not the temporary file itself, whose errors would name it.
    let sink = temporary.as_file();
    let mut out = BufWriter::with_capacity(1 << 16, Checked { sink, cancel });
    write(&mut out)?;
    out.flush()?;
    drop(out);
    // Only now it is known that there was room for all of it.
    temporary.as_file().sync_all()?;
    check(cancel)?;
    check_folder(place, purpose)?;
    // While the content was written, others may have changed what was found before.
    let (must_be_new, refused) = match purpose.original() {
        Some(original) if original.bytes().is_some() => {
            return exchange::replace(temporary, &place.path, original);
        }
        Some(_) => (true, changed()),
        None => (matches!(purpose, Purpose::New), exists()),
    };
    let persisted = match must_be_new {
        true => temporary.persist_noclobber(&place.path),
        false => temporary.persist(&place.path),
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

/// Writes to a pipe or a device. Nobody is waited for to open the other end, and what comes after
/// that is up to whoever did.
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
            |error| match fs::metadata(path).map(|found| Kind::of(&found)) {
                Ok(Kind::Pipe) if error.kind() != io::ErrorKind::PermissionDenied => {
                    io::Error::new(error.kind(), "it is a pipe that nobody reads")
                }
                _ => error,
            },
        )?;
    match Kind::of(&device.metadata()?) {
        Kind::Pipe | Kind::Device => {}
        kind => return Err(io::Error::other(format!("it has become {kind}"))),
    }
    kind::wait_for_it(&device)?;
    device.write_all(content.sink.get_ref())?;
    device.flush()
}

/// What the name of a temporary file ends in.
const SUFFIX: &str = ".tmp";

/// A temporary file for a place.
fn temporary(place: &FilePlace, purpose: Purpose<'_>) -> io::Result<NamedTempFile> {
    let FilePlace { path, found } = place;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // In most systems a name has at most 255 bytes, of which each character may take four.
    let name: String = name.chars().take(50).collect();
    let prefix = format!(".pinhole-{name}-");
    remove_leftovers(folder(path), &prefix);
    // What nothing else is said of, no other user can read.
    let is_private = matches!(purpose, Purpose::Private(_));
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    if found.is_none() && !is_private {
        // The usual permissions of a new file: the system takes the mask off.
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

/// Removes temporary files of processes that were killed. It is no matter if that fails.
fn remove_leftovers(folder: &Path, prefix: &str) {
    // Each stays locked until it is gone: nobody can begin to write to it.
    for (name, _lock) in temporary::left(folder, prefix, SUFFIX) {
        let _ = fs::remove_file(folder.join(name));
    }
}

/// Gives a file the owner and the permissions of another one, as far as the system allows that.
/// Only root may give files away, and others may give them to their own groups.
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
    // Another group may do no more than everybody.
    let allowed = match has_group {
        true => mode,
        false => mode & (0o707 | mode << 3),
    };
    file.set_permissions(Permissions::from_mode(allowed))
}

#[cfg(not(unix))]
fn keep_owner(file: &File, found: &Metadata) -> io::Result<()> {
    file.set_permissions(found.permissions())
}

/// A sink that fails once the flag is set.
struct Checked<'a, S> {
    sink: S,
    cancel: &'a AtomicBool,
}

fn check(cancel: &AtomicBool) -> io::Result<()> {
    if cancel.load(Ordering::Relaxed) {
        // Not `Interrupted`, which means "try again" to whoever writes.
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
