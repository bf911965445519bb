//! A simple client of the language server. It sends messages and reads the server's answers.

use std::{
    io::{BufRead, BufReader, Write},
    process::{Child, ChildStdin, Command, Stdio},
    sync::mpsc::{self, Receiver, RecvTimeoutError},
    thread,
    time::Duration,
};

use serde_json::{Value, json};

/// A channel that carries the texts of messages to a server and back.
pub trait Transport {
    /// URI of the only document that the client opens.
    const URI: &'static str;

    fn write(&mut self, text: &str);
    fn read(&mut self) -> String;
}

pub struct Client<C> {
    pub transport: C,
    requests: i32,
    /// Messages that the client has received but not yet returned to the test.
    pub unread: Vec<Value>,
}

impl<C: Transport> Client<C> {
    pub fn new(transport: C) -> Self {
        Self {
            transport,
            requests: 0,
            unread: Vec::new(),
        }
    }

    pub fn send(&mut self, message: &Value) {
        self.transport.write(&message.to_string());
    }

    pub fn read(&mut self) -> Value {
        serde_json::from_str(&self.transport.read()).expect("JSON")
    }

    /// Sends a notification. If the method is about the document, adds the document's URI to
    /// `params`.
    pub fn notify(&mut self, method: &str, mut params: Value) {
        if method.starts_with("textDocument/") {
            params["textDocument"]["uri"] = C::URI.into();
        }
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Sends a request without waiting for the response. Returns the identifier of the request.
    pub fn request(&mut self, method: &str, mut params: Value) -> i32 {
        if method.starts_with("textDocument/") || method.starts_with("pinhole/") {
            params["textDocument"] = json!({ "uri": C::URI });
        }
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        id
    }

    /// Removes and returns the first unread message for which `is_meant` is true. If there is none,
    /// waits for such a message.
    fn next(&mut self, is_meant: impl Fn(&Value) -> bool) -> Value {
        while !self.unread.iter().any(&is_meant) {
            let message = self.read();
            assert_eq!(message["jsonrpc"], "2.0", "{message}");
            self.unread.push(message);
        }
        let place = self.unread.iter().position(is_meant);
        self.unread.remove(place.expect("it was heard"))
    }

    /// Waits for the response to the request `id`, and returns the whole response.
    pub fn response(&mut self, id: i32) -> Value {
        self.next(|message| message["id"] == id)
    }

    pub fn respond(&mut self, method: &str, params: Value) -> Value {
        let id = self.request(method, params);
        self.response(id)
    }

    /// Sends a request, waits for the response and returns its result. Panics if the response is an
    /// error.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let response = self.respond(method, params);
        assert!(response.get("error").is_none(), "{response}");
        response["result"].clone()
    }

    /// Waits for the next notification `method` and returns its parameters.
    pub fn notification(&mut self, method: &str) -> Value {
        self.next(|message| message["method"] == method)["params"].take()
    }

    /// Waits for the next published diagnostics and returns the parameters of the notification.
    pub fn diagnostics(&mut self) -> Value {
        self.notification("textDocument/publishDiagnostics")
    }

    /// Initializes the server with the client's capabilities and opens a text.
    pub fn open(&mut self, capabilities: Value, text: &str) {
        self.ask("initialize", json!({ "capabilities": capabilities }));
        self.notify("initialized", json!({}));
        let document = json!({ "languageId": "scn", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Sends a change of the text. `version` is the version of the text after the change.
    pub fn change(&mut self, version: usize, change: Value) {
        let document = json!({ "version": version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        self.notify("textDocument/didChange", params);
    }
}

/// Maximum time to wait for a message. After this time, the test fails. A message takes
/// milliseconds, but a busy machine may need seconds; a longer time would only delay the failure.
pub const PATIENCE: Duration = Duration::from_secs(30);

/// A running server with its standard input and output.
pub struct Pipes {
    child: Child,
    input: Option<ChildStdin>,
    /// Texts of the server's messages. A separate thread reads them and sends them here, because
    /// this channel can be read with a time limit, unlike the server's output.
    said: Receiver<String>,
}

impl Pipes {
    pub fn put(&mut self, bytes: &str) {
        let input = self.input.as_mut().expect("it is open");
        input.write_all(bytes.as_bytes()).expect("the server reads");
        input.flush().expect("the server reads");
    }
}

impl Transport for Pipes {
    const URI: &'static str = "file:///home/somebody/a%20scene.scn";

    fn write(&mut self, text: &str) {
        self.put(&format!("Content-Length: {}\r\n\r\n{text}", text.len()));
    }

    fn read(&mut self) -> String {
        let said = self.said.recv_timeout(PATIENCE);
        said.expect("an answer in time")
    }
}

/// Reads the text of the server's next message. Returns `None` at the end of the output.
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
    /// Starts a server and sends nothing to it.
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

    /// Shuts the server down as the protocol requires, and asserts that it ends successfully.
    pub fn shut_down(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null), Value::Null);
        self.notify("exit", Value::Null);
        assert_eq!(self.end(), (Some(0), String::new()));
    }

    /// Closes the server's input, and asserts that no more messages arrive. Returns the exit status
    /// and the standard error.
    pub fn end(self) -> (Option<i32>, String) {
        let Pipes { child, input, said } = self.transport;
        drop(input);
        // The standard output of the server ends without another message.
        let rest = said.recv_timeout(PATIENCE);
        assert_eq!(rest, Err(RecvTimeoutError::Disconnected));
        let output = child.wait_with_output().expect("it ends");
        let log = String::from_utf8(output.stderr).expect("text");
        (output.status.code(), log)
    }
}
