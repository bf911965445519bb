//! The host that serves the page: who connects is let in by [`Access`] and gets a file or a conversation.

use std::{
    io, mem,
    net::{Ipv4Addr, TcpListener, TcpStream},
    sync::{Arc, Mutex},
    thread,
    time::Duration,
};

use super::{
    access::{Access, Answer},
    conversation::converse,
    http::{self, Request, Response},
    scene_file::{SceneFile, lock},
};

/// So many connections are served at once: a page has one, and while it loads one for each of its three files. Each has a thread, and a page threads for its pictures; nobody has so many pages.
const MOST_CONNECTIONS: usize = 64;

/// Who does not take what is sent to it in this time is gone: a browser on this machine takes it at once, unless it is stopped.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);

/// How long it waits until it tries again to accept a connection: less than anybody notices.
const RETRY: Duration = Duration::from_millis(20);

/// A page that is served on this machine, and a scene that it edits.
#[derive(Debug)]
pub struct Host {
    listener: TcpListener,
    access: Access,
    file: Mutex<SceneFile>,
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
        Ok(Self {
            listener,
            access,
            file: Mutex::new(file),
        })
    }

    /// The address that lets a browser in, for the user alone; and one that does so once, for a command line: other users of the machine can read those.
    pub fn addresses(&self) -> [String; 2] {
        self.access.addresses()
    }

    /// Serves until `wait` returns; what is being saved then is saved, and nothing more.
    ///
    /// # Errors
    ///
    /// There is no thread to do it.
    pub fn serve(self, wait: impl FnOnce()) -> io::Result<()> {
        let host = Arc::new(self);
        let accepting = Arc::clone(&host);
        thread::Builder::new()
            .name("studio".to_owned())
            .spawn(move || accepting.accept())?;
        wait();
        // Whoever would save something waits from now on until the process ends, and nobody looks at the file.
        mem::forget(lock(&host.file));
        Ok(())
    }

    fn accept(self: Arc<Self>) {
        // Who has the host: whoever waits for the end, this loop, and each connection.
        let most = MOST_CONNECTIONS + 2;
        loop {
            let Ok((stream, _)) = self.listener.accept() else {
                // As when no more files can be open: somebody will close one, and until then this loop must not keep a processor busy.
                thread::sleep(RETRY);
                continue;
            };
            let host = Arc::clone(&self);
            let is_full = Arc::strong_count(&host) > most;
            // Of one that breaks there is nothing to say, and nobody to say it to.
            let serve = move || drop(host.answer(stream, is_full));
            // Where no thread can be started, the connection is closed.
            let _ = thread::Builder::new()
                .name("connection".to_owned())
                .spawn(serve);
        }
    }

    /// Serves one connection.
    fn answer(&self, mut stream: TcpStream, is_full: bool) -> io::Result<()> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(WRITE_TIMEOUT))?;
        if is_full {
            let refused = Response::text("503 Service Unavailable", "There are too many pages.");
            return refused.end(stream);
        }
        let Some(request) = Request::read(&mut stream) else {
            return Response::text("400 Bad Request", "This is no request.").end(stream);
        };
        match self.access.answer(&request) {
            Answer::Response(response) => response.end(stream),
            Answer::Socket(key) => {
                http::accept_socket(&mut stream, &key)?;
                converse(stream, request.rest, &self.file)
            }
        }
    }
}
