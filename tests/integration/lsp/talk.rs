//! A conversation with a server in this process, so that it is known what it has done by when.

use std::collections::VecDeque;

use lsp_server::Message;
use pinhole::lsp::{Server, messages};
use serde_json::{Value, json};

use super::client::{Carrier, Client};

/// A conversation with one text open, of version 1.
pub type Talk = Client<Inside>;

/// A server, and what it has said and nobody has read.
pub struct Inside {
    server: Server,
    pub said: VecDeque<String>,
}

impl Inside {
    fn hear(&mut self, said: &[Message]) {
        self.said.extend(said.iter().map(messages::written));
    }

    /// One piece of work. Says whether there was any.
    pub fn step(&mut self) -> bool {
        let is_busy = self.server.is_busy();
        let said = self.server.advance();
        self.hear(&said);
        is_busy
    }
}

impl Carrier for Inside {
    const URI: &'static str = "file:///a.scn";

    fn write(&mut self, text: &str) {
        let message = messages::read(text.as_bytes()).expect("a message");
        let said = self.server.handle(message);
        self.hear(&said);
    }

    fn read(&mut self) -> String {
        while self.said.is_empty() {
            assert!(self.step(), "nothing more is said");
        }
        self.said.pop_front().expect("it was said")
    }
}

impl Talk {
    /// With a server that understands everything.
    pub fn with(text: &str) -> Self {
        Self::logged(text, |message| panic!("{message}"))
    }

    pub fn logged(text: &str, log: fn(&str)) -> Self {
        let mut talk = Self::new(Inside {
            server: Server::new(log),
            said: VecDeque::new(),
        });
        talk.open(json!({}), text);
        talk
    }

    /// Whether a request was answered already.
    pub fn has_answered(&self, id: i32) -> bool {
        let said = self.carrier.said.iter();
        let said = said.map(|text| serde_json::from_str::<Value>(text).expect("JSON"));
        let mut all = said.chain(self.heard.iter().cloned());
        all.any(|message| message["id"] == id)
    }
}
