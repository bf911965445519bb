//! Measures how long an editor waits: `cargo bench --bench editor`. See README.md beside this file.
//!
//! The server runs as it does for an editor. A measured time begins before a message is written and
//! ends when the answer has been read.

use std::{
    env,
    io::{BufRead, BufReader, Read},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    time::{Duration, Instant},
};

use lsp_server::{Message, Notification, Request};
use serde_json::{Value, json};

use self::spheres::{Layout, spheres};

mod spheres;

const OBJECTS: usize = 1000;

/// Number of times that each request is repeated. The median and the longest time are printed. With
/// 200 repetitions, a rare delay shows in the longest time, and the benchmark still ends soon.
const ROUNDS: u32 = 200;

/// Number of times that each request about a line of a million tokens is repeated. It is smaller
/// than [`ROUNDS`], because these requests are slow.
const FEW: u32 = 10;

const URI: &str = "file:///spheres.scn";

fn main() {
    // `cargo test` runs this program without `--bench`. The program contains no tests, so it ends
    // here.
    if !env::args().any(|argument| argument == "--bench") {
        return;
    }
    let text = spheres(OBJECTS, Layout::Blocks);
    let lines = u32::try_from(text.lines().count()).unwrap_or(u32::MAX);
    println!(
        "{OBJECTS} spheres, {} bytes, {lines} lines; {ROUNDS} times each",
        text.len()
    );
    println!("{:32} {:>9} {:>9}", "", "median", "longest");
    let mut server = Server::start(&text);

    let mut letters = Letters::at(lines / 2, 0);
    show("a letter, and its diagnostics", ROUNDS, || {
        letters.next(&mut server);
    });

    let middle = json!({ "line": lines / 2, "character": 4 });
    let everything =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": lines, "character": 0 } });
    let teal = json!({ "red": 0.0, "green": 0.5, "blue": 0.5, "alpha": 1.0 });
    let name = json!({ "line": 1, "character": 5 });
    let questions = [
        ("completion", json!({ "position": middle })),
        (
            "completion",
            json!({ "position": { "line": lines, "character": 0 } }),
        ),
        ("hover", json!({ "position": middle })),
        (
            "hover",
            json!({ "position": { "line": 3, "character": 2 } }),
        ),
        ("signatureHelp", json!({ "position": middle })),
        ("definition", json!({ "position": name })),
        (
            "references",
            json!({ "position": name, "context": { "includeDeclaration": true } }),
        ),
        ("documentHighlight", json!({ "position": name })),
        ("prepareRename", json!({ "position": name })),
        ("rename", json!({ "position": name, "newName": "other" })),
        ("documentSymbol", json!({})),
        ("foldingRange", json!({})),
        ("inlayHint", json!({ "range": everything })),
        ("documentColor", json!({})),
        (
            "colorPresentation",
            json!({ "color": teal, "range": everything }),
        ),
        (
            "codeAction",
            json!({ "range": everything, "context": { "diagnostics": [] } }),
        ),
        (
            "formatting",
            json!({ "options": { "tabSize": 2, "insertSpaces": true } }),
        ),
        ("semanticTokens/full", json!({})),
    ];
    for (method, params) in questions {
        show(method, ROUNDS, || {
            server.ask(method, params.clone());
        });
    }
    formatted();
    objects_in_one_line();
    tokens_in_one_line();
}

/// Measures the time of formatting a text with one block per line. Then measures the time from
/// sending all edits of the formatter as one change to reading the new diagnostics. The last edit
/// in the text is listed first, so that no edit moves the positions of the others.
fn formatted() {
    let text = spheres(OBJECTS, Layout::Lines);
    let mut server = Server::start(&text);
    let options = json!({ "options": { "tabSize": 2, "insertSpaces": true } });
    let answer = server.ask("formatting", options.clone());
    let answer: Value = serde_json::from_slice(&answer).expect("JSON");
    let edits = answer["result"].as_array().expect("edits");
    let changes = edits
        .iter()
        .rev()
        .map(|edit| json!({ "range": edit["range"], "text": edit["newText"] }));
    let changes: Vec<Value> = changes.collect();
    println!("a block a line: {} edits of formatting", changes.len());
    show("formatting", ROUNDS, || {
        server.ask("formatting", options.clone());
    });
    let mut version = 1;
    let mut change = |server: &mut Server, changes: Value| {
        version += 1;
        let document = json!({ "uri": URI, "version": version });
        let params = json!({ "textDocument": document, "contentChanges": changes });
        let start = Instant::now();
        server.tell("textDocument/didChange", params);
        server.read();
        start.elapsed()
    };
    let times = (0..ROUNDS).map(|_| {
        let time = change(&mut server, changes.clone().into());
        change(&mut server, json!([{ "text": text }]));
        time
    });
    print("its edits, and their diagnostics", times.collect());
}

/// Measures the server's answers in a text with all objects in one line.
fn objects_in_one_line() {
    let text = spheres(OBJECTS, Layout::Lines);
    // Comments are left out, since a line comment would hide the rest of the line.
    let lines = text.lines().filter(|line| !line.contains("//"));
    let line = lines.collect::<Vec<_>>().join(" ");
    println!("all of it in one line of {} bytes", line.len());
    in_one_line(&line, ROUNDS);
}

/// Measures the server's answers in a text of one line, which is a sum of a million tokens.
fn tokens_in_one_line() {
    const TOKENS: usize = 1_000_000;
    let line = format!("let a = 1{}", " + 1".repeat((TOKENS - 4) / 2));
    println!(
        "one line of {TOKENS} tokens, {} bytes; {FEW} times each",
        line.len()
    );
    in_one_line(&line, FEW);
}

/// Measures the times of the requests whose answers an editor waits for, in a text of one line.
fn in_one_line(line: &str, rounds: u32) {
    let mut server = Server::start(line);
    let mut letters = Letters::at(0, 0);
    show("a letter, and its diagnostics", rounds, || {
        letters.next(&mut server);
    });
    let middle = json!({ "line": 0, "character": line.len() / 2 });
    let requests = [
        ("completion", json!({ "position": middle })),
        ("hover", json!({ "position": middle })),
        ("documentSymbol", json!({})),
        ("documentColor", json!({})),
        (
            "formatting",
            json!({ "options": { "tabSize": 2, "insertSpaces": true } }),
        ),
        ("semanticTokens/full", json!({})),
    ];
    for (method, params) in requests {
        show(method, rounds, || {
            server.ask(method, params.clone());
        });
    }
}

/// Edits that alternately type and delete a letter at one position of the text.
struct Letters {
    line: u32,
    column: u32,
    version: i32,
}

impl Letters {
    fn at(line: u32, column: u32) -> Self {
        let version = 1;
        Self {
            line,
            column,
            version,
        }
    }

    /// Sends the next change, and reads the diagnostics that the server sends after it.
    fn next(&mut self, server: &mut Server) {
        self.version += 1;
        let place = json!({ "line": self.line, "character": self.column });
        let after = json!({ "line": self.line, "character": self.column + 1 });
        let change = match self.version % 2 {
            0 => json!({ "range": { "start": place, "end": place }, "text": "x" }),
            _ => json!({ "range": { "start": place, "end": after }, "text": "" }),
        };
        let document = json!({ "uri": URI, "version": self.version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        server.tell("textDocument/didChange", params);
        server.read();
    }
}

/// Calls `done` `rounds` times, and prints the median and the longest time of a call.
fn show(name: &str, rounds: u32, mut done: impl FnMut()) {
    let times = (0..rounds).map(|_| {
        let start = Instant::now();
        done();
        start.elapsed()
    });
    print(name, times.collect());
}

fn print(name: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let milliseconds = |time: Duration| time.as_secs_f64() * 1e3;
    let median = milliseconds(times[times.len() / 2]);
    let longest = milliseconds(times[times.len() - 1]);
    println!("{name:32} {median:6.2} ms {longest:6.2} ms");
}

struct Server {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    requests: i32,
}

impl Server {
    /// Starts the language server and opens a text in it.
    fn start(text: &str) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pinhole"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server starts");
        let input = child.stdin.take().expect("it was asked for");
        let output = BufReader::new(child.stdout.take().expect("it was asked for"));
        let mut server = Self {
            child,
            input,
            output,
            requests: 0,
        };
        let capabilities = json!({ "textDocument": {
            "completion": { "completionItem": { "snippetSupport": true } },
            "documentSymbol": { "hierarchicalDocumentSymbolSupport": true },
        } });
        server.request("initialize", json!({ "capabilities": capabilities }));
        let document = json!({ "uri": URI, "languageId": "scn", "version": 1, "text": text });
        server.tell("textDocument/didOpen", json!({ "textDocument": document }));
        server.read();
        server
    }

    fn tell(&mut self, method: &str, params: Value) {
        let message = Message::from(Notification::new(method.to_owned(), params));
        message.write(&mut self.input).expect("the server reads");
    }

    /// Reads the bytes of the server's next message. The bytes are not parsed, so that the client's
    /// own work is not measured.
    fn read(&mut self) -> Vec<u8> {
        let mut header = String::new();
        while !header.ends_with("\r\n\r\n") {
            let read = self.output.read_line(&mut header);
            assert_ne!(read.expect("a header"), 0, "the server is there");
        }
        let length = header.trim().strip_prefix("Content-Length: ");
        let length = length.and_then(|length| length.parse().ok());
        let mut message = vec![0; length.expect("a length")];
        self.output.read_exact(&mut message).expect("a message");
        message
    }

    /// Sends a request about the document. Returns the bytes of the answer.
    fn ask(&mut self, method: &str, mut params: Value) -> Vec<u8> {
        params["textDocument"] = json!({ "uri": URI });
        self.request(&format!("textDocument/{method}"), params)
    }

    fn request(&mut self, method: &str, params: Value) -> Vec<u8> {
        self.requests += 1;
        let request = Request::new(self.requests.into(), method.to_owned(), params);
        Message::from(request)
            .write(&mut self.input)
            .expect("the server reads");
        let answer = self.read();
        let is_error = answer.windows(8).take(60).any(|part| part == b"\"error\":");
        assert!(!is_error, "{method}: {}", String::from_utf8_lossy(&answer));
        answer
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // The server has nothing to save, so it is killed rather than asked to exit.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
