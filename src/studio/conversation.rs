//! The conversation with one page, over a web socket.
//!
//! What a page asks supersedes what it asked before, so all that has come is taken in before the next slice of work. While there is no work, the socket is waited
//! for; the scene's file and the picture that another thread makes are looked at a little later.

use std::{
    io,
    net::TcpStream,
    sync::{
        Arc, Mutex, TryLockError,
        atomic::{AtomicBool, Ordering},
    },
    thread::{self, JoinHandle},
    time::Duration,
};

use lsp_server::{Message, Notification, Request};
use serde_json::{Value, json};
use tungstenite::{
    Error, Message as SocketMessage, Utf8Bytes, WebSocket,
    protocol::{CloseFrame, Role, WebSocketConfig, frame::coding::CloseCode},
};

use super::{
    download,
    scene_file::{NotSaved, SceneFile, lock},
};
use crate::{
    lsp::{
        Refusal, Server,
        messages::{self, Malformed},
        response,
    },
    threads,
};

/// The longest message of a page, in bytes: far more than any text that an editor in a browser can hold, and little enough for memory.
const LONGEST: usize = 64 << 20;

/// How long the socket is waited for before one looks at the file and the picture: less than anybody notices.
const WAIT: Duration = Duration::from_millis(50);

/// Holds the conversation until the page leaves. Some of it may have been read already.
pub fn converse(stream: TcpStream, rest: Vec<u8>, file: &Mutex<SceneFile>) -> io::Result<()> {
    let config = WebSocketConfig::default()
        .read_buffer_size(1 << 14)
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    stream.set_read_timeout(Some(WAIT))?;
    let mut conversation = Conversation {
        socket: WebSocket::from_partially_read(stream, rest, Role::Server, Some(config)),
        server: Server::new(|_| {}),
        file,
        known: 0,
        download: None,
    };
    // On threads that are there for each of its pictures.
    let ended = threads::install(None, || conversation.run()).map_err(io::Error::other)?;
    conversation.cancel(None);
    ended.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

struct Conversation<'a> {
    socket: WebSocket<TcpStream>,
    server: Server,
    /// The file that all pages share.
    file: &'a Mutex<SceneFile>,
    /// The version of it that the page knows.
    known: u64,
    download: Option<Download>,
}

/// A picture's file that is being made.
struct Download {
    request: Value,
    cancel: Arc<AtomicBool>,
    thread: JoinHandle<Message>,
}

impl Conversation<'_> {
    fn run(&mut self) -> Result<(), Error> {
        while self.server.ended().is_none() {
            self.tell_file()?;
            if let Some(done) = self.download.take_if(|it| it.thread.is_finished())
                && let Ok(answer) = done.thread.join()
            {
                self.say(vec![answer])?;
            }
            match self.read() {
                Ok(Some(SocketMessage::Text(text))) => self.hear(&text)?,
                Ok(Some(SocketMessage::Binary(_))) => return self.close(CloseCode::Unsupported),
                Ok(Some(SocketMessage::Close(_))) => break,
                // The socket answers pings by itself.
                Ok(Some(
                    SocketMessage::Ping(_) | SocketMessage::Pong(_) | SocketMessage::Frame(_),
                )) => {}
                Ok(None) => {
                    let messages = self.server.advance();
                    self.say(messages)?;
                }
                Err(Error::Capacity(_)) => return self.close(CloseCode::Size),
                Err(Error::Utf8(_)) => return self.close(CloseCode::Invalid),
                Err(error @ Error::Io(_)) => return Err(error),
                Err(_) => return self.close(CloseCode::Protocol),
            }
        }
        self.close(CloseCode::Normal)
    }

    /// What the page has sent; nothing if there is nothing yet. Where there is work, it is not waited for.
    fn read(&mut self) -> Result<Option<SocketMessage>, Error> {
        self.socket
            .get_ref()
            .set_nonblocking(self.server.is_busy())?;
        let read = self.socket.read();
        self.socket.get_ref().set_nonblocking(false)?;
        match read {
            Err(Error::Io(error)) => match error.kind() {
                io::ErrorKind::WouldBlock
                | io::ErrorKind::TimedOut
                | io::ErrorKind::Interrupted => Ok(None),
                _ => Err(Error::Io(error)),
            },
            read => read.map(Some),
        }
    }

    fn close(&mut self, code: CloseCode) -> Result<(), Error> {
        let reason = Utf8Bytes::default();
        self.socket.close(Some(CloseFrame { code, reason }))
    }

    fn say(&mut self, messages: Vec<Message>) -> Result<(), Error> {
        let mut texts = messages.iter().map(messages::written);
        texts.try_for_each(|text| self.socket.send(SocketMessage::text(text)))
    }

    /// Tells the page about the file, if it is another than the page knows; a little later, while another page has it.
    fn tell_file(&mut self) -> Result<(), Error> {
        let mut file = match self.file.try_lock() {
            Ok(file) => file,
            Err(TryLockError::Poisoned(file)) => file.into_inner(),
            Err(TryLockError::WouldBlock) => return Ok(()),
        };
        let version = file.look();
        if version == self.known {
            return Ok(());
        }
        self.known = version;
        let held = file.held().as_ref();
        let params = json!({
            "name": file.name(),
            "text": held.ok(),
            "reason": held.err(),
            "saved": file.path().is_some(),
        });
        drop(file);
        self.say(vec![
            Notification::new("studio/file".to_owned(), params).into(),
        ])
    }

    fn hear(&mut self, text: &str) -> Result<(), Error> {
        match messages::read(text.as_bytes()) {
            Ok(Message::Request(request)) if request.method.starts_with("studio/") => {
                self.answer(request)
            }
            Ok(message) => {
                if let Message::Notification(Notification { method, params }) = &message
                    && method == "$/cancelRequest"
                {
                    self.cancel(Some(&params["id"]));
                }
                let messages = self.server.handle(message);
                self.say(messages)
            }
            Err(Malformed::Answered(response)) => {
                self.socket.send(SocketMessage::text(response.to_string()))
            }
            Err(Malformed::Unanswered(_)) => Ok(()),
        }
    }

    /// Answers what is asked of the host.
    fn answer(&mut self, request: Request) -> Result<(), Error> {
        if download::is_asked_for(&request) {
            return self.render(request);
        }
        let Request { id, method, params } = request;
        let field = |name| params.get(name).and_then(Value::as_str);
        let answer = match (method.as_str(), field("text")) {
            ("studio/save", Some(text)) => {
                let mut file = lock(self.file);
                let is_new = file.path().is_none();
                match file.save(text, field("base"), field("name")) {
                    Ok(version) => {
                        // What is in it the page knows, but not where a new scene is.
                        if !is_new {
                            self.known = version;
                        }
                        Ok(json!({ "ok": true }))
                    }
                    Err(NotSaved::Changed(found)) => Ok(json!({ "ok": false, "text": found })),
                    Err(NotSaved::Refused(message)) => Err(Refusal::failed(message)),
                }
            }
            ("studio/save", None) => Err(Refusal::invalid("there is no `text`")),
            _ => Err(Refusal::unknown(&method)),
        };
        self.say(vec![response(id, answer)])
    }

    /// Makes a picture's file while the conversation goes on.
    fn render(&mut self, request: Request) -> Result<(), Error> {
        let id = request.id.clone();
        let failed = |why: &str| vec![response(id.clone(), Err(Refusal::failed(why)))];
        if self.download.is_some() {
            return self.say(failed("another picture is being made"));
        }
        let cancel = Arc::new(AtomicBool::new(false));
        let cancelled = Arc::clone(&cancel);
        let thread = thread::Builder::new().name("picture".to_owned());
        match thread.spawn(move || download::answer(request, &cancelled)) {
            Ok(thread) => {
                self.download = Some(Download {
                    request: json!(id),
                    cancel,
                    thread,
                });
                Ok(())
            }
            Err(error) => self.say(failed(&format!("no thread can be had: {error}"))),
        }
    }

    /// Gives the picture's file up that a request asked for, or any.
    fn cancel(&self, wanted: Option<&Value>) {
        if let Some(download) = &self.download
            && wanted.is_none_or(|wanted| *wanted == download.request)
        {
            download.cancel.store(true, Ordering::SeqCst);
        }
    }
}
