//! A plain client: it writes messages, and reads every one that comes back.

use std::{
    io::{BufRead, BufReader, Write},
    process::{Child, ChildStdin, Command, Stdio},
    sync::mpsc::{self, Receiver, RecvTimeoutError},
    thread,
    time::Duration,
};

use serde_json::{Value, json};

/// What carries the texts of messages.
pub trait Carrier {
    /// The document that the conversation is about.
    const URI: &'static str;

    fn write(&mut self, text: &str);
    fn read(&mut self) -> String;
}

pub struct Client<C> {
    pub carrier: C,
    requests: i32,
    /// What was said, and not asked for yet.
    pub heard: Vec<Value>,
}

impl<C: Carrier> Client<C> {
    pub fn new(carrier: C) -> Self {
        Self {
            carrier,
            requests: 0,
            heard: Vec::new(),
        }
    }

    pub fn send(&mut self, message: &Value) {
        self.carrier.write(&message.to_string());
    }

    pub fn read(&mut self) -> Value {
        serde_json::from_str(&self.carrier.read()).expect("JSON")
    }

    /// Tells something; of the document, if it is about one.
    pub fn tell(&mut self, method: &str, mut params: Value) {
        if method.starts_with("textDocument/") {
            params["textDocument"]["uri"] = C::URI.into();
        }
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Asks, and does not wait for the answer.
    pub fn request(&mut self, method: &str, mut params: Value) -> i32 {
        if method.starts_with("textDocument/") || method.starts_with("pinhole/") {
            params["textDocument"] = json!({ "uri": C::URI });
        }
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        id
    }

    /// The next message of a kind, since the last one that was asked for.
    fn next(&mut self, is_meant: impl Fn(&Value) -> bool) -> Value {
        while !self.heard.iter().any(&is_meant) {
            let message = self.read();
            assert_eq!(message["jsonrpc"], "2.0", "{message}");
            self.heard.push(message);
        }
        let place = self.heard.iter().position(is_meant);
        self.heard.remove(place.expect("it was heard"))
    }

    /// The whole response to a request.
    pub fn response(&mut self, id: i32) -> Value {
        self.next(|message| message["id"] == id)
    }

    pub fn respond(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        self.response(id)
    }

    /// The result of a request.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let response = self.respond(method, params);
        assert!(response.get("error").is_none(), "{response}");
        response["result"].clone()
    }

    /// The parameters of the next notification of this name.
    pub fn told(&mut self, method: &str) -> Value {
        self.next(|message| message["method"] == method)["params"].take()
    }

    /// What is wrong with the text that it is told of next.
    pub fn diagnostics(&mut self) -> Value {
        self.told("textDocument/publishDiagnostics")
    }

    /// Opens a text, after what comes before that.
    pub fn open(&mut self, capabilities: Value, text: &str) {
        self.ask("initialize", json!({ "capabilities": capabilities }));
        self.tell("initialized", json!({}));
        let document = json!({ "languageId": "scn", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Tells of a change that makes a version of the text.
    pub fn change(&mut self, version: usize, change: Value) {
        let document = json!({ "version": version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        self.tell("textDocument/didChange", params);
    }
}

/// The longest that anything may take.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// The program's standard streams.
pub struct Pipes {
    child: Child,
    input: Option<ChildStdin>,
    /// The texts of its messages, which a thread of its own reads, so that none is waited for
    /// without end.
    said: Receiver<String>,
}

impl Pipes {
    pub fn put(&mut self, bytes: &str) {
        let input = self.input.as_mut().expect("it is open");
        input.write_all(bytes.as_bytes()).expect("the server reads");
        input.flush().expect("the server reads");
    }
}

impl Carrier for Pipes {
    const URI: &'static str = "file:///home/somebody/a%20scene.scn";

    fn write(&mut self, text: &str) {
        self.put(&format!("Content-Length: {}\r\n\r\n{text}", text.len()));
    }

    fn read(&mut self) -> String {
        let said = self.said.recv_timeout(PATIENCE);
        said.expect("an answer in time")
    }
}

/// The text of the next message; everything up to it belongs to it.
fn message(output: &mut impl BufRead) -> Option<String> {
    let mut header = String::new();
    for _ in 0..2 {
        output.read_line(&mut header).expect("text");
    }
    if header.is_empty() {
        return None;
    }
    let length = header.strip_prefix("Content-Length: ");
    let length = length.and_then(|it| it.strip_suffix("\r\n\r\n")?.parse().ok());
    let length = length.unwrap_or_else(|| panic!("not a header: {header:?}"));
    let mut text = vec![0; length];
    output.read_exact(&mut text).expect("the message");
    Some(String::from_utf8(text).expect("text"))
}

impl Client<Pipes> {
    /// The server, to which nothing was said yet.
    pub fn start() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
        let command = command.arg("lsp").stdin(Stdio::piped());
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the server starts");
        let mut output = BufReader::new(child.stdout.take().expect("it was asked for"));
        let (sender, said) = mpsc::channel();
        thread::spawn(move || {
            while let Some(text) = message(&mut output) {
                let _ = sender.send(text);
            }
        });
        Self::new(Pipes {
            input: child.stdin.take(),
            child,
            said,
        })
    }

    /// Takes its leave, as it should be.
    pub fn leave(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null), Value::Null);
        self.tell("exit", Value::Null);
        assert_eq!(self.end(), (Some(0), String::new()));
    }

    /// Says nothing more: the status, and what was said on standard error.
    pub fn end(self) -> (Option<i32>, String) {
        let Pipes { child, input, said } = self.carrier;
        drop(input);
        // Its standard output ends, so that it has nothing more to do.
        let rest = said.recv_timeout(PATIENCE);
        assert_eq!(rest, Err(RecvTimeoutError::Disconnected));
        let output = child.wait_with_output().expect("it ends");
        let log = String::from_utf8(output.stderr).expect("text");
        (output.status.code(), log)
    }
}
