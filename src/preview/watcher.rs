//! Which content a file has, and when it changes.
//!
//! It is the folder that is watched: many editors save by writing another file and renaming it, and
//! the file that was there before is gone then, with whatever watched it. Of a symbolic link, the
//! folder of the file at its end is watched as well.
//!
//! Events come in bursts, so the file is read once there was none for a moment. (notify's own
//! debouncers do that too, but the small one forgets what kind an event is, and would be woken by
//! our own reading, and the large one keeps books on files that were renamed, which nobody asks for
//! here.) Once a second the file's time and length are looked at in any case, for folders without
//! events, such as those on other machines, or where the system has no watch left, and for those
//! that come and go.
//!
//! A save is told by the file's time, its length and which file it is, and not by the text alone:
//! who saves the text that was there wants to see something happen. Whatever else an editor does to
//! a file that it has written changes none of them.

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

/// A file is read when it was left alone for so long.
const QUIET: Duration = Duration::from_millis(10);

/// But no later than this, should it never be left alone.
const LONGEST_BURST: Duration = Duration::from_millis(200);

/// A file that is gone, or empty, is most likely being saved: it has so long to come back.
const ABSENCE: Duration = Duration::from_millis(300);

/// How often the file is looked at without an event.
const ANYWAY: Duration = Duration::from_secs(1);

/// What a file holds.
#[derive(Debug)]
pub struct Content {
    /// Its bytes, or why they cannot be had.
    pub bytes: io::Result<Vec<u8>>,
    /// When it was seen to change.
    pub since: Instant,
}

/// Watches a file, which is read by `read` without waiting for anybody ([`files::open`]), until
/// what is returned ends or is dropped. The first content is there at once; after that there is one
/// whenever the file was saved, be it with the text that it had.
pub fn watch(
    path: &Path,
    read: impl Fn(&Path) -> io::Result<Vec<u8>> + Send + 'static,
) -> notify::Result<Arc<Latest<Content>>> {
    let (sender, events) = mpsc::channel();
    let own_sender = sender.clone();
    let notifier = notify::recommended_watcher(move |event| {
        // Where nobody listens any more, there is nothing to tell.
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
        seen: None,
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
    /// None where the system has none to give.
    notifier: Option<RecommendedWatcher>,
    events: Receiver<notify::Result<Event>>,
    /// It keeps the events open where nobody sends any.
    _sender: Sender<notify::Result<Event>>,
    /// The folders that are watched.
    folders: BTreeSet<PathBuf>,
    /// What the file is called in them.
    names: Vec<OsString>,
    /// What was seen of it from outside when it was read last.
    stamp: Option<Stamp>,
    /// What was read last; of an error, its words.
    seen: Option<Result<Vec<u8>, String>>,
}

impl<R: Fn(&Path) -> io::Result<Vec<u8>>> Watcher<R> {
    fn run(mut self, latest: &Weak<Latest<Content>>) {
        let mut next_look = Instant::now() + ANYWAY;
        loop {
            let left = next_look.saturating_duration_since(Instant::now());
            let event = self.events.recv_timeout(left);
            let since = Instant::now();
            let Some(latest) = latest.upgrade().filter(|latest| !latest.is_over()) else {
                return;
            };
            match event {
                Ok(event) if self.concerns(&event) => self.settle(),
                // However much happens beside the file, it is looked at once a second.
                Ok(_) if since < next_look => continue,
                _ => {
                    next_look = since + ANYWAY;
                    if stamp(&self.path) == self.stamp {
                        // Perhaps a folder is back, or a link leads elsewhere.
                        self.follow();
                        continue;
                    }
                    // It has changed without an event: what was watched is no longer there, or
                    // never told.
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
            // Also by ourselves.
            EventKind::Access(access) if access != written => false,
            _ if event.need_rescan() => true,
            _ => event.paths.iter().any(|path| {
                let name = path.file_name();
                self.names.iter().any(|ours| name == Some(ours))
            }),
        }
    }

    /// Waits until the file was left alone for a moment.
    fn settle(&self) {
        let start = Instant::now();
        let mut quiet = start + QUIET;
        loop {
            let now = Instant::now();
            if now >= quiet || now - start >= LONGEST_BURST {
                return;
            }
            if let Ok(event) = self.events.recv_timeout(quiet - now)
                && self.concerns(&event)
            {
                quiet = Instant::now() + QUIET;
            }
        }
    }

    /// Watches the folders that matter now. One that cannot be watched is looked at once a second.
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

    /// Reads the file, and hands its content on if it was saved since it was read last.
    fn look(&mut self, since: Instant, latest: &Latest<Content>) {
        let (stamp, bytes) = self.read_when_still();
        let seen = match &bytes {
            Ok(bytes) => Ok(bytes.clone()),
            Err(error) => Err(error.to_string()),
        };
        // Where a clock ticks slowly, or somebody sets a file's time back, the text alone tells.
        if stamp != self.stamp || self.seen.as_ref() != Some(&seen) {
            self.stamp = stamp;
            self.seen = Some(seen);
            latest.put(Content { bytes, since });
        }
    }

    /// The file's content, with the stamp that it has. What was written while it was read is read
    /// again: with the stamp of before, a save that was read already would be taken for another
    /// one.
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

    /// The file's content, with the stamp that it had before it was read.
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
            if is_there || left.is_zero() || self.seen.is_none() {
                return (stamp, bytes);
            }
            if let Ok(event) = self.events.recv_timeout(left.min(QUIET))
                && self.concerns(&event)
            {
                self.settle();
            }
        }
    }
}

/// The folders that matter to a file, and what it is called in them.
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

/// The folder of a file, by one name however the file is named: the system watches a folder once,
/// so that with the watch of one of two names that of the other would end.
fn folder(path: &Path) -> PathBuf {
    let folder = files::folder(path);
    // One that is gone is called as it was named.
    fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned())
}

/// What changes when a file is saved: its time, its length, or which file it is.
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
        // The tests run in the folder of the package.
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
