//! The host that serves the page: who connects is let in by [`Access`] and gets a file or a conversation.

use std::{
    io, mem,
    net::{Ipv4Addr, TcpListener, TcpStream},
    sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc::Sender},
    thread,
    time::Duration,
};

use serde_json::json;

use super::{
    access::{Access, Answer},
    http::{self, Request, Response},
    page::{Event, converse, notification},
    scene_file::{NotSaved, SceneFile},
};

/// So many connections are served at once. A page has one, and for a moment one for each of its files.
const MOST: usize = 64;

/// Who does not take what is sent to it in this time is gone.
const PATIENCE: Duration = Duration::from_secs(10);

/// A page that is served on this machine, and a scene that it edits.
#[derive(Debug)]
pub struct Host {
    listener: TcpListener,
    access: Access,
    pages: Arc<Pages>,
}

impl Host {
    /// Listens at a port, or at any one that is free if it is 0. Nobody but this machine reaches it.
    ///
    /// # Errors
    ///
    /// The port is taken, or the system has no randomness to give.
    pub fn new(port: u16, file: SceneFile) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let access = Access::new(listener.local_addr()?.port())?;
        let pages = Arc::new(Pages(Mutex::new(Shared {
            file,
            pages: Vec::new(),
            joined: 0,
        })));
        pages.watch();
        Ok(Self {
            listener,
            access,
            pages,
        })
    }

    /// The address that lets a browser in.
    pub fn address(&self) -> String {
        self.access.address()
    }

    /// Serves until `wait` returns; what is being saved then is saved, and nothing more.
    ///
    /// # Errors
    ///
    /// There is no thread to do it.
    pub fn serve(self, wait: impl FnOnce()) -> io::Result<()> {
        let pages = Arc::clone(&self.pages);
        thread::Builder::new()
            .name("studio".to_owned())
            .spawn(move || self.accept())?;
        wait();
        // Whoever would save something waits for this lock until the process ends.
        mem::forget(pages.lock());
        Ok(())
    }

    fn accept(self) {
        let access = Arc::new(self.access);
        let served = Arc::new(());
        loop {
            let Ok((stream, _)) = self.listener.accept() else {
                // As when no more files can be open: somebody will close one.
                thread::sleep(Duration::from_millis(20));
                continue;
            };
            let place = Arc::clone(&served);
            let is_full = Arc::strong_count(&served) > MOST + 1;
            let (access, pages) = (Arc::clone(&access), Arc::clone(&self.pages));
            let serve = move || {
                // Of one that breaks there is nothing to say, and nobody to say it to.
                let _ = answer(stream, is_full, &access, &pages);
                drop(place);
            };
            // Where no thread can be started, the connection is closed.
            let _ = thread::Builder::new()
                .name("connection".to_owned())
                .spawn(serve);
        }
    }
}

/// Serves one connection.
fn answer(
    mut stream: TcpStream,
    is_full: bool,
    access: &Access,
    pages: &Arc<Pages>,
) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_write_timeout(Some(PATIENCE))?;
    if is_full {
        let refused = Response::text("503 Service Unavailable", "There are too many pages.");
        return refused.end(stream);
    }
    let Some(request) = Request::read(&mut stream) else {
        return Response::text("400 Bad Request", "This is no request.").end(stream);
    };
    match access.answer(&request) {
        Answer::Response(response) => response.end(stream),
        Answer::Socket(key) => {
            http::accept_socket(&mut stream, &key)?;
            converse(stream, request.rest, pages)
        }
    }
}

/// The pages that are open, and the file that they share.
#[derive(Debug)]
pub struct Pages(Mutex<Shared>);

#[derive(Debug)]
struct Shared {
    file: SceneFile,
    pages: Vec<(u64, Sender<Event>)>,
    /// How many pages there were.
    joined: u64,
}

impl Pages {
    /// Adds a page, which is told about the file. Returns its number.
    pub fn join(&self, sender: Sender<Event>) -> u64 {
        let mut shared = self.lock();
        shared.joined += 1;
        let number = shared.joined;
        shared.pages.push((number, sender));
        let file = shared.about_file();
        shared.tell(&file, |page| page == number);
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
        let is_known = shared.file.text() == Some(text);
        shared.file.save(text, base, name)?;
        if was_new {
            let message = shared.about_file();
            shared.tell(&message, |_| true);
        } else if !is_known {
            let message = shared.about_text();
            shared.tell(&message, |page| page != number);
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
                // What was seen may be older than what a page has saved since.
                if shared.file.look() {
                    let message = shared.about_text();
                    shared.tell(&message, |_| true);
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
    fn about_file(&self) -> String {
        let name = self.file.name();
        let params = json!({
            "name": name,
            "text": self.file.text(),
            "uri": uri(&name),
            "saved": self.file.path().is_some(),
        });
        notification("studio/file", params)
    }

    fn about_text(&self) -> String {
        notification("studio/changed", json!({ "text": self.file.text() }))
    }

    fn tell(&self, message: &str, is_meant: impl Fn(u64) -> bool) {
        for (_, sender) in self.pages.iter().filter(|(page, _)| is_meant(*page)) {
            // One that has gone is about to leave.
            let _ = sender.send(Event::Tell(message.to_owned()));
        }
    }
}

/// What the conversation calls the text. Where its folder is does not matter to a page.
fn uri(name: &str) -> String {
    let escaped = name.bytes().map(|byte| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => {
            char::from(byte).to_string()
        }
        _ => format!("%{byte:02X}"),
    });
    format!("studio:///{}", escaped.collect::<String>())
}
