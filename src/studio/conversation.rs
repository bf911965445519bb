//! The conversation with one page, over a web socket.
//!
//! What a page asks supersedes what it asked before, so all that has come is taken in before the next slice of work. While there is no work, the socket is waited
//! for, and what other threads have for the page a little later.

use std::{
    io,
    net::TcpStream,
    sync::{
        Arc, Weak,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender},
    },
    thread,
    time::Duration,
};

use lsp_server::{Message, Notification, Request};
use serde_json::{Value, json};
use tungstenite::{
    Error, Message as Frame, Utf8Bytes, WebSocket,
    protocol::{CloseFrame, Role, WebSocketConfig, frame::coding::CloseCode},
};

use super::{download, pages::Pages, scene_file::NotSaved};
use crate::lsp::{
    Refusal, Server,
    messages::{self, Malformed},
    response,
};

/// The longest message of a page, in bytes: far more than any text that an editor in a browser can hold, and little enough for memory.
const LONGEST: usize = 64 << 20;

/// How long the socket is waited for before one looks at what other threads have for the page: less than anybody notices.
const WAIT: Duration = Duration::from_millis(50);

/// Holds the conversation until the page leaves. Some of it may have been read already.
pub fn converse(stream: TcpStream, rest: Vec<u8>, pages: &Arc<Pages>) -> io::Result<()> {
    let config = WebSocketConfig::default()
        .read_buffer_size(1 << 14)
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    stream.set_read_timeout(Some(WAIT))?;
    let (sender, messages) = mpsc::channel();
    let number = pages.join(sender.clone());
    let mut conversation = Conversation {
        number,
        socket: WebSocket::from_partially_read(stream, rest, Role::Server, Some(config)),
        pages: Arc::clone(pages),
        server: Server::new(|_| {}),
        sender,
        messages,
        rendering: (Value::Null, Weak::new()),
    };
    let ended = conversation.run();
    conversation.cancel(None);
    pages.leave(number);
    ended.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

struct Conversation {
    number: u64,
    socket: WebSocket<TcpStream>,
    pages: Arc<Pages>,
    server: Server,
    /// For threads that work for it.
    sender: Sender<String>,
    /// Messages for the page.
    messages: Receiver<String>,
    /// The number of the last request for a picture's file, and while that is being made what gives it up.
    rendering: (Value, Weak<AtomicBool>),
}

impl Conversation {
    fn run(&mut self) -> Result<(), Error> {
        while self.server.ended().is_none() {
            while let Ok(text) = self.messages.try_recv() {
                self.send(text)?;
            }
            match self.read() {
                Ok(Some(Frame::Text(text))) => self.hear(&text)?,
                Ok(Some(Frame::Binary(_))) => return self.close(CloseCode::Unsupported),
                Ok(Some(Frame::Close(_))) => break,
                // The socket answers pings by itself.
                Ok(Some(Frame::Ping(_) | Frame::Pong(_) | Frame::Frame(_))) => {}
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
    fn read(&mut self) -> Result<Option<Frame>, Error> {
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
        texts.try_for_each(|text| self.send(text))
    }

    fn send(&mut self, text: String) -> Result<(), Error> {
        self.socket.send(Frame::text(text))
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
            Err(Malformed::Answered(response)) => self.send(response.to_string()),
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
                let (base, name) = (field("base"), field("name"));
                match self.pages.save(self.number, text, base, name) {
                    Ok(()) => Ok(json!({ "ok": true })),
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
        if self.rendering.1.strong_count() > 0 {
            return self.say(failed("another picture is being made"));
        }
        let cancel = Arc::new(AtomicBool::new(false));
        self.rendering = (json!(id), Arc::downgrade(&cancel));
        let sender = self.sender.clone();
        let work = move || {
            let answer = download::answer(request, &cancel);
            // It is over before the page knows of it, and asks for the next one.
            drop(cancel);
            let _ = sender.send(messages::written(&answer));
        };
        let thread = thread::Builder::new().name("picture".to_owned());
        match thread.spawn(work) {
            Ok(_) => Ok(()),
            Err(error) => self.say(failed(&format!("no thread can be had: {error}"))),
        }
    }

    /// Gives the picture's file up that a request asked for, or any.
    fn cancel(&self, wanted: Option<&Value>) {
        let (id, cancel) = &self.rendering;
        if let Some(cancel) = cancel.upgrade()
            && wanted.is_none_or(|wanted| wanted == id)
        {
            cancel.store(true, Ordering::SeqCst);
        }
    }
}
