//! Files that are written whole or not at all.

use std::{
    fs::{self, File, Metadata, OpenOptions},
    io::{self, BufWriter, Cursor, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicBool, Ordering},
};

use tempfile::{Builder, NamedTempFile};

/// What a file's content is written to.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Has `write` write the content of the file at `path`, which stays as it was until the new content is complete.
///
/// The content goes into a temporary file in the same folder, which then takes the place of the old one, with its permissions and,
/// where that is allowed, its owner; but it never runs as its owner (setuid). A hard link is cut: its other names keep the old content. Of a
/// symbolic link the target is replaced, not the link. What is not a file (a device, a pipe) gets the content once it is complete.
/// When `cancel` is set, or an error occurs, the temporary file is removed; where this process is killed, the next one that writes the
/// file does it.
pub fn write_whole(
    path: &Path,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
) -> io::Result<()> {
    match place(path)? {
        Some((path, found)) => {
            let temporary = temporary(&path, found.as_ref())?;
            // Not the temporary file itself, whose errors would name it.
            let sink = temporary.as_file();
            let mut out = BufWriter::with_capacity(1 << 16, Checked { sink, cancel });
            write(&mut out)?;
            out.flush()?;
            drop(out);
            // Only now it is known that there was room for all of it.
            temporary.as_file().sync_all()?;
            check(cancel)?;
            temporary.persist(path).map_err(|error| error.error)?;
            Ok(())
        }
        None => {
            let sink = Cursor::new(Vec::new());
            let mut content = Checked { sink, cancel };
            write(&mut content)?;
            let mut device = OpenOptions::new().write(true).open(path)?;
            device.write_all(content.sink.get_ref())?;
            device.flush()
        }
    }
}

/// Has `write` write a stream, such as standard output, until `cancel` is set. What was written by then cannot be taken back.
pub fn write_stream(
    sink: impl Write,
    cancel: &AtomicBool,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, Checked { sink, cancel });
    write(&mut out)?;
    out.flush()
}

/// Whether a file could be written at `path`, as far as one can tell beforehand: nobody wants to learn it after a long render.
pub fn check_writable(path: &Path) -> io::Result<()> {
    match place(path)? {
        Some((path, found)) => temporary(&path, found.as_ref())?.close(),
        None => Ok(()),
    }
}

/// The file that the content is for, and what there is to know about the one that exists already; none if it is something that must not be replaced.
fn place(path: &Path) -> io::Result<Option<(PathBuf, Option<Metadata>)>> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(found) if found.is_file() => {
            // Replacing a file only takes the right to write to its folder; not to touch a file that is write-protected is
            // what its owner expects.
            OpenOptions::new().write(true).open(path)?;
            Ok(Some((fs::canonicalize(path)?, Some(found))))
        }
        Ok(_) => Ok(None),
        Err(error) if error.kind() == io::ErrorKind::NotFound => match fs::read_link(path) {
            // A link to nothing: the file that it would create. Links in a circle are another error.
            Ok(target) => place(&folder(path).join(target)),
            Err(_) => Ok(Some((path.to_owned(), None))),
        },
        Err(error) => Err(error),
    }
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// What the name of a temporary file ends in.
const SUFFIX: &str = ".tmp";

/// A temporary file, locked as long as it is open: what is not locked belongs to nobody.
fn temporary(path: &Path, found: Option<&Metadata>) -> io::Result<NamedTempFile> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // In most systems a name has at most 255 bytes, of which each character may take four.
    let name: String = name.chars().take(50).collect();
    let prefix = format!(".pinhole-{name}-");
    remove_leftovers(folder(path), &prefix);
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    if found.is_none() {
        // The usual permissions of a new file: the system takes the mask off.
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    }
    let temporary = loop {
        let temporary = builder.tempfile_in(folder(path)).map_err(without_path)?;
        // Where the file system has no locks, nobody finds one that is free.
        let _ = temporary.as_file().lock();
        // Before that, another process may have taken it for a leftover.
        if temporary.path().exists() {
            break temporary;
        }
    };
    if let Some(found) = found {
        keep_owner(temporary.as_file(), found)?;
    }
    Ok(temporary)
}

/// Removes temporary files of processes that were killed. It is no matter if that fails.
fn remove_leftovers(folder: &Path, prefix: &str) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_temporary = name
            .to_str()
            .and_then(|name| name.strip_prefix(prefix)?.strip_suffix(SUFFIX))
            .is_some_and(|random| random.len() == 6);
        // Opening something else, a pipe for example, might wait for ever.
        if is_temporary
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && let Ok(file) = File::open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Gives a file the owner and the permissions of another one.
#[cfg(unix)]
fn keep_owner(file: &File, found: &Metadata) -> io::Result<()> {
    use std::{
        fs::Permissions,
        os::unix::fs::{MetadataExt, PermissionsExt, fchown},
    };

    // Only root may give files away, and may edit those of others without taking them over.
    let _ = fchown(file, Some(found.uid()), Some(found.gid()));
    file.set_permissions(Permissions::from_mode(found.mode() & 0o777))
}

#[cfg(not(unix))]
fn keep_owner(file: &File, found: &Metadata) -> io::Result<()> {
    file.set_permissions(found.permissions())
}

/// The system's own words: nobody wants to know what the temporary file would have been called.
fn without_path(error: io::Error) -> io::Error {
    let words = error.to_string();
    match words.split_once(" at path ") {
        Some((words, _)) => io::Error::new(error.kind(), words),
        None => error,
    }
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
