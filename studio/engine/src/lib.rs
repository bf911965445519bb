//! The engine in the browser: the conversation that `docs/protocol.md` describes, as texts that a web worker passes to and from the page.

use std::sync::atomic::AtomicBool;

use lsp_server::{Message, Notification};
use pinhole::{
    lsp::{
        Server,
        messages::{self, Malformed},
    },
    scene::SMALLEST,
    studio::download,
};
use serde_json::json;
use wasm_bindgen::prelude::wasm_bindgen;

/// A conversation with one page.
#[wasm_bindgen]
pub struct Engine {
    server: Server,
}

#[wasm_bindgen]
impl Engine {
    /// An engine that nobody has spoken to.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self {
            server: Server::new(|_| {}),
        }
    }

    /// What it says first: there is no file, and a new scene.
    pub fn greeting(&self) -> String {
        let params = json!({ "name": "scene.scn", "text": SMALLEST, "saved": false });
        messages::written(&Notification::new("studio/file".to_owned(), params).into())
    }

    /// Takes a message in, and returns what has to be said before anything else.
    pub fn handle(&mut self, text: &str) -> Vec<String> {
        match messages::read(text.as_bytes()) {
            Ok(Message::Request(request)) if download::is_asked_for(&request) => {
                texts(vec![download::answer(request, &AtomicBool::new(false))])
            }
            Ok(message) => texts(self.server.handle(message)),
            Err(Malformed::Answered(response)) => vec![response.to_string()],
            Err(Malformed::Unanswered(_)) => Vec::new(),
        }
    }

    /// Does a slice of the work that is left, and returns what is to be said of it.
    pub fn advance(&mut self) -> Vec<String> {
        texts(self.server.advance())
    }

    /// Whether there is work left.
    #[wasm_bindgen(js_name = isBusy)]
    pub fn is_busy(&self) -> bool {
        self.server.is_busy()
    }
}

impl Default for Engine {
    fn default() -> Self {
        Self::new()
    }
}

fn texts(messages: Vec<Message>) -> Vec<String> {
    messages.iter().map(messages::written).collect()
}
