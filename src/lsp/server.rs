//! The server as a value: messages in, messages out.
//!
//! What a client tells is taken in at once, and what it asks is put into a queue, of which
//! [`Server::advance`] answers a slice; so a host can see what has come in the meantime, as a
//! request's cancelling. Each answer is about the text as it was when it was asked for: before a
//! text changes, what waits about it is answered. Diagnostics are computed for a text's last
//! version alone. A frame, which takes longer than all else, is made in slices when nothing else is
//! to be done, and given up where its text changes, unless it was asked for by `last`.

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

/// How far a conversation has come.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The client has not introduced itself.
    Silent,
    /// The client has introduced itself.
    Talking(Client),
    /// The client has asked to shut down.
    ShutDown,
    /// The client has said `exit`, after `shutdown` or not.
    Ended { properly: bool },
}

/// A language server that is talking to one client.
#[derive(Debug)]
pub struct Server {
    phase: Phase,
    documents: HashMap<Uri, Document>,
    /// The requests that have no answer yet.
    waiting: VecDeque<Request>,
    /// The documents whose diagnostics are to be told.
    changed: BTreeSet<String>,
    /// What the pictures of documents are made from, where one was asked for; none where a text
    /// has errors.
    scenes: HashMap<Uri, Option<SceneVersion>>,
    /// Of each text that has changed, the last version without errors before that.
    last: HashMap<Uri, Option<SceneVersion>>,
    frames: Frames,
    log: fn(&str),
}

impl Server {
    /// A server that nobody has spoken to. What cannot be understood is said to `log`.
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

    /// Whether the conversation has ended properly, by `exit` after `shutdown`; none while it goes
    /// on.
    pub fn ended(&self) -> Option<bool> {
        match self.phase {
            Phase::Ended { properly } => Some(properly),
            _ => None,
        }
    }

    /// Takes a message in, and returns what has to be said before anything else.
    pub fn handle(&mut self, message: Message) -> Vec<Message> {
        match (message, &self.phase) {
            (Message::Request(request), Phase::Talking(_)) if !is_of_life(&request) => {
                self.waiting.push_back(request);
                Vec::new()
            }
            (Message::Request(request), _) => {
                let mut said = self.answer_all(|_| true);
                said.extend(self.frames.drop_of(None).into_iter().map(cancelled));
                said.push(self.answer_about_life(request));
                said
            }
            (Message::Notification(notification), _) => self.notice(notification),
            // Nothing was asked of the client.
            (Message::Response(_), _) => Vec::new(),
        }
    }

    /// Whether there is work left.
    pub fn is_busy(&self) -> bool {
        !self.waiting.is_empty() || !self.changed.is_empty() || !self.frames.is_empty()
    }

    /// Does a piece of the work that is left, and returns what is to be said of it. A piece is one
    /// text: everything that was asked about it, and what is wrong with it; or, where nothing
    /// else is left, a slice of a frame.
    pub fn advance(&mut self) -> Vec<Message> {
        let asked = self.waiting.front().map(uri);
        let changed = || self.changed.first().map(|uri| Some(Uri(uri.clone())));
        let Some(next) = asked.or_else(changed) else {
            return self.advance_frame().into_iter().collect();
        };
        let is_changed = next.as_ref().is_some_and(|uri| self.changed.remove(&uri.0));
        self.work_on(next.as_ref(), is_changed)
    }

    /// Answers what waits about such texts.
    fn answer_all(&mut self, is_about: impl Fn(Option<&Uri>) -> bool) -> Vec<Message> {
        let mut said = Vec::new();
        while let Some(request) = self.waiting.iter().find(|it| is_about(uri(it).as_ref())) {
            let uri = uri(request);
            said.extend(self.work_on(uri.as_ref(), false));
        }
        said
    }

    /// Answers what waits about a text, or about none, and tells what is wrong with it if it has
    /// changed.
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
        let mut said = Vec::new();
        for request in asked {
            let id = request.id.clone();
            let Some(about) = request.method.strip_prefix(picture_requests::NAMESPACE) else {
                let known = converter.zip(analysis.map(|analysis| &**analysis));
                said.push(response(id, unharmed(|| answer(request, known))));
                continue;
            };
            let Some((converter, analysis)) = converter.zip(analysis) else {
                said.push(response(id, Err(not_open())));
                continue;
            };
            let (uri, number) = (converter.uri.clone(), converter.document.version);
            let version = self.scenes.entry(uri.clone());
            let version = version.or_insert_with(|| SceneVersion::new(analysis, number));
            if version.is_some() && about == "frame" {
                // From now on this one is the last without errors.
                self.last.remove(&uri);
            }
            let params = &request.params;
            let wants_last = about == "frame" && params.get("last") == Some(&Value::Bool(true));
            let last = || self.last.get(&uri).filter(|_| wants_last)?.as_ref();
            let pictured = version.as_ref().or_else(last);
            match (pictured, about) {
                (Some(version), "frame") => {
                    let push = || self.frames.push(id.clone(), uri, params, version);
                    match unharmed(push) {
                        Ok(superseded) => said.extend(superseded.into_iter().map(cancelled)),
                        Err(refusal) => said.push(response(id, Err(refusal))),
                    }
                }
                _ => {
                    let answer =
                        || picture_requests::answer(about, params, converter, analysis, version);
                    said.push(response(id, unharmed(answer)));
                }
            }
        }
        if is_changed {
            let mut params = json!({ "uri": wanted, "diagnostics": [] });
            // Nothing is wrong with a text that was closed.
            if let Some((converter, analysis)) = converter.zip(analysis) {
                params["version"] = converter.document.version.into();
                params["diagnostics"] = json!(diagnostics(converter, analysis));
            }
            said.push(published(params));
        }
        said
    }

    /// Makes a slice of a frame. Says the frame if it is done.
    fn advance_frame(&mut self) -> Option<Message> {
        let id = self.frames.oldest()?;
        let (frames, scenes, last) = (&mut self.frames, &mut self.scenes, &mut self.last);
        let answer = unharmed(|| frames.advance(scenes, last)).transpose()?;
        self.frames.cancel(&id);
        Some(response(id, answer))
    }

    /// Keeps the last version without errors of a text that has changed.
    fn outdate(&mut self, uri: &Uri) -> Vec<Message> {
        let Some(version @ Some(_)) = self.scenes.remove(uri) else {
            // Frames that are made are of an earlier version, and go on.
            return Vec::new();
        };
        self.last.insert(uri.clone(), version);
        self.drop_frames(uri)
    }

    /// Forgets a text that has come or gone.
    fn forget(&mut self, uri: &Uri) -> Vec<Message> {
        self.scenes.remove(uri);
        self.last.remove(uri);
        self.drop_frames(uri)
    }

    /// Answers those who wait for a frame of a text that has changed.
    fn drop_frames(&mut self, uri: &Uri) -> Vec<Message> {
        let dropped = self.frames.drop_of(Some(uri)).into_iter();
        let changed = |id| {
            let message = "the text has changed".to_owned();
            response(id, Err(Refusal(ErrorCode::ContentModified, message)))
        };
        dropped.map(changed).collect()
    }

    /// The requests that begin and end a conversation, and all others before and after it.
    fn answer_about_life(&mut self, request: Request) -> Message {
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

    /// What a client tells without asking.
    fn notice(&mut self, notification: Notification) -> Vec<Message> {
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
        let mut said = Vec::new();
        if method.starts_with("textDocument/did") {
            said = self.answer_all(|uri| uri.is_some() && uri == about.as_ref());
        }
        let noticed = match method.as_str() {
            "textDocument/didOpen" => self.open(&params, &client),
            "textDocument/didChange" => self.change(&params),
            "textDocument/didClose" => self.close(&params),
            "$/cancelRequest" => Ok(self.cancel(&params).into_iter().collect()),
            // Others are for servers that know more.
            _ => Ok(Vec::new()),
        };
        match noticed {
            Ok(more) => said.extend(more),
            Err(Refusal(_, message)) => (self.log)(&format!("{method}: {message}")),
        }
        said
    }

    fn open(&mut self, params: &Value, client: &Client) -> Result<Vec<Message>, Refusal> {
        let uri: Uri = at(params, "/textDocument/uri")?;
        let version = at(params, "/textDocument/version")?;
        let text = at(params, "/textDocument/text")?;
        let name = uri.0.rsplit('/').next().unwrap_or_default().to_owned();
        self.changed.insert(uri.0.clone());
        let document = Document::new(&name, version, text, client.encoding);
        let said = self.forget(&uri);
        self.documents.insert(uri, document);
        Ok(said)
    }

    fn change(&mut self, params: &Value) -> Result<Vec<Message>, Refusal> {
        let refuse = |message| Err(Refusal::invalid(message));
        let uri: Uri = at(params, "/textDocument/uri")?;
        let version = at(params, "/textDocument/version")?;
        let changes = convert::changes(params)?;
        let Some(document) = self.documents.get_mut(&uri) else {
            return refuse(format!("{} is not open", uri.0));
        };
        // An old state that comes late would be put on top of a newer one.
        if version < document.version {
            return refuse(format!("version {version} of {} is stale", uri.0));
        }
        if let Err(message) = document.change(version, &changes) {
            return refuse(message);
        }
        let said = self.outdate(&uri);
        self.changed.insert(uri.0);
        Ok(said)
    }

    fn close(&mut self, params: &Value) -> Result<Vec<Message>, Refusal> {
        let uri: Uri = at(params, "/textDocument/uri")?;
        self.documents.remove(&uri);
        let said = self.forget(&uri);
        self.changed.insert(uri.0);
        Ok(said)
    }

    /// Says of a request that still waits, or of a frame that is not done, that it was cancelled.
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

/// Whether a request is about the conversation itself.
fn is_of_life(request: &Request) -> bool {
    matches!(request.method.as_str(), "initialize" | "shutdown")
}

/// The document that a request is about.
fn uri(request: &Request) -> Option<Uri> {
    let uri = request.params.pointer("/textDocument/uri")?.as_str()?;
    Some(Uri(uri.to_owned()))
}

/// An answer, or the refusal if giving it failed: the next request may fare better, and no text is
/// touched by an answer.
pub(crate) fn unharmed<T>(answer: impl FnOnce() -> Result<T, Refusal>) -> Result<T, Refusal> {
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
        let answer = unharmed::<Value>(|| panic!("on purpose"));
        let code = answer.err().map(|Refusal(code, _)| code as i32);
        assert_eq!(code, Some(ErrorCode::InternalError as i32));
    }
}
