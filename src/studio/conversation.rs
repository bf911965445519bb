//! Serves one page over a WebSocket connection.
//!
//! A new request of a page may replace an earlier one, so all messages that have arrived are read
//! before a request is answered. If no request waits, the thread waits for a message. At regular
//! intervals, it checks whether the scene's file has changed, and sends the progress of a picture
//! that another thread renders.

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
    access::{NotAdmitted, Permission},
    download,
    draft::Unsaved,
    lesson_file::LessonFile,
    scene_file::{NotSaved, SceneFile},
    threaded_download::{self, Watch},
};
use crate::{
    lock::lock,
    lsp::{
        Refusal, Server,
        messages::{self, Malformed},
        response,
    },
    threads,
};

/// Maximum length of a message from a page, in bytes: 64 MiB. A longer message ends the connection.
/// The limit is longer than any text that an editor in a browser can handle, and small compared
/// with the memory of a machine.
pub const LONGEST: usize = 64 << 20;

/// Maximum time to wait for a message of the page. After this time, the scene's file and the
/// progress of a picture are checked again. A user does not notice a delay of 50 ms; a much shorter
/// time would keep an idle processor busy.
const WAIT: Duration = Duration::from_millis(50);

/// Maximum time to wait until a page has received a message. After this time, the connection is
/// closed. A browser on the same machine usually receives a message within milliseconds, so after
/// 10 s its process is probably suspended.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);

/// Minimum time between two messages about the progress of a download. A progress bar that moves
/// five times a second looks continuous enough, so more messages would have no visible effect.
const PROGRESS: Duration = Duration::from_millis(200);

/// Maximum time to wait for the page's answer to a close frame. When the host ends, it waits 500 ms
/// for its connections, so this time must be shorter.
const FAREWELL: Duration = Duration::from_millis(200);

/// Serves the page until it disconnects, its [`Permission`] is revoked, or the host ends. The tasks
/// of `runtime` transport the messages.
pub fn converse(
    runtime: Handle,
    socket: WebSocket,
    permission: &Permission,
    ending: &watch::Receiver<bool>,
    file: &Mutex<SceneFile>,
    lesson: Option<&LessonFile>,
) {
    let mut conversation = Conversation {
        runtime,
        socket,
        permission,
        ending,
        server: Server::new(|_| {}),
        file,
        lesson,
        known: 0,
        download: None,
    };
    // All pictures of a connection are rendered in one thread pool. If no threads can be started,
    // the connection ends, and the page connects again.
    let _ = threads::install(None, || {
        let Err(end) = conversation.run();
        conversation.cancel(None);
        conversation.close(end);
    });
}

/// End of a connection. Contains the code with which the socket is closed; `None` if the socket is
/// closed or broken already.
struct Closing(Option<CloseCode>);

struct Conversation<'a> {
    runtime: Handle,
    socket: WebSocket,
    permission: &'a Permission,
    ending: &'a watch::Receiver<bool>,
    server: Server,
    /// The file of the scene, which all pages share.
    file: &'a Mutex<SceneFile>,
    lesson: Option<&'a LessonFile>,
    /// Version number of the file's content that the page has received; 0 if it has received none.
    known: u64,
    download: Option<Download>,
}

/// A picture that is rendered to a file on another thread, and then sent to the page.
struct Download {
    request: Value,
    watch: Arc<Watch>,
    /// Time of the last message about the render's progress.
    last_progress: Instant,
    thread: JoinHandle<Message>,
}

impl Conversation<'_> {
    fn run(&mut self) -> Result<Infallible, Closing> {
        let params = json!({ "token": self.permission.token });
        self.notify("studio/session", params)?;
        while self.server.ended().is_none() {
            if let Some(code) = over(self.permission, self.ending) {
                return Err(Closing(Some(code)));
            }
            self.send_file()?;
            self.answer_download(|download| download.thread.is_finished())?;
            self.send_progress()?;
            match self.read()? {
                Some(SocketMessage::Text(text)) => self.handle_text(&text)?,
                Some(SocketMessage::Binary(_)) => {
                    return Err(Closing(Some(close_code::UNSUPPORTED)));
                }
                Some(SocketMessage::Close(_)) => return Err(Closing(None)),
                Some(SocketMessage::Ping(_) | SocketMessage::Pong(_)) => {}
                None => {
                    let messages = self.server.advance();
                    self.send_all(messages)?;
                }
            }
        }
        Err(Closing(Some(close_code::NORMAL)))
    }

    /// Reads a message of the page. Returns `None` if none arrives in time. If the server has work
    /// to do, returns at once, without any timeout: even the shortest one, a millisecond, would
    /// delay each slice of the work noticeably.
    fn read(&mut self) -> Result<Option<SocketMessage>, Closing> {
        let socket = &mut self.socket;
        let read = if self.server.is_busy() {
            let mut context = Context::from_waker(Waker::noop());
            pin!(socket.recv()).poll(&mut context)
        } else {
            let read = async { timeout(WAIT, socket.recv()).await };
            self.runtime
                .block_on(read)
                .map_or(Poll::Pending, Poll::Ready)
        };
        match read {
            Poll::Pending => Ok(None),
            Poll::Ready(None) => Err(Closing(None)),
            Poll::Ready(Some(Ok(message))) => Ok(Some(message)),
            Poll::Ready(Some(Err(error))) => Err(Closing(fault(error))),
        }
    }

    fn send(&mut self, message: SocketMessage) -> Result<(), Closing> {
        let socket = &mut self.socket;
        let mut sent = pin!(socket.send(message));
        let start = Instant::now();
        loop {
            let slice = async { timeout(WAIT, sent.as_mut()).await };
            match self.runtime.block_on(slice) {
                Ok(Ok(())) => return Ok(()),
                Ok(Err(_)) => return Err(Closing(None)),
                Err(_) if start.elapsed() > WRITE_TIMEOUT => return Err(Closing(None)),
                Err(_) => {}
            }
            // Sending may take long if the page does not receive. Meanwhile, the host or the page's
            // session may end, so both are checked again and again.
            if let Some(code) = over(self.permission, self.ending) {
                return Err(Closing(Some(code)));
            }
        }
    }

    /// Closes the socket, with a code if there is one. Messages that the page has sent are still
    /// read for a short time, because unread messages would reset the connection before the code
    /// arrives. If the page itself has sent a close frame, the socket answers it during this time.
    fn close(&mut self, Closing(code): Closing) {
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

    fn notify(&mut self, method: &str, params: Value) -> Result<(), Closing> {
        self.send_all(vec![Notification::new(method.to_owned(), params).into()])
    }

    fn send_all(&mut self, messages: Vec<Message>) -> Result<(), Closing> {
        let mut texts = messages.iter().map(messages::to_text);
        texts.try_for_each(|text| self.send(SocketMessage::text(text)))
    }

    /// Sends the file's content to the page if the page has another version. Does nothing while
    /// another page locks the file; a later call sends the content. Returns an error if the
    /// connection must be closed.
    fn send_file(&mut self) -> Result<(), Closing> {
        let mut file = match self.file.try_lock() {
            Ok(file) => file,
            Err(TryLockError::Poisoned(file)) => file.into_inner(),
            Err(TryLockError::WouldBlock) => return Ok(()),
        };
        let version = file.refresh();
        if version == self.known {
            return Ok(());
        }
        // Drafts are sent only to a page that has just connected. On any other page, a draft would
        // replace the text that is being edited.
        let is_first = self.known == 0;
        let drafts = if is_first { file.drafts() } else { Vec::new() };
        self.known = version;
        let content = file.content().as_ref();
        let mut params = json!({
            "name": file.name(),
            "text": content.ok(),
            "reason": content.err(),
            "saved": file.path().is_some(),
        });
        if !drafts.is_empty() {
            params["drafts"] = json!(drafts);
        }
        drop(file);
        if let Some(lesson) = self.lesson.filter(|_| is_first) {
            params["lesson"] = lesson.for_page();
        }
        self.notify("studio/file", params)
    }

    /// Sends the progress of the download, unless the last message about it is more recent than
    /// [`PROGRESS`].
    fn send_progress(&mut self) -> Result<(), Closing> {
        let now = Instant::now();
        match &mut self.download {
            Some(download) if now.duration_since(download.last_progress) > PROGRESS => {
                download.last_progress = now;
                let share = download.watch.share();
                self.send_all(vec![download::progress(share)])
            }
            _ => Ok(()),
        }
    }

    fn handle_text(&mut self, text: &str) -> Result<(), Closing> {
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
                self.send_all(messages)
            }
            Err(Malformed::Answered(response)) => {
                self.send(SocketMessage::text(response.to_string()))
            }
            Err(Malformed::Unanswered(_)) => Ok(()),
        }
    }

    /// Answers a request to the host. If the request asks for a download, starts the download
    /// instead. Returns an error if the connection must be closed.
    fn answer(&mut self, request: Request) -> Result<(), Closing> {
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
                        // The page that has saved a file has its content already, so the content is
                        // not sent to the page again. A new scene is sent, because the page does
                        // not know its path yet.
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
        self.send_all(vec![response(id, answer)])
    }

    /// If `is_over` holds for the download, waits for the end of its thread, and sends the answer.
    fn answer_download(&mut self, is_over: impl Fn(&Download) -> bool) -> Result<(), Closing> {
        match self.download.take_if(|it| is_over(it)) {
            Some(download) => {
                let answer = download.thread.join();
                self.send_all(answer.into_iter().collect())
            }
            None => Ok(()),
        }
    }

    /// Renders a picture to a file on another thread, while this connection is served. If a picture
    /// is being rendered already, answers the request with an error. A cancelled render ends
    /// shortly after its cancellation, so the new one waits for its end.
    fn render(&mut self, request: Request) -> Result<(), Closing> {
        let id = request.id.clone();
        let failed = |why: &str| vec![response(id.clone(), Err(Refusal::failed(why)))];
        self.answer_download(|download| download.watch.cancel.load(Ordering::SeqCst))?;
        if self.download.is_some() {
            return self.send_all(failed("another picture is being made"));
        }
        let watch = Arc::new(Watch::default());
        let watched = Arc::clone(&watch);
        let thread = thread::Builder::new().name("picture".to_owned());
        match thread.spawn(move || threaded_download::answer(request, &watched)) {
            Ok(thread) => {
                self.download = Some(Download {
                    request: json!(id),
                    watch,
                    last_progress: Instant::now(),
                    thread,
                });
                Ok(())
            }
            Err(error) => self.send_all(failed(&format!("no thread can be had: {error}"))),
        }
    }

    /// Cancels the download that the request with the identifier `wanted` has started. If `wanted`
    /// is `None`, cancels any download.
    fn cancel(&self, wanted: Option<&Value>) {
        if let Some(download) = &self.download
            && wanted.is_none_or(|wanted| *wanted == download.request)
        {
            download.watch.cancel.store(true, Ordering::SeqCst);
        }
    }
}

/// Returns the code with which the socket must be closed, if the host ends or the page's
/// [`Permission`] is revoked. Returns `None` if the connection continues.
fn over(permission: &Permission, ending: &watch::Receiver<bool>) -> Option<CloseCode> {
    if *ending.borrow() {
        return Some(close_code::AWAY);
    }
    permission
        .is_over()
        .then_some(NotAdmitted::Twice as CloseCode)
}

/// Returns the code with which the socket is closed after an invalid message. Returns `None` if the
/// connection itself is broken.
fn fault(error: axum::Error) -> Option<CloseCode> {
    use tungstenite::Error;
    match *error.into_inner().downcast().ok()? {
        Error::Capacity(_) => Some(close_code::SIZE),
        Error::Utf8(_) => Some(close_code::INVALID),
        Error::Protocol(_) => Some(close_code::PROTOCOL),
        _ => None,
    }
}
