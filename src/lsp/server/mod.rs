//! The loop: messages in, answers out, in their order and on one thread.
//!
//! Answers are functions of a text at the moment of the request. What a text means is found once and kept as long as nothing but
//! requests about it comes; of several states of a text that wait, only the last is judged.

mod answers;
mod inbox;

use std::{
    collections::{BTreeSet, HashMap},
    io::{self, Read, Write},
    panic::{self, AssertUnwindSafe},
};

use gen_lsp_types as lsp;
use lsp_server::{ErrorCode, Message, Notification, Request, RequestId};
use serde_json::{Value, json};

use self::{
    answers::{answer, diagnostics},
    inbox::Inbox,
};
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
    let mut inbox = Inbox::read(input, log);
    let mut server = Server {
        output,
        log,
        phase: Phase::Silent,
        documents: HashMap::new(),
        changed: BTreeSet::new(),
    };
    server.run(&mut inbox)
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

/// A result as JSON, written at once: an answer of thousands of tokens needs no tree of values in between.
type Answer = Result<String, Refusal>;

impl<W: Write> Server<'_, W> {
    /// Takes messages in their order until the end comes, or the client is gone.
    fn run(&mut self, inbox: &mut Inbox) -> io::Result<Ended> {
        loop {
            self.publish(inbox)?;
            match inbox.next() {
                Some(Message::Request(request)) => match &self.phase {
                    Phase::Talking(client) if !is_of_life(&request) => {
                        let client = *client;
                        let uri = uri(&request);
                        self.dwell(&client, uri, Some(request), inbox)?;
                    }
                    _ => self.answer_about_life(request)?,
                },
                Some(Message::Notification(notification)) if notification.method != "exit" => {
                    self.notice(notification);
                }
                // Nothing was asked of the client.
                Some(Message::Response(_)) => {}
                Some(Message::Notification(_)) | None => {
                    return Ok(match self.phase {
                        Phase::ShutDown => Ended::Properly,
                        Phase::Silent | Phase::Talking(_) => Ended::Abruptly,
                    });
                }
            }
        }
    }

    /// Tells the diagnostics of the texts that have changed, as soon as nothing else waits.
    fn publish(&mut self, inbox: &mut Inbox) -> io::Result<()> {
        let Phase::Talking(client) = self.phase else {
            return Ok(());
        };
        if client.pulls_diagnostics {
            self.changed.clear();
        }
        while inbox.is_empty()
            && let Some(uri) = self.changed.first()
        {
            let uri = lsp::Uri(uri.clone());
            if self.documents.contains_key(&uri) {
                self.dwell(&client, Some(uri), None, inbox)?;
            } else {
                self.changed.remove(&uri.0);
                publish(self.output, &uri, None, &[])?;
            }
        }
        Ok(())
    }

    /// Stays with a document: finds out what it means, and answers until something comes that is about something else.
    fn dwell(
        &mut self,
        client: &Client,
        uri: Option<lsp::Uri>,
        first: Option<Request>,
        inbox: &mut Inbox,
    ) -> io::Result<()> {
        let document = uri.as_ref().and_then(|uri| self.documents.get(uri));
        let page = uri.as_ref().zip(document).map(|(uri, document)| Page {
            client,
            uri,
            document,
        });
        let analysis = page.map(|page| Analysis::new(&page.document.sources));
        let known = page.zip(analysis.as_ref());
        let mut next = first;
        loop {
            if let Some(request) = next {
                let id = request.id.clone();
                let answer = match inbox.is_cancelled(&id) {
                    true => Err(Refusal(ErrorCode::RequestCanceled, "cancelled".to_owned())),
                    false => unharmed(|| answer(request, known)),
                };
                respond(self.output, &id, answer)?;
            }
            if inbox.is_empty() {
                if let Some((page, analysis)) = known
                    && self.changed.remove(&page.uri.0)
                {
                    let found = diagnostics(page, analysis);
                    publish(self.output, page.uri, Some(page.document.version), &found)?;
                }
                if !self.changed.is_empty() {
                    // Other texts wait to be judged.
                    return Ok(());
                }
            }
            let is_about_it = |next: &Request| !is_of_life(next) && self::uri(next) == uri;
            next = inbox.next_if(is_about_it);
            if next.is_none() {
                return Ok(());
            }
        }
    }

    /// The requests that begin and end a conversation, and all others before and after it.
    fn answer_about_life(&mut self, request: Request) -> io::Result<()> {
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
                Ok("null".to_owned())
            }
            _ => refuse(
                ErrorCode::InvalidRequest,
                "nothing but `exit` comes after `shutdown`",
            ),
        };
        respond(self.output, &id, answer)
    }

    fn initialize(&mut self, params: Value) -> Answer {
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
        written(&result)
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
}

/// Writes a response.
fn respond(output: &mut impl Write, id: &RequestId, answer: Answer) -> io::Result<()> {
    let id = json!(id);
    send(
        output,
        &match answer {
            Ok(result) => format!("{{\"jsonrpc\":\"2.0\",\"id\":{id},\"result\":{result}}}"),
            Err(Refusal(code, message)) => {
                let error = json!({ "code": code as i32, "message": message });
                json!({ "jsonrpc": "2.0", "id": id, "error": error }).to_string()
            }
        },
    )
}

/// Writes what is wrong with a text; nothing is with one that was closed.
fn publish(
    output: &mut impl Write,
    uri: &lsp::Uri,
    version: Option<i32>,
    diagnostics: &[lsp::Diagnostic],
) -> io::Result<()> {
    let mut params = json!({ "uri": uri, "diagnostics": diagnostics });
    if let Some(version) = version {
        params["version"] = version.into();
    }
    let method = "textDocument/publishDiagnostics";
    let message = json!({ "jsonrpc": "2.0", "method": method, "params": params });
    send(output, &message.to_string())
}

fn send(output: &mut impl Write, message: &str) -> io::Result<()> {
    write!(output, "Content-Length: {}\r\n\r\n{message}", message.len())?;
    output.flush()
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
fn unharmed(answer: impl FnOnce() -> Answer) -> Answer {
    panic::catch_unwind(AssertUnwindSafe(answer)).unwrap_or_else(|_| {
        let message = "the answer failed, which is a mistake of Pinhole".to_owned();
        Err(Refusal(ErrorCode::InternalError, message))
    })
}

fn parsed<T: serde::de::DeserializeOwned>(params: Value) -> Result<T, Refusal> {
    serde_json::from_value(params)
        .map_err(|error| Refusal(ErrorCode::InvalidParams, error.to_string()))
}

fn written(result: &impl serde::Serialize) -> Answer {
    serde_json::to_string(result)
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
        let (sender, receiver) = std::sync::mpsc::channel();
        let hello = request(0, "initialize", json!({ "capabilities": capabilities }));
        for message in [hello].into_iter().chain(messages) {
            sender.send(message).expect("it is kept");
        }
        drop(sender);
        let mut output = Vec::new();
        let mut server = Server {
            output: &mut output,
            log: |_| {},
            phase: Phase::Silent,
            documents: HashMap::new(),
            changed: BTreeSet::new(),
        };
        let ended = server.run(&mut Inbox::new(receiver));
        assert_eq!(ended.expect("a vector takes everything"), Ended::Abruptly);
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
        let answer = unharmed(|| panic!("on purpose"));
        let code = answer.err().map(|Refusal(code, _)| code as i32);
        assert_eq!(code, Some(ErrorCode::InternalError as i32));
    }
}
