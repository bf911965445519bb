//! The content of a file, and its changes.
//!
//! The folder is watched, not the file: many editors save by writing another file and renaming it,
//! which removes the old file together with a watch on it. For a symbolic link, the folder of its
//! target is watched as well.
//!
//! Events come in bursts, so the file is read after a short time without events. (notify's own
//! debouncers do that, too; but the small one drops the kind of an event, and would be woken by our
//! own reading, and the large one tracks renamed files, which is not needed here.) Once a second
//! the file's time and length are checked in any case: for folders without events, such as those on
//! other machines, for systems that have no watches left, and for folders that come and go.
//!
//! A save is recognised by the file's time, its length and its identity, and not by the text alone:
//! people who save an unchanged text want to see something happen. Whatever else an editor does to
//! a file after writing it changes none of these.

use std::{
    collections::BTreeSet,
    ffi::{OsStr, OsString},
    fs, io,
    path::{Path, PathBuf},
    sync::{
        Arc, Weak,
        mpsc::{self, Receiver, Sender},
    },
    thread,
    time::{Duration, Instant, SystemTime},
};

use notify::{
    Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher as _,
    event::{AccessKind, AccessMode},
};

use super::Latest;
use crate::files;

/// Time without events after which the file is read.
const QUIET_TIME: Duration = Duration::from_millis(10);

/// Maximum time from the first event to reading the file, if events do not stop.
const LONGEST_BURST: Duration = Duration::from_millis(200);

/// Time within which a file that is gone or empty, which is probably being saved, is expected back.
const ABSENCE: Duration = Duration::from_millis(300);

/// Time between two checks of the file without an event.
const POLL_INTERVAL: Duration = Duration::from_secs(1);

/// The content of a file.
#[derive(Debug)]
pub struct FileContent {
    /// The bytes, or why they cannot be read.
    pub bytes: io::Result<Vec<u8>>,
    /// When the change was noticed.
    pub since: Instant,
}

/// Watches a file until the returned slot ends or is dropped. `read` must not wait for other
/// processes ([`files::open`]). The first content is available at once, and another one whenever
/// the file was saved, even with unchanged text.
///
/// # Errors
///
/// The thread of the watcher cannot be started.
pub fn watch(
    path: &Path,
    read: impl Fn(&Path) -> io::Result<Vec<u8>> + Send + 'static,
) -> notify::Result<Arc<Latest<FileContent>>> {
    let (sender, events) = mpsc::channel();
    let own_sender = sender.clone();
    let notifier = notify::recommended_watcher(move |event| {
        // If nobody listens any more, the event is dropped.
        let _ = sender.send(event);
    });
    let mut watcher = Watcher {
        path: path.to_owned(),
        read,
        notifier: notifier.ok(),
        events,
        _sender: own_sender,
        folders: BTreeSet::new(),
        names: Vec::new(),
        stamp: None,
        last_read: None,
    };
    watcher.follow();
    let latest = Arc::new(Latest::default());
    watcher.look(Instant::now(), &latest);
    let weak = Arc::downgrade(&latest);
    thread::Builder::new()
        .name("watcher".to_owned())
        .spawn(move || watcher.run(&weak))
        .map_err(notify::Error::io)?;
    Ok(latest)
}

struct Watcher<R> {
    path: PathBuf,
    read: R,
    /// `None` if the system cannot watch.
    notifier: Option<RecommendedWatcher>,
    events: Receiver<notify::Result<Event>>,
    /// Keeps the channel of events open if there is no notifier.
    _sender: Sender<notify::Result<Event>>,
    /// The watched folders.
    folders: BTreeSet<PathBuf>,
    /// Names of the file in these folders.
    names: Vec<OsString>,
    /// Stamp of the file when it was last read.
    stamp: Option<Stamp>,
    /// Content that was last read; for an error, its message.
    last_read: Option<Result<Vec<u8>, String>>,
}

impl<R: Fn(&Path) -> io::Result<Vec<u8>>> Watcher<R> {
    fn run(mut self, latest: &Weak<Latest<FileContent>>) {
        let mut next_look = Instant::now() + POLL_INTERVAL;
        loop {
            let left = next_look.saturating_duration_since(Instant::now());
            let event = self.events.recv_timeout(left);
            let since = Instant::now();
            let Some(latest) = latest.upgrade().filter(|latest| !latest.is_over()) else {
                return;
            };
            match event {
                Ok(event) if self.concerns(&event) => self.settle(),
                // However many other events there are, the file is checked once a second.
                Ok(_) if since < next_look => continue,
                _ => {
                    next_look = since + POLL_INTERVAL;
                    if stamp(&self.path) == self.stamp {
                        // A folder may be back, or a link may have a new target.
                        self.follow();
                        continue;
                    }
                    // The file has changed without an event: a watched folder is gone, or reports
                    // nothing.
                    self.forget_folders();
                }
            }
            self.follow();
            self.look(since, &latest);
        }
    }

    /// Whether an event may have changed the file's content.
    fn concerns(&self, event: &notify::Result<Event>) -> bool {
        let Ok(event) = event else {
            return true;
        };
        let written = AccessKind::Close(AccessMode::Write);
        match event.kind {
            // Reading, also by ourselves.
            EventKind::Access(access) if access != written => false,
            _ if event.need_rescan() => true,
            _ => event.paths.iter().any(|path| {
                let name = path.file_name();
                self.names.iter().any(|ours| name == Some(ours))
            }),
        }
    }

    /// Waits until there was no event for a short time.
    fn settle(&self) {
        let start = Instant::now();
        let mut quiet = start + QUIET_TIME;
        loop {
            let now = Instant::now();
            if now >= quiet || now - start >= LONGEST_BURST {
                return;
            }
            if let Ok(event) = self.events.recv_timeout(quiet - now)
                && self.concerns(&event)
            {
                quiet = Instant::now() + QUIET_TIME;
            }
        }
    }

    /// Watches the folders that matter now. A folder that cannot be watched is checked once a
    /// second.
    fn follow(&mut self) {
        let (folders, names) = places(&self.path);
        self.names = names;
        let Some(notifier) = &mut self.notifier else {
            return;
        };
        for old in self.folders.difference(&folders) {
            let _ = notifier.unwatch(old);
        }
        self.folders.retain(|folder| folders.contains(folder));
        for folder in folders {
            let is_new = !self.folders.contains(&folder);
            if is_new && notifier.watch(&folder, RecursiveMode::NonRecursive).is_ok() {
                self.folders.insert(folder);
            }
        }
    }

    fn forget_folders(&mut self) {
        for folder in std::mem::take(&mut self.folders) {
            if let Some(notifier) = &mut self.notifier {
                let _ = notifier.unwatch(&folder);
            }
        }
    }

    /// Reads the file, and puts its content into the slot if it was saved since it was last read.
    fn look(&mut self, since: Instant, latest: &Latest<FileContent>) {
        let (stamp, bytes) = self.read_when_still();
        let read = match &bytes {
            Ok(bytes) => Ok(bytes.clone()),
            Err(error) => Err(error.to_string()),
        };
        // If a clock ticks slowly, or a file's time was set back, only the text tells.
        if stamp != self.stamp || self.last_read.as_ref() != Some(&read) {
            self.stamp = stamp;
            self.last_read = Some(read);
            latest.put(FileContent { bytes, since });
        }
    }

    /// Reads the file's content with its stamp. If the file was written meanwhile, it is read
    /// again: with the old stamp, a save that was already read would be taken for another one.
    fn read_when_still(&self) -> (Option<Stamp>, io::Result<Vec<u8>>) {
        let end = Instant::now() + LONGEST_BURST;
        loop {
            let (before, bytes) = self.read_when_there();
            let after = stamp(&self.path);
            if before == after || Instant::now() >= end {
                return (before, bytes);
            }
            self.settle();
        }
    }

    /// Reads the file's content, with the stamp that it had before.
    fn read_when_there(&self) -> (Option<Stamp>, io::Result<Vec<u8>>) {
        let end = Instant::now() + ABSENCE;
        loop {
            let stamp = stamp(&self.path);
            let bytes = (self.read)(&self.path);
            let is_there = match &bytes {
                Ok(bytes) => !bytes.is_empty(),
                Err(error) => error.kind() != io::ErrorKind::NotFound,
            };
            let left = end.saturating_duration_since(Instant::now());
            if is_there || left.is_zero() || self.last_read.is_none() {
                return (stamp, bytes);
            }
            if let Ok(event) = self.events.recv_timeout(left.min(QUIET_TIME))
                && self.concerns(&event)
            {
                self.settle();
            }
        }
    }
}

/// Returns the folders to watch for a file, and its names in them.
fn places(path: &Path) -> (BTreeSet<PathBuf>, Vec<OsString>) {
    let mut folders = BTreeSet::new();
    let mut names = BTreeSet::new();
    let end = fs::canonicalize(path).ok();
    for path in [Some(path), end.as_deref()].into_iter().flatten() {
        folders.insert(folder(path));
        names.extend(path.file_name().map(OsStr::to_owned));
    }
    (folders, names.into_iter().collect())
}

/// Returns the folder of a file by its canonical name: the system watches a folder once, so that
/// removing the watch of one of two names would remove that of the other.
fn folder(path: &Path) -> PathBuf {
    let folder = files::folder(path);
    // A folder that is gone keeps the name by which it was given.
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
}

/// What changes when a file is saved: its time, its length, or its identity.
type Stamp = (SystemTime, u64, files::FileId);

fn stamp(path: &Path) -> Option<Stamp> {
    let found = fs::metadata(path).ok()?;
    Some((found.modified().ok()?, found.len(), files::id(&found)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_has_one_name_whether_its_file_is_there_or_not() {
        // Tests run in the folder of the package.
        let here = fs::canonicalize(".").unwrap();
        for path in [
            "Cargo.toml",
            "./Cargo.toml",
            "src/../Cargo.toml",
            "gone.scn",
        ] {
            let (folders, _) = places(Path::new(path));
            assert!(folders.iter().eq([&here]), "{path}: {folders:?}");
        }
    }
}
