//! A conversation with a server in this process, so that it is known what it has done by when.

use lsp_server::{Message, Notification, Request};
use pinhole::lsp::Server;
use serde_json::{Value, json};

pub const URI: &str = "file:///a.scn";

/// A conversation with one text open.
pub struct Talk {
    server: Server,
    requests: i32,
    version: i32,
    /// What was said since the server was greeted.
    pub said: Vec<Value>,
}

impl Talk {
    /// With a server that understands everything.
    pub fn new(text: &str) -> Self {
        Self::logged(text, |message| panic!("{message}"))
    }

    pub fn logged(text: &str, log: fn(&str)) -> Self {
        let mut talk = Self {
            server: Server::new(log),
            requests: 0,
            version: 0,
            said: Vec::new(),
        };
        talk.post("initialize", json!({ "capabilities": {} }));
        talk.said.clear();
        let document = json!({ "uri": URI, "languageId": "scn", "version": 0, "text": text });
        talk.tell("textDocument/didOpen", json!({ "textDocument": document }));
        talk
    }

    fn take(&mut self, message: Message) {
        let said = self.server.handle(message);
        self.hear(&said);
    }

    fn hear(&mut self, said: &[Message]) {
        let said = said
            .iter()
            .map(|message| serde_json::to_value(message).expect("JSON"));
        self.said.extend(said);
    }

    pub fn tell(&mut self, method: &str, params: Value) {
        self.take(Notification::new(method.to_owned(), params).into());
    }

    /// Asks something, and returns its id.
    pub fn post(&mut self, method: &str, mut params: Value) -> i32 {
        params["textDocument"] = json!({ "uri": URI });
        self.requests += 1;
        self.take(Request::new(self.requests.into(), method.to_owned(), params).into());
        self.requests
    }

    pub fn change(&mut self, text: &str) {
        self.version += 1;
        let document = json!({ "uri": URI, "version": self.version });
        self.tell(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": [{ "text": text }] }),
        );
    }

    /// One piece of work. Says whether there was any.
    pub fn step(&mut self) -> bool {
        let is_busy = self.server.is_busy();
        let said = self.server.advance();
        self.hear(&said);
        is_busy
    }

    /// The response to a request, if it was said.
    pub fn said(&self, id: i32) -> Option<&Value> {
        self.said.iter().find(|message| message["id"] == id)
    }

    /// The response to a request, after all work.
    pub fn response(&mut self, id: i32) -> Value {
        while self.step() {}
        self.said(id).expect("it is answered").clone()
    }

    /// The result of a request.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let id = self.post(method, params);
        let response = self.response(id);
        assert!(response.get("error").is_none(), "{response}");
        response["result"].clone()
    }

    /// The message of the error that a request gets.
    pub fn refused(&mut self, method: &str, params: Value) -> String {
        let id = self.post(method, params);
        let message = &self.response(id)["error"]["message"];
        message.as_str().expect("it is refused").to_owned()
    }
}
