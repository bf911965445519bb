//! Watches a file and reads its content after each change.
//!
//! The folder is watched rather than the file: many editors save by writing another file and
//! renaming it, which removes the old file together with its watch. For a symbolic link, the folder
//! of the link's target is watched as well.
//!
//! Events come in bursts, so the file is read after a short time without events. Two crates extend
//! notify by such a delay, but neither is used. notify-debouncer-mini does not report the kind of
//! an event. Events that are caused by reading the file could then not be ignored, and each would
//! cause another reading. notify-debouncer-full mainly tracks renamed files, which is not needed.
//!
//! In addition, the file's time, length and identity are checked once a second. This detects
//! changes that cause no event: in folders on other machines, in folders that were removed and
//! created again, and if the system's number of watches is exhausted.
//!
//! A save is recognized by the file's time, length and identity, not only by its text, because
//! people who save an unchanged text expect a reaction. Other changes that an editor makes to a
//! file after writing it, such as changed permissions, affect none of these three.

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

/// Time without events from the file system after which a changed file is read. An editor causes
/// several events within a few milliseconds when it saves. With a shorter time, the file would be
/// read for each of them; a longer time would delay the picture.
const QUIET_TIME: Duration = Duration::from_millis(10);

/// Maximum time from the first event of a change to reading the file. The file is then read even if
/// events still arrive. A user who saves hardly notices a delay of 200 ms.
const LONGEST_BURST: Duration = Duration::from_millis(200);

/// Time without events after which a missing or empty file is reported as missing or empty. Until
/// then, a program may be saving the file: some programs empty or remove a file before they write
/// the new content.
const ABSENCE: Duration = Duration::from_millis(300);

/// Maximum time to wait until a missing or empty file has content, even if events still arrive. Two
/// seconds are longer than a usual save, but short enough to tell the user soon that the file is
/// missing.
const LONGEST_ABSENCE: Duration = Duration::from_secs(2);

/// Time between two checks for changes that caused no event. A check reads only the file's
/// metadata, so it costs nearly nothing; a longer time would delay the picture.
const POLL_INTERVAL: Duration = Duration::from_secs(1);

/// The content of a file after a change.
#[derive(Debug)]
pub struct FileContent {
    /// The file's bytes, or the error that occurred when they were read.
    pub bytes: io::Result<Vec<u8>>,
    /// Time at which the change of the file was noticed.
    pub since: Instant,
}

/// Watches a file until the returned slot is closed or dropped. The file's content is put into the
/// slot at once and after each save, even if the text is unchanged.
///
/// The function `read` reads the file. It must not wait, as it would on a pipe, because no changes
/// are noticed meanwhile; [`files::open`] rejects pipes.
///
/// # Errors
///
/// Returns an error if the watcher's thread cannot be started.
pub fn watch(
    path: &Path,
    read: impl Fn(&Path) -> io::Result<Vec<u8>> + Send + 'static,
) -> notify::Result<Arc<Latest<FileContent>>> {
    let (sender, events) = mpsc::channel();
    let own_sender = sender.clone();
    let notifier = notify::recommended_watcher(move |event| {
        // If the watching thread has ended, the event is dropped.
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
    /// Source of the events; `None` if the system cannot watch files.
    notifier: Option<RecommendedWatcher>,
    events: Receiver<notify::Result<Event>>,
    /// Sender that keeps the channel of events open if there is no notifier. On a closed channel,
    /// waiting would return at once.
    _sender: Sender<notify::Result<Event>>,
    /// Folders that are watched at present.
    folders: BTreeSet<PathBuf>,
    /// File names whose events concern the watched file: its own name and, for a symbolic link, the
    /// name of the link's target.
    names: Vec<OsString>,
    /// Time, length and identity of the file when it was last read; `None` if they were unknown.
    stamp: Option<Stamp>,
    /// Content that was last read, or the message of the error that prevented reading. `None`
    /// before the first reading.
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
                // Events about other files are skipped. But the check once a second must be made
                // even while such events keep arriving.
                Ok(_) if since < next_look => continue,
                _ => {
                    next_look = since + POLL_INTERVAL;
                    if stamp(&self.path) == self.stamp {
                        // The folders may have changed: a removed folder may exist again, or a link
                        // may have a new target.
                        self.follow();
                        continue;
                    }
                    // The file has changed without an event. Either a watched folder was removed,
                    // and its watch with it, or the folder does not report events. So all folders
                    // are watched anew.
                    self.forget_folders();
                }
            }
            self.follow();
            self.look(since, &latest);
        }
    }

    /// Returns whether an event may have changed the file's content.
    fn concerns(&self, event: &notify::Result<Event>) -> bool {
        let Ok(event) = event else {
            return true;
        };
        let written = AccessKind::Close(AccessMode::Write);
        match event.kind {
            // Opening and reading a file cause events, too. They are ignored, except the event that
            // a file was closed after writing.
            EventKind::Access(access) if access != written => false,
            _ if event.need_rescan() => true,
            _ => event.paths.iter().any(|path| {
                let name = path.file_name();
                self.names.iter().any(|ours| name == Some(ours))
            }),
        }
    }

    /// Waits until no event has arrived for [`QUIET_TIME`], but at most for [`LONGEST_BURST`].
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

    /// Watches the folders in which the file is now, and stops watching others. If a folder cannot
    /// be watched, the check once a second notices changes.
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

    /// Reads the file. If the file was saved since the last reading, puts its content into the
    /// slot.
    fn look(&mut self, since: Instant, latest: &Latest<FileContent>) {
        let (stamp, bytes) = self.read_when_still();
        let read = match &bytes {
            Ok(bytes) => Ok(bytes.clone()),
            Err(error) => Err(error.to_string()),
        };
        // The content is compared as well. If the clock is coarse, or if the file's time was set
        // back, a save may leave the time, length and identity of the file unchanged.
        if stamp != self.stamp || self.last_read.as_ref() != Some(&read) {
            self.stamp = stamp;
            self.last_read = Some(read);
            latest.put(FileContent { bytes, since });
        }
    }

    /// Reads the file's content, and returns it with the time, length and identity that the file
    /// had before. If the file was written while it was read, reads it again: otherwise, the next
    /// check would find a new time and report another save.
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

    /// Reads the file's content, and returns it with the time, length and identity that the file
    /// had before. If the file is missing or empty, reads it again until it has content. Returns
    /// the last result, even without content, if no event arrives for [`ABSENCE`], or after
    /// [`LONGEST_ABSENCE`]. The very first reading is not repeated.
    fn read_when_there(&self) -> (Option<Stamp>, io::Result<Vec<u8>>) {
        let start = Instant::now();
        let mut end = start + ABSENCE;
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
                end = (Instant::now() + ABSENCE).min(start + LONGEST_ABSENCE);
            }
        }
    }
}

/// Returns the folders to watch for a file, and the file's names in these folders. For a symbolic
/// link, includes the folder and the name of its target.
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

/// Returns the canonical path of a file's folder. The system watches a folder only once. If a
/// folder had two paths, removing one watch would also remove the other.
fn folder(path: &Path) -> PathBuf {
    let folder = files::folder(path);
    // A folder that does not exist has no canonical path.
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
}

/// Data of a file that change when the file is saved: modification time, length, and the identity
/// that the file system gives the file.
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
        // Tests run in the folder of the package, so this is the path of the package's folder.
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
