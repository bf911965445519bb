//! A plain client: it writes messages, and reads every byte that comes back.

use std::{
    io::{BufRead, BufReader, Read, Write},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

use serde_json::{Value, json};

pub const URI: &str = "file:///home/somebody/a%20scene.scn";

pub struct Client {
    child: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    requests: i32,
    /// The last diagnostics that came before a response.
    told: Value,
}

impl Client {
    /// The server, to which nothing was said yet.
    pub fn start() -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pinhole"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the server starts");
        let input = child.stdin.take();
        let output = child.stdout.take().expect("it was asked for");
        Self {
            child,
            input,
            output: BufReader::new(output),
            requests: 0,
            told: Value::Null,
        }
    }

    /// The server with a text open, and what it says to that.
    pub fn open(capabilities: Value, text: &str) -> (Self, Value) {
        let mut client = Self::start();
        let diagnostics = client.begin(capabilities, text);
        (client, diagnostics)
    }

    /// Opens a text, after what comes before that: what the server says to it.
    pub fn begin(&mut self, capabilities: Value, text: &str) -> Value {
        self.ask(
            "initialize",
            json!({ "processId": null, "rootUri": null, "capabilities": capabilities }),
        );
        self.tell("initialized", json!({}));
        let document = json!({ "uri": URI, "languageId": "scn", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
        let diagnostics = self.read();
        assert_eq!(diagnostics["method"], "textDocument/publishDiagnostics");
        diagnostics["params"].clone()
    }

    pub fn write(&mut self, text: &str) {
        let input = self.input.as_mut().expect("it is open");
        input.write_all(text.as_bytes()).expect("the server reads");
        input.flush().expect("the server reads");
    }

    pub fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.write(&format!("Content-Length: {}\r\n\r\n{text}", text.len()));
    }

    /// The next message; everything up to it belongs to it.
    pub fn read(&mut self) -> Value {
        let mut header = String::new();
        self.output.read_line(&mut header).expect("a header");
        let length = header
            .strip_prefix("Content-Length: ")
            .unwrap_or_else(|| panic!("not a header: {header:?}"));
        let length: usize = length.trim_end().parse().expect("a length");
        let mut empty = String::new();
        self.output.read_line(&mut empty).expect("the header's end");
        assert_eq!(empty, "\r\n");
        let mut text = vec![0; length];
        self.output.read_exact(&mut text).expect("the message");
        serde_json::from_slice(&text).expect("JSON")
    }

    pub fn tell(&mut self, method: &str, params: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// The whole response to a request.
    pub fn respond(&mut self, method: &str, params: Value) -> Value {
        self.requests += 1;
        let id = self.requests;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        let mut response = self.read();
        while response["method"] == "textDocument/publishDiagnostics" {
            self.told = response["params"].clone();
            response = self.read();
        }
        assert_eq!(
            (&response["id"], &response["jsonrpc"]),
            (&id.into(), &"2.0".into()),
            "{response}"
        );
        response
    }

    /// The result of a request.
    pub fn ask(&mut self, method: &str, params: Value) -> Value {
        let response = self.respond(method, params);
        assert!(response.get("error").is_none(), "{response}");
        response["result"].clone()
    }

    /// The result of a request about the document, with these further parameters.
    pub fn about(&mut self, method: &str, params: Value) -> Value {
        let mut params = params;
        params["textDocument"] = json!({ "uri": URI });
        self.ask(&format!("textDocument/{method}"), params)
    }

    /// The result of a request about a place.
    pub fn at(&mut self, method: &str, line: u32, character: u32) -> Value {
        self.about(
            method,
            json!({ "position": { "line": line, "character": character } }),
        )
    }

    /// Tells of a change that makes a version of the text.
    pub fn change(&mut self, version: usize, range: Value, text: &str) {
        let document = json!({ "uri": URI, "version": version });
        let changes = json!([{ "range": range, "text": text }]);
        let params = json!({ "textDocument": document, "contentChanges": changes });
        self.tell("textDocument/didChange", params);
    }

    /// What is wrong with a version of the text, as soon as it is said.
    pub fn diagnostics(&mut self, version: usize) -> Value {
        while self.told["version"] != version {
            let message = self.read();
            assert_eq!(message["method"], "textDocument/publishDiagnostics");
            self.told = message["params"].clone();
        }
        self.told["diagnostics"].clone()
    }

    /// Takes its leave, as it should be.
    pub fn leave(mut self) {
        assert_eq!(self.ask("shutdown", Value::Null), Value::Null);
        self.tell("exit", Value::Null);
        assert_eq!(self.end(), (Some(0), String::new()));
    }

    /// Says nothing more: the status, and what was said on standard error.
    pub fn end(mut self) -> (Option<i32>, String) {
        drop(self.input.take());
        let mut rest = String::new();
        self.output.read_to_string(&mut rest).expect("text");
        assert_eq!(rest, "", "nothing but answers on standard output");
        let mut log = String::new();
        let mut errors = self.child.stderr.take().expect("it was asked for");
        errors.read_to_string(&mut log).expect("text");
        let status = self.child.wait().expect("it ends");
        (status.code(), log)
    }
}
