//! The conversation with one page, over a web socket.
//!
//! A thread of its own does nothing but read, as in [`crate::lsp::stdio`]: what a page asks supersedes what it asked before, so all that has come is taken in before the
//! next slice of work. It passes on what it reads together with what other threads have for the page, and this thread alone writes.

use std::{
    io::{self, Read, Write},
    net::{Shutdown, TcpStream},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc::{self, Receiver, Sender, SyncSender, TryRecvError},
    },
    thread,
};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use serde_json::{Value, json};
use tungstenite::{
    Error, Message as Frame, Utf8Bytes, WebSocket,
    protocol::{CloseFrame, Role, WebSocketConfig, frame::coding::CloseCode},
};

use super::{
    pages::{Event, Pages},
    picture_file,
    scene_file::NotSaved,
};
use crate::lsp::{
    Server,
    messages::{self, Malformed},
};

/// The longest message of a page, in bytes: far more than any text that an editor in a browser can hold, and little enough for memory.
const LONGEST: usize = 64 << 20;

/// So many messages are read before the first of them is taken in. A hand that drags sends one or two for each frame of the screen, and some 20 frames are behind at worst.
const AHEAD: usize = 64;

/// Holds the conversation until the page leaves. Some of it may have been read already.
pub fn converse(stream: TcpStream, rest: Vec<u8>, pages: &Arc<Pages>) -> io::Result<()> {
    let config = WebSocketConfig::default()
        .read_buffer_size(1 << 14)
        .max_message_size(Some(LONGEST))
        .max_frame_size(Some(LONGEST));
    stream.set_read_timeout(None)?;
    let half = ReadHalf(stream.try_clone()?);
    let reader = WebSocket::from_partially_read(half, rest, Role::Server, Some(config));
    let (sender, events) = mpsc::channel();
    let (ahead, taken) = mpsc::sync_channel(AHEAD);
    let own_sender = sender.clone();
    thread::Builder::new()
        .name("page".to_owned())
        .spawn(move || read(reader, &sender, &ahead))?;
    let number = pages.join(own_sender.clone());
    let mut page = Page {
        number,
        socket: WebSocket::from_raw_socket(stream, Role::Server, Some(config)),
        pages: Arc::clone(pages),
        server: Server::new(|_| {}),
        sender: own_sender,
        rendering: None,
    };
    let ended = page.run(&events, &taken);
    page.cancel(None);
    pages.leave(number);
    // The reader ends with it.
    let _ = page.socket.get_ref().shutdown(Shutdown::Both);
    ended.map_err(|error| match error {
        Error::Io(error) => error,
        other => io::Error::other(other.to_string()),
    })
}

/// Reads until there is nothing more to read.
fn read(mut socket: WebSocket<ReadHalf>, sender: &Sender<Event>, ahead: &SyncSender<()>) {
    loop {
        let event = match socket.read() {
            Ok(Frame::Text(text)) => Event::Said(text),
            Ok(Frame::Ping(content)) => Event::Pinged(content),
            Ok(Frame::Binary(_)) => Event::Over(CloseCode::Unsupported),
            Ok(Frame::Close(_)) => Event::Over(CloseCode::Normal),
            Ok(Frame::Pong(_) | Frame::Frame(_)) => continue,
            Err(Error::Capacity(_)) => Event::Over(CloseCode::Size),
            Err(Error::Utf8(_)) => Event::Over(CloseCode::Invalid),
            Err(_) => Event::Over(CloseCode::Protocol),
        };
        let is_last = matches!(event, Event::Over(_));
        // Where nobody takes them any more, this ends as well.
        if ahead.send(()).is_err() || sender.send(event).is_err() || is_last {
            return;
        }
    }
}

/// A connection that is read from. What a web socket would write of itself is for the other thread.
#[derive(Debug)]
struct ReadHalf(TcpStream);

impl Read for ReadHalf {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.0.read(bytes)
    }
}

impl Write for ReadHalf {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

struct Page {
    number: u64,
    socket: WebSocket<TcpStream>,
    pages: Arc<Pages>,
    server: Server,
    /// For threads that work for it.
    sender: Sender<Event>,
    /// The request for the picture's file that is being made, and what gives it up.
    rendering: Option<(RequestId, Arc<AtomicBool>)>,
}

impl Page {
    fn run(&mut self, events: &Receiver<Event>, taken: &Receiver<()>) -> Result<(), Error> {
        loop {
            let event = match self.server.is_busy() {
                true => match events.try_recv() {
                    Err(TryRecvError::Empty) => {
                        let messages = self.server.advance();
                        self.say(messages)?;
                        continue;
                    }
                    event => event.ok(),
                },
                false => events.recv().ok(),
            };
            if !matches!(event, Some(Event::Tell(_) | Event::Rendered(_))) {
                let _ = taken.try_recv();
            }
            match event {
                Some(Event::Said(text)) => self.hear(&text)?,
                Some(Event::Tell(text)) => self.send(text)?,
                Some(Event::Rendered(text)) => {
                    self.rendering = None;
                    self.send(text)?;
                }
                Some(Event::Pinged(content)) => self.socket.send(Frame::Pong(content))?,
                Some(Event::Over(code)) => return self.close(code),
                None => return Ok(()),
            }
            if self.server.ended().is_some() {
                return self.close(CloseCode::Normal);
            }
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
                    self.cancel(Some(params.get("id").unwrap_or(&Value::Null)));
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
        if picture_file::is_asked_for(&request) {
            return self.render(request);
        }
        let Request { id, method, params } = request;
        let field = |name| params.get(name).and_then(Value::as_str);
        let failed =
            |code: ErrorCode, message: String| Response::new_err(id.clone(), code as i32, message);
        let response = match (method.as_str(), field("text")) {
            ("studio/save", Some(text)) => {
                let saved = self
                    .pages
                    .save(self.number, text, field("base"), field("name"));
                match saved {
                    Ok(()) => Response::new_ok(id, json!({ "ok": true })),
                    Err(NotSaved::Refused(message)) => failed(ErrorCode::RequestFailed, message),
                    Err(NotSaved::Changed(found)) => {
                        let message = "the file has changed".to_owned();
                        let mut response = Response::new_err(id, 1, message);
                        if let Err(error) = &mut response.response_result {
                            error.data = Some(json!({ "text": found }));
                        }
                        response
                    }
                }
            }
            ("studio/save", None) => {
                failed(ErrorCode::InvalidParams, "there is no `text`".to_owned())
            }
            _ => failed(
                ErrorCode::MethodNotFound,
                format!("`{method}` is not known here"),
            ),
        };
        self.say(vec![response.into()])
    }

    /// Makes a picture's file while the conversation goes on.
    fn render(&mut self, request: Request) -> Result<(), Error> {
        if self.rendering.is_some() {
            let message = "another picture is being made".to_owned();
            let code = ErrorCode::RequestFailed as i32;
            return self.say(vec![Response::new_err(request.id, code, message).into()]);
        }
        let cancel = Arc::new(AtomicBool::new(false));
        self.rendering = Some((request.id.clone(), Arc::clone(&cancel)));
        let sender = self.sender.clone();
        let work = move || {
            let response = picture_file::answer(request, &cancel);
            let _ = sender.send(Event::Rendered(messages::written(&response.into())));
        };
        thread::Builder::new()
            .name("picture".to_owned())
            .spawn(work)
            .map(|_| ())
            .map_err(Error::Io)
    }

    /// Gives the picture's file up that a request asked for, or any.
    fn cancel(&self, wanted: Option<&Value>) {
        let wanted = wanted.map(|id| serde_json::from_value(id.clone()).ok());
        if let Some((id, cancel)) = &self.rendering
            && wanted.is_none_or(|wanted: Option<RequestId>| wanted.as_ref() == Some(id))
        {
            cancel.store(true, Ordering::SeqCst);
        }
    }
}
