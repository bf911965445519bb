//! The loop: messages in, answers out, in their order and on one thread.
//!
//! Answers are functions of a text at the moment of the request. What a text means is found once and kept as long as nothing but
//! requests about it comes; of several states of a text that wait, only the last is judged.

mod answers;
mod inbox;
mod notices;
mod outbox;

use std::{
    collections::{BTreeSet, HashMap},
    io::{self, Read, Write},
    panic::{self, AssertUnwindSafe},
    path::PathBuf,
};

use gen_lsp_types as lsp;
use lsp_server::{ErrorCode, Message, Request};
use serde_json::Value;

use self::{
    answers::{answer, diagnostics},
    inbox::{Inbox, Malformed},
    outbox::{Answer, Refusal, parsed, publish, respond, written},
};
use super::{
    convert::{self, Client, Page},
    documents::Document,
    pages::Pages,
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

/// Talks to a client until it ends. What cannot be understood is said to `log`. The pages of [`crate::explain`] that diagnostics link to
/// are written to the folder `pages`, an absolute path, as they are needed; without it, or where that fails, nothing is linked.
///
/// # Errors
///
/// The output cannot be written to.
pub fn serve(
    input: impl Read + Send + 'static,
    output: &mut dyn Write,
    pages: Option<PathBuf>,
    log: fn(&str),
) -> io::Result<Ended> {
    let mut inbox = Inbox::read(input, log);
    Server::new(output, Pages::new(pages), log).run(&mut inbox)
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

struct Server<'o> {
    output: &'o mut dyn Write,
    log: fn(&str),
    phase: Phase,
    documents: HashMap<lsp::Uri, Document>,
    /// The documents whose diagnostics are to be told.
    changed: BTreeSet<String>,
    pages: Pages,
}

impl<'o> Server<'o> {
    fn new(output: &'o mut dyn Write, pages: Pages, log: fn(&str)) -> Self {
        Self {
            output,
            log,
            phase: Phase::Silent,
            documents: HashMap::new(),
            changed: BTreeSet::new(),
            pages,
        }
    }

    /// Takes messages in their order until the end comes, or the client is gone.
    fn run(&mut self, inbox: &mut Inbox) -> io::Result<Ended> {
        loop {
            self.publish(inbox)?;
            let message = match inbox.next() {
                Some(Ok(message)) => Some(message),
                Some(Err(malformed)) => {
                    let Malformed { id, code, message } = malformed;
                    respond(self.output, &id, Err(Refusal(code, message)))?;
                    continue;
                }
                None => None,
            };
            match message {
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
            pages: &self.pages,
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
        let client = Client::new(&params);
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

#[cfg(test)]
mod tests;
