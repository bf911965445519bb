//! A conversation with a server in this process, so that it is known what it has done by when.

use std::{cell::RefCell, collections::VecDeque};

use pinhole::lsp::{
    Server,
    messages::{self, Malformed},
};
use serde_json::{Value, json};

use super::client::{Carrier, Client};

/// A conversation with one text open, of version 1.
pub type Talk = Client<Inside>;

thread_local! {
    static LOG: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// What the servers of this thread have said to their log since this was asked last.
pub fn logged() -> Vec<String> {
    LOG.take()
}

/// A server, and what it has said and nobody has read.
pub struct Inside {
    server: Server,
    pub said: VecDeque<String>,
}

impl Default for Inside {
    fn default() -> Self {
        let log = |message: &str| LOG.with_borrow_mut(|log| log.push(message.to_owned()));
        Self {
            server: Server::new(log),
            said: VecDeque::new(),
        }
    }
}

impl Inside {
    /// One piece of work. Says whether there was any.
    pub fn step(&mut self) -> bool {
        let is_busy = self.server.is_busy();
        let said = self.server.advance();
        self.said.extend(said.iter().map(messages::written));
        is_busy
    }
}

impl Carrier for Inside {
    const URI: &'static str = "file:///a.scn";

    fn write(&mut self, text: &str) {
        match messages::read(text.as_bytes()) {
            Ok(message) => {
                let said = self.server.handle(message);
                self.said.extend(said.iter().map(messages::written));
            }
            Err(Malformed::Answered(response)) => self.said.push_back(response.to_string()),
            Err(Malformed::Unanswered(what)) => panic!("{what}"),
        }
    }

    fn read(&mut self) -> String {
        while self.said.is_empty() {
            assert!(self.step(), "nothing more is said");
        }
        self.said.pop_front().expect("it was said")
    }
}

impl Talk {
    pub fn with(text: &str) -> Self {
        let mut talk = Self::new(Inside::default());
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
