//! The loop: messages in, answers out, in their order and on one thread.
//!
//! A thread of its own does nothing but read, so that the loop sees all that has come before it answers the first: what was
//! cancelled in the meantime is not computed, and of several states of a text only the last is judged. Answers are functions of
//! the text at the moment of the request; nothing is kept but the texts.

mod answers;

use std::{
    collections::{BTreeSet, HashMap},
    io::{self, BufReader, ErrorKind, Read, Write},
    panic::{self, AssertUnwindSafe},
    sync::mpsc::{self, Receiver},
    thread,
};

use gen_lsp_types as lsp;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use serde_json::Value;

use self::answers::{answer, diagnostics};
use super::{
    convert::{self, Client, Page},
    documents::{Document, Encoding},
};
use crate::editor::Analysis;

/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// The client took its leave.
    Properly,
    /// It did not: it ended without `shutdown`.
    Abruptly,
}

/// Talks to a client until it ends. What cannot be understood is said to `log`.
pub fn serve(
    input: impl Read + Send + 'static,
    output: &mut impl Write,
    log: fn(&str),
) -> io::Result<Ended> {
    let messages = listen(input, log);
    let mut server = Server {
        output,
        log,
        phase: Phase::Silent,
        documents: HashMap::new(),
        changed: BTreeSet::new(),
    };
    // All that waits, from the first message on.
    while let Ok(first) = messages.recv() {
        let batch: Vec<Message> = [first].into_iter().chain(messages.try_iter()).collect();
        if let Some(ended) = server.take(batch)? {
            return Ok(ended);
        }
    }
    // The client is gone.
    Ok(match server.phase {
        Phase::ShutDown => Ended::Properly,
        Phase::Silent | Phase::Talking(_) => Ended::Abruptly,
    })
}

/// Reads on a thread of its own.
fn listen(input: impl Read + Send + 'static, log: fn(&str)) -> Receiver<Message> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let mut input = BufReader::new(input);
        loop {
            match Message::read(&mut input) {
                Ok(Some(message)) => {
                    let is_exit =
                        matches!(&message, Message::Notification(n) if n.method == "exit");
                    // Behind `exit` nobody listens any more.
                    if sender.send(message).is_err() || is_exit {
                        return;
                    }
                }
                Ok(None) => return,
                // The next message may be a right one.
                Err(error) if error.kind() == ErrorKind::InvalidData => log(&error.to_string()),
                Err(error) => {
                    log(&error.to_string());
                    return;
                }
            }
        }
    });
    receiver
}

/// What has been said so far.
enum Phase {
    /// Nothing: the client has not introduced itself.
    Silent,
    /// The client has introduced itself.
    Talking(Client),
    /// The client has asked to shut down.
    ShutDown,
}

struct Server<'o, W> {
    output: &'o mut W,
    log: fn(&str),
    phase: Phase,
    documents: HashMap<lsp::Uri, Document>,
    /// The documents whose diagnostics are to be told.
    changed: BTreeSet<String>,
}

/// Why a request gets no answer.
struct Refusal(ErrorCode, String);

impl<W: Write> Server<'_, W> {
    /// Takes messages in their order; answers with the end, if it comes.
    fn take(&mut self, batch: Vec<Message>) -> io::Result<Option<Ended>> {
        let cancelled: Vec<RequestId> = batch.iter().filter_map(cancelled).collect();
        let mut requests = Vec::new();
        for message in batch {
            match message {
                Message::Request(request) => requests.push(request),
                Message::Notification(notification) => {
                    // What was asked before a change is about the text before it.
                    self.answer_all(std::mem::take(&mut requests), &cancelled)?;
                    if notification.method == "exit" {
                        return Ok(Some(match self.phase {
                            Phase::ShutDown => Ended::Properly,
                            Phase::Silent | Phase::Talking(_) => Ended::Abruptly,
                        }));
                    }
                    self.notice(notification);
                }
                // Nothing was asked of the client.
                Message::Response(_) => {}
            }
        }
        self.answer_all(requests, &cancelled)?;
        self.publish()?;
        Ok(None)
    }

    fn send(&mut self, message: impl Into<Message>) -> io::Result<()> {
        message.into().write(self.output)
    }

    /// Answers requests between which no text changes: each text is read once.
    fn answer_all(&mut self, requests: Vec<Request>, cancelled: &[RequestId]) -> io::Result<()> {
        let mut requests = requests.into_iter().peekable();
        while let Some(first) = requests.next() {
            let client = match &self.phase {
                Phase::Talking(client) if !is_of_life(&first) => *client,
                _ => {
                    let response = self.answer_about_life(first);
                    self.send(response)?;
                    continue;
                }
            };
            let uri = uri(&first);
            let document = uri.as_ref().and_then(|uri| self.documents.get(uri));
            let page = uri.as_ref().zip(document);
            let page = page.map(|(uri, document)| Page {
                client: &client,
                uri,
                document,
            });
            let analysis = page.map(|page| Analysis::new(&page.document.sources));
            let mut request = Some(first);
            while let Some(asked) = request {
                let id = asked.id.clone();
                let answer = match cancelled.contains(&id) {
                    true => Err(Refusal(ErrorCode::RequestCanceled, "cancelled".to_owned())),
                    false => unharmed(|| answer(asked, page.zip(analysis.as_ref()))),
                };
                // Of this text, the next one too.
                Message::from(response(id, answer)).write(self.output)?;
                request = requests.next_if(|next| !is_of_life(next) && self::uri(next) == uri);
            }
        }
        Ok(())
    }

    /// The requests that begin and end a conversation, and all others before and after it.
    fn answer_about_life(&mut self, request: Request) -> Response {
        let id = request.id;
        let refuse = |code, message: &str| Err(Refusal(code, message.to_owned()));
        let answer = match (request.method.as_str(), &self.phase) {
            ("initialize", Phase::Silent) => self.initialize(request.params),
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
        response(id, answer)
    }

    fn initialize(&mut self, params: Value) -> Result<Value, Refusal> {
        let params: lsp::InitializeParams = parsed(params)?;
        let client = Client::new(&params.capabilities);
        let result = lsp::InitializeResult {
            capabilities: convert::capabilities(&client),
            server_info: Some(lsp::ServerInfo {
                name: "pinhole".to_owned(),
                version: Some(env!("CARGO_PKG_VERSION").to_owned()),
            }),
        };
        self.phase = Phase::Talking(client);
        written(result)
    }

    /// What the client tells: texts that are opened, changed and closed.
    fn notice(&mut self, notification: Notification) {
        let Phase::Talking(client) = &self.phase else {
            return;
        };
        let encoding = client.encoding;
        let method = notification.method.clone();
        let noticed = match method.as_str() {
            "textDocument/didOpen" => parsed(notification.params).map(|params| self.open(params)),
            "textDocument/didChange" => {
                parsed(notification.params).map(|params| self.change(params, encoding))
            }
            "textDocument/didClose" => parsed(notification.params).map(|params| self.close(params)),
            // Others are for servers that know more.
            _ => Ok(()),
        };
        if let Err(Refusal(_, message)) = noticed {
            (self.log)(&format!("{method}: {message}"));
        }
    }

    fn open(&mut self, params: lsp::DidOpenTextDocumentParams) {
        let lsp::TextDocumentItem {
            uri, version, text, ..
        } = params.text_document;
        let name = uri.0.rsplit('/').next().unwrap_or_default().to_owned();
        self.changed.insert(uri.0.clone());
        self.documents
            .insert(uri, Document::new(&name, version, text));
    }

    fn change(&mut self, params: lsp::DidChangeTextDocumentParams, encoding: Encoding) {
        let lsp::VersionedTextDocumentIdentifier {
            version,
            text_document_identifier,
        } = params.text_document;
        let uri = text_document_identifier.uri;
        match self.documents.get_mut(&uri) {
            // An old state that comes late would be put on top of a newer one.
            Some(document) if version < document.version => {
                (self.log)(&format!("version {version} of {} is stale", uri.0));
            }
            Some(document) => {
                let changes = params.content_changes.into_iter().map(convert::change);
                document.change(version, changes.collect(), encoding);
                self.changed.insert(uri.0);
            }
            None => (self.log)(&format!("{} is not open", uri.0)),
        }
    }

    fn close(&mut self, params: lsp::DidCloseTextDocumentParams) {
        let uri = params.text_document.uri;
        self.documents.remove(&uri);
        self.changed.insert(uri.0);
    }

    /// Tells the diagnostics of every text that has changed; none of one that was closed. A client that asks for them is
    /// not told.
    fn publish(&mut self) -> io::Result<()> {
        let changed = std::mem::take(&mut self.changed);
        let Phase::Talking(client) = &self.phase else {
            return Ok(());
        };
        if client.pulls_diagnostics {
            return Ok(());
        }
        for uri in changed {
            let uri = lsp::Uri(uri);
            let document = self.documents.get(&uri);
            let diagnostics = document.map(|document| {
                let page = Page {
                    client,
                    uri: &uri,
                    document,
                };
                diagnostics(page, &Analysis::new(&document.sources))
            });
            let params = lsp::PublishDiagnosticsParams {
                version: document.map(|document| document.version),
                diagnostics: diagnostics.unwrap_or_default(),
                uri,
            };
            let method = "textDocument/publishDiagnostics".to_owned();
            Message::from(Notification::new(method, params)).write(self.output)?;
        }
        Ok(())
    }
}

/// The request that a message cancels.
fn cancelled(message: &Message) -> Option<RequestId> {
    match message {
        Message::Notification(notification) if notification.method == "$/cancelRequest" => {
            serde_json::from_value(notification.params.get("id")?.clone()).ok()
        }
        _ => None,
    }
}

/// Whether a request is about the conversation itself.
fn is_of_life(request: &Request) -> bool {
    matches!(request.method.as_str(), "initialize" | "shutdown")
}

/// The document that a request is about.
fn uri(request: &Request) -> Option<lsp::Uri> {
    let uri = request.params.get("textDocument")?.get("uri")?.as_str()?;
    Some(lsp::Uri(uri.to_owned()))
}

/// An answer, or the refusal if giving it failed: the next request may fare better, and no text is touched by an answer.
fn unharmed(answer: impl FnOnce() -> Result<Value, Refusal>) -> Result<Value, Refusal> {
    panic::catch_unwind(AssertUnwindSafe(answer)).unwrap_or_else(|_| {
        let message = "the answer failed, which is a mistake of Pinhole".to_owned();
        Err(Refusal(ErrorCode::InternalError, message))
    })
}

fn response(id: RequestId, answer: Result<Value, Refusal>) -> Response {
    match answer {
        Ok(result) => Response::new_ok(id, result),
        Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
    }
}

fn parsed<T: serde::de::DeserializeOwned>(params: Value) -> Result<T, Refusal> {
    serde_json::from_value(params)
        .map_err(|error| Refusal(ErrorCode::InvalidParams, error.to_string()))
}

fn written(result: impl serde::Serialize) -> Result<Value, Refusal> {
    serde_json::to_value(result)
        .map_err(|error| Refusal(ErrorCode::InternalError, error.to_string()))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn request(id: i32, method: &str, params: Value) -> Message {
        Request::new(id.into(), method.to_owned(), params).into()
    }

    fn notification(method: &str, params: Value) -> Message {
        Notification::new(method.to_owned(), params).into()
    }

    fn open(text: &str) -> Message {
        let document =
            json!({ "uri": "file:///a.scn", "languageId": "scn", "version": 1, "text": text });
        notification("textDocument/didOpen", json!({ "textDocument": document }))
    }

    fn change(version: i32, text: &str) -> Message {
        let document = json!({ "uri": "file:///a.scn", "version": version });
        let changes = json!([{ "text": text }]);
        notification(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": changes }),
        )
    }

    fn hover(id: i32) -> Message {
        let position = json!({ "line": 0, "character": 4 });
        let document = json!({ "uri": "file:///a.scn" });
        request(
            id,
            "textDocument/hover",
            json!({ "textDocument": document, "position": position }),
        )
    }

    /// What is answered to messages that have all come before the first is taken.
    fn answers(capabilities: Value, messages: Vec<Message>) -> Vec<Value> {
        let mut output = Vec::new();
        let mut server = Server {
            output: &mut output,
            log: |_| {},
            phase: Phase::Silent,
            documents: HashMap::new(),
            changed: BTreeSet::new(),
        };
        let hello = request(0, "initialize", json!({ "capabilities": capabilities }));
        for batch in [vec![hello], messages] {
            server.take(batch).expect("a vector takes everything");
        }
        let mut output = output.as_slice();
        let mut answers = Vec::new();
        while let Some(message) = Message::read(&mut output).expect("a message") {
            answers.push(serde_json::to_value(message).expect("a value"));
        }
        answers.split_off(1)
    }

    #[test]
    fn what_was_cancelled_in_the_meantime_is_not_answered() {
        let cancel = notification("$/cancelRequest", json!({ "id": 1 }));
        let found = answers(
            json!({}),
            vec![open("let a = 1"), hover(1), hover(2), cancel],
        );
        assert_eq!(found[0]["id"], 1);
        assert_eq!(found[0]["error"]["code"], -32800);
        assert_eq!(found[1]["id"], 2);
        assert_eq!(found[1]["result"]["range"]["start"]["character"], 4);
    }

    #[test]
    fn of_several_states_the_last_is_judged_and_each_request_is_about_its_own() {
        let messages = vec![
            open("let a = 1"),
            hover(1),
            change(2, "let b = oops"),
            hover(2),
            change(3, "let c = 3"),
            // It comes too late to count.
            change(2, "let d = oops"),
            hover(3),
        ];
        let found = answers(json!({}), messages);
        for (answer, name) in found
            .iter()
            .zip(["`let a = 1`", "`let b = oops`", "`let c = 3`"])
        {
            let text = answer["result"]["contents"]["value"].to_string();
            assert!(text.contains(&name.replace('`', "")), "{answer}");
        }
        assert_eq!(found.len(), 4);
        assert_eq!(found[3]["method"], "textDocument/publishDiagnostics");
        assert_eq!(found[3]["params"]["version"], 3);
        let codes: Vec<&Value> = found[3]["params"]["diagnostics"]
            .as_array()
            .expect("a list")
            .iter()
            .map(|diagnostic| &diagnostic["code"])
            .collect();
        assert_eq!(codes, ["pinhole::missing_camera", "pinhole::no_objects"]);
    }

    #[test]
    fn a_client_that_asks_for_diagnostics_is_not_told() {
        let capabilities = json!({ "textDocument": { "diagnostic": {} } });
        let params = json!({ "textDocument": { "uri": "file:///a.scn" } });
        let ask = request(1, "textDocument/diagnostic", params);
        let found = answers(capabilities, vec![open("let a = oops"), ask]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0]["result"]["kind"], "full");
        assert_eq!(
            found[0]["result"]["items"][2]["code"],
            "pinhole::unknown_name"
        );
    }

    #[test]
    fn an_answer_that_fails_is_an_answer() {
        let refusal = unharmed(|| panic!("on purpose")).expect_err("it failed");
        assert_eq!(refusal.0 as i32, ErrorCode::InternalError as i32);
    }
}
