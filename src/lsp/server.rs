//! A language server that receives and returns messages.
//!
//! Notifications, `initialize` and `shutdown` are handled at once. Other requests enter a queue,
//! and each call of [`Server::advance`] answers some of them. Between two calls, a host can pass in
//! other messages, such as a cancellation.
//!
//! Each answer is about the text at the time of the request: before a text changes, all waiting
//! requests about it are answered. Diagnostics are computed only for the latest version of a text.
//!
//! A frame, i.e. a picture for a web page, is rendered in slices while no other request waits. The
//! frames of a text are dropped when the text changes. There is one exception: if the text has
//! errors and the request sets the parameter `last`, the frame shows the last version without
//! errors, and further changes of the text do not drop it.

use std::{
    cell::LazyCell,
    collections::{BTreeSet, HashMap, VecDeque},
    panic::{self, AssertUnwindSafe},
};

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId};
use serde_json::{Value, json};

use super::{
    convert::{self, Client, Converter},
    documents::Document,
    frames::Frames,
    params::{Refusal, at, response},
    picture_requests,
    protocol::Uri,
    scene_version::SceneVersion,
    text_requests::{answer, diagnostics, not_open},
};
use crate::editor::Analysis;

/// State of the connection to a client.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The client has not sent `initialize` yet.
    Silent,
    /// The client has sent `initialize` with the contained capabilities.
    Talking(Client),
    /// The client has sent `shutdown`.
    ShutDown,
    /// The client has sent `exit`. The flag `properly` says whether it had sent `shutdown` before.
    Ended { properly: bool },
}

/// A language server for one client.
#[derive(Debug)]
pub struct Server {
    phase: Phase,
    documents: HashMap<Uri, Document>,
    /// Requests that are not answered yet, in the order of their arrival.
    waiting: VecDeque<Request>,
    /// URIs of the documents whose diagnostics must be sent, because they have changed.
    changed: BTreeSet<String>,
    /// For each document whose picture was requested, the scene of the current version. The scene
    /// is `None` if this version has errors.
    scenes: HashMap<Uri, Option<SceneVersion>>,
    /// For each text that has changed, the scene of its last version without errors. If the text
    /// now has errors, a frame can still show this scene; the request asks for it by the parameter
    /// `last`. The values are moved from `scenes` and have the same type, but are never `None`.
    last: HashMap<Uri, Option<SceneVersion>>,
    frames: Frames,
    log: fn(&str),
}

impl Server {
    /// Creates a server that waits for `initialize`. The server calls `log` with a message for each
    /// notification that it cannot carry out.
    pub fn new(log: fn(&str)) -> Self {
        Self {
            phase: Phase::Silent,
            documents: HashMap::new(),
            waiting: VecDeque::new(),
            changed: BTreeSet::new(),
            scenes: HashMap::new(),
            last: HashMap::new(),
            frames: Frames::default(),
            log,
        }
    }

    /// Returns whether the connection has ended properly, i.e. by `exit` after `shutdown`. Returns
    /// `None` while the connection has not ended.
    pub fn ended(&self) -> Option<bool> {
        match self.phase {
            Phase::Ended { properly } => Some(properly),
            _ => None,
        }
    }

    /// Handles a message. Returns the messages that the host must send at once, before those that
    /// [`Self::advance`] returns.
    pub fn handle(&mut self, message: Message) -> Vec<Message> {
        match (message, &self.phase) {
            (Message::Request(request), Phase::Talking(_)) if !is_lifecycle(&request) => {
                self.waiting.push_back(request);
                Vec::new()
            }
            (Message::Request(request), _) => {
                let mut outgoing = self.answer_all(|_| true);
                outgoing.extend(self.frames.drop_of(None).into_iter().map(cancelled));
                outgoing.push(self.answer_lifecycle(request));
                outgoing
            }
            (Message::Notification(notification), _) => self.handle_notification(notification),
            // The server sends no requests, so a response is ignored.
            (Message::Response(_), _) => Vec::new(),
        }
    }

    /// Returns whether any work is left.
    pub fn is_busy(&self) -> bool {
        !self.waiting.is_empty() || !self.changed.is_empty() || !self.frames.is_empty()
    }

    /// Does a portion of the work, and returns the messages to send. A portion is all waiting
    /// requests about one text, together with the text's diagnostics. If no request waits and no
    /// text has changed, renders a slice of a frame instead.
    pub fn advance(&mut self) -> Vec<Message> {
        let asked = self.waiting.front().map(uri);
        let changed = || self.changed.first().map(|uri| Some(Uri(uri.clone())));
        let Some(next) = asked.or_else(changed) else {
            return self.advance_frame().into_iter().collect();
        };
        let is_changed = next.as_ref().is_some_and(|uri| self.changed.remove(&uri.0));
        self.work_on(next.as_ref(), is_changed)
    }

    /// Answers the waiting requests about certain texts: those for which `is_about` returns `true`.
    fn answer_all(&mut self, is_about: impl Fn(Option<&Uri>) -> bool) -> Vec<Message> {
        let mut outgoing = Vec::new();
        while let Some(request) = self.waiting.iter().find(|it| is_about(uri(it).as_ref())) {
            let uri = uri(request);
            outgoing.extend(self.work_on(uri.as_ref(), false));
        }
        outgoing
    }

    /// Answers the waiting requests about the document `wanted`. If `wanted` is `None`, answers the
    /// requests that are about no document. If `is_changed`, also publishes the document's
    /// diagnostics.
    fn work_on(&mut self, wanted: Option<&Uri>, is_changed: bool) -> Vec<Message> {
        let is_about = |request: &Request| uri(request).as_ref() == wanted;
        let (asked, others): (VecDeque<_>, _) = self.waiting.drain(..).partition(is_about);
        self.waiting = others;
        let Phase::Talking(client) = &self.phase else {
            return Vec::new();
        };
        let converter = wanted.and_then(|uri| {
            Some(Converter {
                client,
                uri,
                document: self.documents.get(uri)?,
            })
        });
        let analysis = converter
            .map(|converter| LazyCell::new(move || Analysis::new(&converter.document.sources)));
        let analysis = analysis.as_ref();
        let mut outgoing = Vec::new();
        for request in asked {
            let id = request.id.clone();
            let Some(about) = request.method.strip_prefix(picture_requests::NAMESPACE) else {
                let known = converter.zip(analysis.map(|analysis| &**analysis));
                outgoing.push(response(id, catch_panics(|| answer(request, known))));
                continue;
            };
            let Some((converter, analysis)) = converter.zip(analysis) else {
                outgoing.push(response(id, Err(not_open())));
                continue;
            };
            let (uri, number) = (converter.uri.clone(), converter.document.version);
            let version = self.scenes.entry(uri.clone());
            let version = version.or_insert_with(|| SceneVersion::new(analysis, number));
            if version.is_some() && about == "frame" {
                // The current version has no errors, so the scene of an earlier version is not
                // needed.
                self.last.remove(&uri);
            }
            let params = &request.params;
            let wants_last = about == "frame" && params.get("last") == Some(&Value::Bool(true));
            let last = || self.last.get(&uri).filter(|_| wants_last)?.as_ref();
            let pictured = version.as_ref().or_else(last);
            match (pictured, about) {
                (Some(version), "frame") => {
                    let push = || self.frames.push(id.clone(), uri, params, version);
                    match catch_panics(push) {
                        Ok(superseded) => outgoing.extend(superseded.into_iter().map(cancelled)),
                        Err(refusal) => outgoing.push(response(id, Err(refusal))),
                    }
                }
                _ => {
                    let answer =
                        || picture_requests::answer(about, params, converter, analysis, version);
                    outgoing.push(response(id, catch_panics(answer)));
                }
            }
        }
        if is_changed {
            let mut params = json!({ "uri": wanted, "diagnostics": [] });
            // A text that was closed has no diagnostics.
            if let Some((converter, analysis)) = converter.zip(analysis) {
                params["version"] = converter.document.version.into();
                params["diagnostics"] = json!(diagnostics(converter, analysis));
            }
            outgoing.push(published(params));
        }
        outgoing
    }

    /// Renders a slice of the first frame. Returns the answer when the frame is finished, and
    /// otherwise `None`.
    fn advance_frame(&mut self) -> Option<Message> {
        let id = self.frames.first()?;
        let (frames, scenes, last) = (&mut self.frames, &mut self.scenes, &mut self.last);
        let answer = catch_panics(|| frames.advance(scenes, last)).transpose()?;
        self.frames.cancel(&id);
        Some(response(id, answer))
    }

    /// Moves the scene of a text from the field `scenes` to the field `last`, because the text has
    /// changed, and drops the text's frames. Returns error responses to the requests for these
    /// frames. Does nothing if there is no scene, for example because the text had errors.
    fn outdate(&mut self, uri: &Uri) -> Vec<Message> {
        let Some(version @ Some(_)) = self.scenes.remove(uri) else {
            // There is no scene if the previous version of the text had errors, or if no picture of
            // that version was requested. In these cases, unfinished frames of the text show the
            // scene in `last`, which stays the same, so they are not dropped.
            return Vec::new();
        };
        self.last.insert(uri.clone(), version);
        self.drop_frames(uri)
    }

    /// Removes the scenes of a text that was opened or closed, and drops its frames. Returns error
    /// responses to the requests for these frames.
    fn forget(&mut self, uri: &Uri) -> Vec<Message> {
        self.scenes.remove(uri);
        self.last.remove(uri);
        self.drop_frames(uri)
    }

    /// Drops the frames of a text that was changed, opened anew or closed. Returns error responses
    /// to the requests for these frames.
    fn drop_frames(&mut self, uri: &Uri) -> Vec<Message> {
        let dropped = self.frames.drop_of(Some(uri)).into_iter();
        let changed = |id| {
            let message = "the text has changed".to_owned();
            response(id, Err(Refusal(ErrorCode::ContentModified, message)))
        };
        dropped.map(changed).collect()
    }

    /// Answers `initialize` and `shutdown`, and rejects any other request before `initialize` or
    /// after `shutdown`.
    fn answer_lifecycle(&mut self, request: Request) -> Message {
        let refuse = |code, message: &str| Err(Refusal(code, message.to_owned()));
        let answer = match (request.method.as_str(), self.phase) {
            ("initialize", Phase::Silent) => Ok(self.initialize(&request.params)),
            (_, Phase::Silent) => refuse(
                ErrorCode::ServerNotInitialized,
                "`initialize` comes before everything else",
            ),
            ("initialize", _) => refuse(ErrorCode::InvalidRequest, "`initialize` comes once"),
            ("shutdown", Phase::Talking(_)) => {
                self.phase = Phase::ShutDown;
                Ok(Value::Null)
            }
            _ => refuse(
                ErrorCode::InvalidRequest,
                "nothing but `exit` comes after `shutdown`",
            ),
        };
        response(request.id, answer)
    }

    fn initialize(&mut self, params: &Value) -> Value {
        let client = Client::new(params);
        self.phase = Phase::Talking(client);
        json!({
            "capabilities": convert::capabilities(&client),
            "serverInfo": { "name": "pinhole", "version": env!("CARGO_PKG_VERSION") },
        })
    }

    /// Handles a notification. Returns the messages to send.
    fn handle_notification(&mut self, notification: Notification) -> Vec<Message> {
        let Notification { method, params } = notification;
        if method == "exit" {
            let properly = matches!(self.phase, Phase::ShutDown);
            self.phase = Phase::Ended { properly };
        }
        let Phase::Talking(client) = self.phase else {
            return Vec::new();
        };
        let about = params.pointer("/textDocument/uri").and_then(Value::as_str);
        let about = about.map(|uri| Uri(uri.to_owned()));
        let mut outgoing = Vec::new();
        if method.starts_with("textDocument/did") {
            outgoing = self.answer_all(|uri| uri.is_some() && uri == about.as_ref());
        }
        let handled = match method.as_str() {
            "textDocument/didOpen" => self.open(&params, &client),
            "textDocument/didChange" => self.change(&params),
            "textDocument/didClose" => self.close(&params),
            "$/cancelRequest" => Ok(self.cancel(&params).into_iter().collect()),
            // Other notifications are ignored, as the protocol allows.
            _ => Ok(Vec::new()),
        };
        match handled {
            Ok(more) => outgoing.extend(more),
            Err(Refusal(_, message)) => (self.log)(&format!("{method}: {message}")),
        }
        outgoing
    }

    fn open(&mut self, params: &Value, client: &Client) -> Result<Vec<Message>, Refusal> {
        let uri: Uri = at(params, "/textDocument/uri")?;
        let version = at(params, "/textDocument/version")?;
        let text = at(params, "/textDocument/text")?;
        let name = uri.0.rsplit('/').next().unwrap_or_default().to_owned();
        self.changed.insert(uri.0.clone());
        let document = Document::new(&name, version, text, client.encoding);
        let outgoing = self.forget(&uri);
        self.documents.insert(uri, document);
        Ok(outgoing)
    }

    fn change(&mut self, params: &Value) -> Result<Vec<Message>, Refusal> {
        let refuse = |message| Err(Refusal::invalid(message));
        let uri: Uri = at(params, "/textDocument/uri")?;
        let version = at(params, "/textDocument/version")?;
        let changes = convert::changes(params)?;
        let Some(document) = self.documents.get_mut(&uri) else {
            return refuse(format!("{} is not open", uri.0));
        };
        // An older version must not overwrite a newer one.
        if version < document.version {
            return refuse(format!("version {version} of {} is stale", uri.0));
        }
        if let Err(message) = document.change(version, &changes) {
            return refuse(message);
        }
        let outgoing = self.outdate(&uri);
        self.changed.insert(uri.0);
        Ok(outgoing)
    }

    fn close(&mut self, params: &Value) -> Result<Vec<Message>, Refusal> {
        let uri: Uri = at(params, "/textDocument/uri")?;
        self.documents.remove(&uri);
        let outgoing = self.forget(&uri);
        self.changed.insert(uri.0);
        Ok(outgoing)
    }

    /// Cancels a waiting request or an unfinished frame. Returns the error response to the
    /// cancelled request, or `None` if there is no such request.
    fn cancel(&mut self, params: &Value) -> Option<Message> {
        let id = params.get("id").cloned().unwrap_or_default();
        let id: RequestId = serde_json::from_value(id).ok()?;
        let place = self.waiting.iter().position(|request| request.id == id);
        let was_waiting = place.and_then(|place| self.waiting.remove(place)).is_some();
        (was_waiting || self.frames.cancel(&id)).then(|| cancelled(id))
    }
}

fn cancelled(id: RequestId) -> Message {
    response(id, Err(Refusal::cancelled()))
}

fn published(params: Value) -> Message {
    Notification::new("textDocument/publishDiagnostics".to_owned(), params).into()
}

/// Returns whether a request is `initialize` or `shutdown`.
fn is_lifecycle(request: &Request) -> bool {
    matches!(request.method.as_str(), "initialize" | "shutdown")
}

/// Returns the URI of the document that a request is about; `None` if it is about no document.
fn uri(request: &Request) -> Option<Uri> {
    let uri = request.params.pointer("/textDocument/uri")?.as_str()?;
    Some(Uri(uri.to_owned()))
}

/// Calls `answer` and returns its result. If `answer` panics, returns an internal error. The server
/// can continue after a panic: computing an answer changes no text, and the next request may
/// succeed.
///
/// # Errors
///
/// Returns an error if `answer` fails or panics.
pub fn catch_panics<T>(answer: impl FnOnce() -> Result<T, Refusal>) -> Result<T, Refusal> {
    panic::catch_unwind(AssertUnwindSafe(answer)).unwrap_or_else(|_| {
        let message = "the answer failed, which is a mistake of Pinhole".to_owned();
        Err(Refusal(ErrorCode::InternalError, message))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_that_fails_is_an_answer() {
        let answer = catch_panics::<Value>(|| panic!("on purpose"));
        let code = answer.err().map(|Refusal(code, _)| code as i32);
        assert_eq!(code, Some(ErrorCode::InternalError as i32));
    }
}
