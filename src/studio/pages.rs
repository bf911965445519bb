//! The pages that are open, and the file that they share: who changes it, and who is told.

use std::{
    mem,
    sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc::Sender},
    thread,
};

use lsp_server::Notification;
use serde_json::json;

use super::scene_file::{NotSaved, SceneFile};
use crate::lsp::messages;

/// The pages that are open, and the file that they share.
#[derive(Debug)]
pub struct Pages(Mutex<Shared>);

#[derive(Debug)]
struct Shared {
    file: SceneFile,
    pages: Vec<(u64, Sender<String>)>,
    /// How many pages there were.
    joined: u64,
}

impl Pages {
    /// No pages yet, and the file.
    pub fn new(file: SceneFile) -> Arc<Self> {
        let pages = Arc::new(Self(Mutex::new(Shared {
            file,
            pages: Vec::new(),
            joined: 0,
        })));
        pages.watch();
        pages
    }

    /// Waits until nothing is being saved; whoever would save something waits from now on, until the process ends.
    pub fn stop(&self) {
        mem::forget(self.lock());
    }

    /// Adds a page, which is told about the file. Returns its number.
    pub fn join(&self, sender: Sender<String>) -> u64 {
        let mut shared = self.lock();
        shared.joined += 1;
        let number = shared.joined;
        shared.pages.push((number, sender));
        shared.tell(|page| page == number);
        number
    }

    /// Forgets a page.
    pub fn leave(&self, number: u64) {
        self.lock().pages.retain(|(page, _)| *page != number);
    }

    /// Saves a page's text, as [`SceneFile::save`] does, and tells the others.
    pub fn save(
        self: &Arc<Self>,
        number: u64,
        text: &str,
        base: Option<&str>,
        name: Option<&str>,
    ) -> Result<(), NotSaved> {
        let mut shared = self.lock();
        let was_new = shared.file.path().is_none();
        let before = shared.file.held().clone();
        shared.file.save(text, base, name)?;
        if was_new || *shared.file.held() != before {
            shared.tell(|page| was_new || page != number);
        }
        drop(shared);
        if was_new {
            self.watch();
        }
        Ok(())
    }

    /// From now on the pages are told when the file changes, if there is one.
    fn watch(self: &Arc<Self>) {
        let watched = self.lock().file.watch();
        // Without a watch, a file that has changed is found when it is saved.
        let Some(latest) = watched else {
            return;
        };
        let pages = Arc::clone(self);
        let follow = move || {
            while latest.take().is_some() {
                let mut shared = pages.lock();
                if shared.file.look() {
                    shared.tell(|_| true);
                }
            }
        };
        let _ = thread::Builder::new().name("file".to_owned()).spawn(follow);
    }

    fn lock(&self) -> MutexGuard<'_, Shared> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Shared {
    /// Tells pages about the file as it is now.
    fn tell(&self, is_meant: impl Fn(u64) -> bool) {
        let held = self.file.held().as_ref();
        let params = json!({
            "name": self.file.name(),
            "text": held.ok(),
            "reason": held.err(),
            "saved": self.file.path().is_some(),
        });
        let message =
            messages::written(&Notification::new("studio/file".to_owned(), params).into());
        for (_, sender) in self.pages.iter().filter(|(page, _)| is_meant(*page)) {
            // One that has gone is about to leave.
            let _ = sender.send(message.clone());
        }
    }
}
