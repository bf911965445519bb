//! The conversation with one page, over a web socket.
//!
//! What a page asks supersedes what it asked before, so all that has come is taken in before the
//! next slice of work. While there is no work, the socket is waited for; the scene's file and the
//! picture that another thread makes are looked at a little later.

use std::{
    convert::Infallible,
    pin::pin,
    sync::{Arc, Mutex, TryLockError, atomic::Ordering},
    task::{Context, Poll, Waker},
    thread::{self, JoinHandle},
    time::{Duration, Instant},
};

use axum::extract::ws::{CloseCode, CloseFrame, Message as SocketMessage, WebSocket, close_code};
use lsp_server::{Message, Notification, Request};
use serde_json::{Value, json};
use tokio::{runtime::Handle, sync::watch, time::timeout};

use super::{
    access::{NotAdmitted, Pass},
    download,
    draft::Unsaved,
    scene_file::{NotSaved, SceneFile, lock},
    watched::{self, Watch},
};
use crate::{
    lsp::{
        Refusal, Server,
        messages::{self, Malformed},
        response,
    },
    threads,
};

/// The longest message of a page, in bytes: far more than any text that an editor in a browser can
/// hold, and little enough for memory.
pub const LONGEST: usize = 64 << 20;

/// How long the socket is waited for before one looks at the file and the picture: less than
/// anybody notices.
const WAIT: Duration = Duration::from_millis(50);

/// Who does not take what is sent to it in this time is gone: a browser on this machine takes it at
/// once, unless it is stopped.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);

/// How long passes between two messages of how far a picture's file is.
const PROGRESS: Duration = Duration::from_millis(200);

/// How long the page has to answer a goodbye: less than the host waits for its conversations when
/// it ends.
const FAREWELL: Duration = Duration::from_millis(200);

/// Holds the conversation until the page leaves, its pass is over, or the host ends. The runtime
/// carries the messages.
pub fn converse(
    runtime: Handle,
    socket: WebSocket,
    pass: &Pass,
    ending: &watch::Receiver<bool>,
    file: &Mutex<SceneFile>,
) {
    let mut conversation = Conversation {
        runtime,
        socket,
        pass,
        ending,
        server: Server::new(|_| {}),
        file,
        known: 0,
        download: None,
    };
    // On threads that are there for each of its pictures. Where there are none, the page connects
    // again.
    let _ = threads::install(None, || {
        let Err(end) = conversation.run();
        conversation.cancel(None);
        conversation.close(end);
    });
}

/// The end of a conversation, with the code that the socket is closed with; none if it is closed or
/// broken.
struct End(Option<CloseCode>);

struct Conversation<'a> {
    runtime: Handle,
    socket: WebSocket,
    pass: &'a Pass,
    ending: &'a watch::Receiver<bool>,
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
    watch: Arc<Watch>,
    /// When the page was told of it last.
    told: Instant,
    thread: JoinHandle<Message>,
}

impl Conversation<'_> {
    fn run(&mut self) -> Result<Infallible, End> {
        let params = json!({ "token": self.pass.token });
        self.say(vec![
            Notification::new("studio/session".to_owned(), params).into(),
        ])?;
        while self.server.ended().is_none() {
            if let Some(code) = over(self.pass, self.ending) {
                return Err(End(Some(code)));
            }
            self.tell_file()?;
            if let Some(done) = self.download.take_if(|it| it.thread.is_finished())
                && let Ok(answer) = done.thread.join()
            {
                self.say(vec![answer])?;
            }
            self.tell_progress()?;
            match self.read()? {
                Some(SocketMessage::Text(text)) => self.hear(&text)?,
                Some(SocketMessage::Binary(_)) => return Err(End(Some(close_code::UNSUPPORTED))),
                Some(SocketMessage::Close(_)) => return Err(End(None)),
                Some(SocketMessage::Ping(_) | SocketMessage::Pong(_)) => {}
                None => {
                    let messages = self.server.advance();
                    self.say(messages)?;
                }
            }
        }
        Err(End(Some(close_code::NORMAL)))
    }

    /// What the page has sent; nothing if there is nothing yet. Where there is work, it is not
    /// waited for, not even as long as the shortest time that a timer knows, which is a
    /// millisecond.
    fn read(&mut self) -> Result<Option<SocketMessage>, End> {
        let socket = &mut self.socket;
        let read = match self.server.is_busy() {
            true => {
                let mut context = Context::from_waker(Waker::noop());
                pin!(socket.recv()).poll(&mut context)
            }
            false => {
                let read = async { timeout(WAIT, socket.recv()).await };
                self.runtime
                    .block_on(read)
                    .map_or(Poll::Pending, Poll::Ready)
            }
        };
        match read {
            Poll::Pending => Ok(None),
            Poll::Ready(None) => Err(End(None)),
            Poll::Ready(Some(Ok(message))) => Ok(Some(message)),
            Poll::Ready(Some(Err(error))) => Err(End(fault(error))),
        }
    }

    fn send(&mut self, message: SocketMessage) -> Result<(), End> {
        let socket = &mut self.socket;
        let mut sent = pin!(socket.send(message));
        let start = Instant::now();
        loop {
            let slice = async { timeout(WAIT, sent.as_mut()).await };
            match self.runtime.block_on(slice) {
                Ok(Ok(())) => return Ok(()),
                Ok(Err(_)) => return Err(End(None)),
                Err(_) if start.elapsed() > WRITE_TIMEOUT => return Err(End(None)),
                Err(_) => {}
            }
            // A page that reads nothing keeps neither the host from ending nor a session.
            if let Some(code) = over(self.pass, self.ending) {
                return Err(End(Some(code)));
            }
        }
    }

    /// Closes the socket. What the page still says is read for a moment: unread, it would break the
    /// connection before the code has arrived. The socket answers the page's own goodbye meanwhile.
    fn close(&mut self, End(code): End) {
        if let Some(code) = code {
            let reason = "".into();
            let frame = CloseFrame { code, reason };
            let _ = self.send(SocketMessage::Close(Some(frame)));
        }
        let socket = &mut self.socket;
        let rest = async { while let Some(Ok(_)) = socket.recv().await {} };
        let _ = self
            .runtime
            .block_on(async { timeout(FAREWELL, rest).await });
    }

    fn say(&mut self, messages: Vec<Message>) -> Result<(), End> {
        let mut texts = messages.iter().map(messages::written);
        texts.try_for_each(|text| self.send(SocketMessage::text(text)))
    }

    /// Tells the page about the file, if it is another than the page knows; a little later, while
    /// another page has it.
    fn tell_file(&mut self) -> Result<(), End> {
        let mut file = match self.file.try_lock() {
            Ok(file) => file,
            Err(TryLockError::Poisoned(file)) => file.into_inner(),
            Err(TryLockError::WouldBlock) => return Ok(()),
        };
        let version = file.look();
        if version == self.known {
            return Ok(());
        }
        // A page that is new has nothing yet that a draft would take the place of.
        let is_first = self.known == 0;
        let drafts = match is_first {
            true => file.drafts(),
            false => Vec::new(),
        };
        self.known = version;
        let held = file.held().as_ref();
        let mut params = json!({
            "name": file.name(),
            "text": held.ok(),
            "reason": held.err(),
            "saved": file.path().is_some(),
        });
        if !drafts.is_empty() {
            params["drafts"] = json!(drafts);
        }
        drop(file);
        self.say(vec![
            Notification::new("studio/file".to_owned(), params).into(),
        ])
    }

    /// Tells the page which part of the picture's file is made, a few times a second.
    fn tell_progress(&mut self) -> Result<(), End> {
        let now = Instant::now();
        match &mut self.download {
            Some(download) if now.duration_since(download.told) > PROGRESS => {
                download.told = now;
                let share = download.watch.share();
                self.say(vec![download::progress(share)])
            }
            _ => Ok(()),
        }
    }

    fn hear(&mut self, text: &str) -> Result<(), End> {
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
                self.send(SocketMessage::text(response.to_string()))
            }
            Err(Malformed::Unanswered(_)) => Ok(()),
        }
    }

    /// Answers what is asked of the host.
    fn answer(&mut self, request: Request) -> Result<(), End> {
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
            ("studio/draft", text) => match field("id") {
                Some(id) => {
                    let new = |text| Unsaved::new(id, field("name"), text, field("base"));
                    let kept = lock(self.file).keep_draft(id, text.map(new));
                    kept.map(|()| json!({ "ok": true }))
                        .map_err(Refusal::failed)
                }
                None => Err(Refusal::invalid("there is no `id`")),
            },
            ("studio/alive", _) => Ok(json!({ "ok": true })),
            ("studio/save", None) => Err(Refusal::invalid("there is no `text`")),
            _ => Err(Refusal::unknown(&method)),
        };
        self.say(vec![response(id, answer)])
    }

    /// Makes a picture's file while the conversation goes on.
    fn render(&mut self, request: Request) -> Result<(), End> {
        let id = request.id.clone();
        let failed = |why: &str| vec![response(id.clone(), Err(Refusal::failed(why)))];
        if self.download.is_some() {
            return self.say(failed("another picture is being made"));
        }
        let watch = Arc::new(Watch::default());
        let watched = Arc::clone(&watch);
        let thread = thread::Builder::new().name("picture".to_owned());
        match thread.spawn(move || watched::answer(request, &watched)) {
            Ok(thread) => {
                self.download = Some(Download {
                    request: json!(id),
                    watch,
                    told: Instant::now(),
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
            download.watch.cancel.store(true, Ordering::SeqCst);
        }
    }
}

/// The code that the socket is closed with where the host ends, or what let the page in is over.
fn over(pass: &Pass, ending: &watch::Receiver<bool>) -> Option<CloseCode> {
    if *ending.borrow() {
        return Some(close_code::AWAY);
    }
    pass.is_over().then_some(NotAdmitted::Twice as CloseCode)
}

/// The code that says what is wrong with what the page has sent; none if the connection itself is
/// broken.
fn fault(error: axum::Error) -> Option<CloseCode> {
    use tungstenite::Error;
    match *error.into_inner().downcast().ok()? {
        Error::Capacity(_) => Some(close_code::SIZE),
        Error::Utf8(_) => Some(close_code::INVALID),
        Error::Protocol(_) => Some(close_code::PROTOCOL),
        _ => None,
    }
}
