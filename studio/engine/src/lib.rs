//! The engine in the browser. It exchanges the messages that `docs/protocol.md` describes with the
//! page. A web worker runs the engine and passes the messages on.

use lsp_server::{Message, Notification};
use pinhole::{
    lsp::{
        Refusal, Server,
        messages::{self, Malformed},
        response,
    },
    scene::SMALLEST,
    studio::download::{self, Sliced},
};
use serde_json::json;
use wasm_bindgen::prelude::wasm_bindgen;

/// The engine for one page: a language server, and at most one download.
#[wasm_bindgen]
pub struct Engine {
    server: Server,
    /// Download whose picture is being rendered to a file.
    download: Option<Sliced>,
}

#[wasm_bindgen]
impl Engine {
    /// Makes an engine that waits for messages.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self {
            server: Server::new(|_| {}),
            download: None,
        }
    }

    /// Returns the first message of the protocol: `studio/file` with a new scene, which has no file
    /// yet.
    pub fn greeting(&self) -> String {
        let params = json!({ "name": "scene.scn", "text": SMALLEST, "saved": false });
        messages::to_text(&Notification::new("studio/file".to_owned(), params).into())
    }

    /// Handles a message from the page. Returns the messages that must be sent to the page before
    /// any others.
    pub fn handle(&mut self, text: &str) -> Vec<String> {
        match messages::read(text.as_bytes()) {
            Ok(Message::Request(request)) if download::is_asked_for(&request) => {
                let begun = match self.download {
                    Some(_) => Err(Refusal::failed("another picture is being made")),
                    None => Sliced::new(&request),
                };
                match begun {
                    Ok(download) => {
                        self.download = Some(download);
                        Vec::new()
                    }
                    Err(refusal) => texts(vec![response(request.id, Err(refusal))]),
                }
            }
            Ok(message) => {
                let mut said = Vec::from_iter(self.cancelled(&message));
                said.extend(self.server.handle(message));
                texts(said)
            }
            Err(Malformed::Answered(response)) => vec![response.to_string()],
            Err(Malformed::Unanswered(_)) => Vec::new(),
        }
    }

    /// Does a slice of the work that is left, so that the worker can handle messages between
    /// slices. Returns the messages to send to the page.
    pub fn advance(&mut self) -> Vec<String> {
        match &mut self.download {
            Some(download) if !self.server.is_busy() => {
                let (said, is_done) = download.advance();
                self.download.take_if(|_| is_done);
                texts(vec![said])
            }
            _ => texts(self.server.advance()),
        }
    }

    /// Returns whether any work is left.
    #[wasm_bindgen(js_name = isBusy)]
    pub fn is_busy(&self) -> bool {
        self.server.is_busy() || self.download.is_some()
    }
}

impl Engine {
    /// Stops the download if `message` is the notification that cancels it. Returns the error
    /// response to the request for the download; `None` if `message` is anything else.
    fn cancelled(&mut self, message: &Message) -> Option<Message> {
        let Message::Notification(Notification { method, params }) = message else {
            return None;
        };
        let is_meant = |download: &mut Sliced| {
            method == "$/cancelRequest" && params["id"] == json!(download.request)
        };
        let download = self.download.take_if(is_meant)?;
        Some(response(download.request, Err(Refusal::cancelled())))
    }
}

impl Default for Engine {
    fn default() -> Self {
        Self::new()
    }
}

fn texts(messages: Vec<Message>) -> Vec<String> {
    messages.iter().map(messages::to_text).collect()
}
