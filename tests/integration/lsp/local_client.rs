//! A client whose language server runs in the same process as the test. The test can advance this
//! server in small steps.

use std::{cell::RefCell, collections::VecDeque};

use pinhole::lsp::{
    Server,
    messages::{self, Malformed},
};
use serde_json::{Value, json};

use super::client::{Client, Transport};

/// A client whose server runs in the same process as the test. It has one open text, which has the
/// version 1.
pub type LocalClient = Client<InProcess>;

thread_local! {
    static LOG: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) };
}

/// Removes and returns the messages that the servers of the current thread have logged.
pub fn logged() -> Vec<String> {
    LOG.take()
}

/// A server that runs in the same process as the test, with the messages that the client has not
/// read yet.
pub struct InProcess {
    server: Server,
    pub said: VecDeque<String>,
}

impl Default for InProcess {
    fn default() -> Self {
        let log = |message: &str| LOG.with_borrow_mut(|log| log.push(message.to_owned()));
        Self {
            server: Server::new(log),
            said: VecDeque::new(),
        }
    }
}

impl InProcess {
    /// Lets the server do a portion of its work. Returns whether there was work to do.
    pub fn step(&mut self) -> bool {
        let is_busy = self.server.is_busy();
        let said = self.server.advance();
        self.said.extend(said.iter().map(messages::to_text));
        is_busy
    }
}

impl Transport for InProcess {
    const URI: &'static str = "file:///a.scn";

    fn write(&mut self, text: &str) {
        match messages::read(text.as_bytes()) {
            Ok(message) => {
                let said = self.server.handle(message);
                self.said.extend(said.iter().map(messages::to_text));
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

impl LocalClient {
    pub fn with(text: &str) -> Self {
        let mut client = Self::new(InProcess::default());
        client.open(json!({}), text);
        client
    }

    pub fn has_answered(&self, id: i32) -> bool {
        let said = self.transport.said.iter();
        let said = said.map(|text| serde_json::from_str::<Value>(text).expect("JSON"));
        let mut all = said.chain(self.unread.iter().cloned());
        all.any(|message| message["id"] == id)
    }
}
