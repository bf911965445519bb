//! The server on standard input and output, as editors start it.
//!
//! A thread of its own does nothing but read, so that all that has come is taken in before the next piece of work: what was cancelled in the meantime is not
//! computed, and of several states of a text only the last is judged. Messages are read here rather than by lsp-server, which takes any length that is announced and
//! ends at the first message that is none.

use std::{
    io::{self, BufRead, BufReader, Read, Write},
    sync::mpsc::{self, Receiver, Sender},
    thread,
};

use lsp_server::{ErrorCode, Message};
use serde_json::{Value, json};

use super::server::Server;

/// A message, or something that came in its place.
type Incoming = Result<Message, Malformed>;

/// Has a server talk to a client until it ends. Says whether it ended properly: by `exit` after `shutdown`.
///
/// # Errors
///
/// The output cannot be written to.
pub fn serve(
    mut server: Server,
    input: impl Read + Send + 'static,
    output: &mut dyn Write,
    log: fn(&str),
) -> io::Result<bool> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || read(input, &sender, log));
    while let Some(incoming) = next_message(&receiver, &mut server, output)? {
        match incoming {
            Ok(message) => say(output, server.handle(message))?,
            Err(malformed) => {
                let Malformed { id, code, message } = malformed;
                let error = json!({ "code": code as i32, "message": message });
                // A response of lsp-server cannot have the id null.
                let response = json!({ "jsonrpc": "2.0", "id": id, "error": error }).to_string();
                write!(
                    output,
                    "Content-Length: {}\r\n\r\n{response}",
                    response.len()
                )?;
                output.flush()?;
            }
        }
        if let Some(properly) = server.ended() {
            return Ok(properly);
        }
    }
    Ok(false)
}

/// The next message, as soon as there is one; the server works while it waits. None if no more will come, and all is done.
fn next_message(
    messages: &Receiver<Incoming>,
    server: &mut Server,
    output: &mut dyn Write,
) -> io::Result<Option<Incoming>> {
    while server.is_busy() {
        if let Ok(message) = messages.try_recv() {
            return Ok(Some(message));
        }
        say(output, server.advance())?;
    }
    Ok(messages.recv().ok())
}

fn say(output: &mut dyn Write, messages: Vec<Message>) -> io::Result<()> {
    messages
        .into_iter()
        .try_for_each(|message| message.write(&mut &mut *output))
}

fn read(input: impl Read, sender: &Sender<Incoming>, log: fn(&str)) {
    let mut input = BufReader::new(input);
    loop {
        match next(&mut input) {
            Ok(Some(message)) => {
                let is_exit =
                    matches!(&message, Ok(Message::Notification(n)) if n.method == "exit");
                // Behind `exit` nobody listens any more.
                if sender.send(message).is_err() || is_exit {
                    return;
                }
            }
            Ok(None) => return,
            Err(Failed::Once(what)) => log(&what),
            Err(Failed::ForGood(what)) => {
                log(&what);
                return;
            }
        }
    }
}

/// The longest message, in bytes. What announces more has lost its way, and what would follow it is anybody's guess.
const LONGEST: u64 = 1 << 30;

/// The longest line of a header; those that are known take some thirty bytes.
const LONGEST_HEADER: u64 = 4096;

/// Something that is not a message, and has an answer.
#[derive(Debug)]
struct Malformed {
    /// The id that it has; null if it has none.
    id: Value,
    /// What it lacks.
    code: ErrorCode,
    /// The same in words.
    message: String,
}

/// Why nothing was read.
enum Failed {
    /// The next message may be a right one.
    Once(String),
    /// Nothing can be read any more.
    ForGood(String),
}

impl From<io::Error> for Failed {
    fn from(error: io::Error) -> Self {
        Self::ForGood(error.to_string())
    }
}

/// The next message; none behind the last one.
fn next(input: &mut impl BufRead) -> Result<Option<Incoming>, Failed> {
    let Some(length) = length(input)? else {
        return Ok(None);
    };
    // Memory is taken for what has come, not for what was announced.
    let mut content = Vec::new();
    let read = input.by_ref().take(length).read_to_end(&mut content)?;
    if (read as u64) < length {
        let what = format!("the input ends after {read} of {length} bytes of a message");
        return Err(Failed::ForGood(what));
    }
    message(&content).map(Some)
}

/// The length that a header announces; none at the end of the input.
fn length(input: &mut impl BufRead) -> Result<Option<u64>, Failed> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        let mut header = input.by_ref().take(LONGEST_HEADER);
        if header.read_until(b'\n', &mut line)? == 0 {
            return Ok(None);
        }
        let line = String::from_utf8_lossy(&line);
        let malformed = || Failed::Once(format!("malformed header: {line:?}"));
        let field = line.strip_suffix("\r\n").ok_or_else(malformed)?;
        if field.is_empty() {
            break;
        }
        let (name, value) = field.split_once(": ").ok_or_else(malformed)?;
        if name.eq_ignore_ascii_case("Content-Length") {
            length = Some(value.parse().map_err(|_| malformed())?);
        }
    }
    match length {
        None => Err(Failed::Once("no Content-Length".to_owned())),
        Some(length) if length > LONGEST => Err(Failed::ForGood(format!(
            "a message of {length} bytes is announced, and at most {LONGEST} can be read"
        ))),
        Some(length) => Ok(Some(length)),
    }
}

fn message(content: &[u8]) -> Result<Incoming, Failed> {
    let malformed = |id, code, message: String| Ok(Err(Malformed { id, code, message }));
    let value: Value = match serde_json::from_slice(content) {
        Ok(value) => value,
        Err(error) => {
            let message = format!("this is not JSON: {error}");
            return malformed(Value::Null, ErrorCode::ParseError, message);
        }
    };
    if value.is_array() {
        let message = "messages come one by one".to_owned();
        return malformed(Value::Null, ErrorCode::InvalidRequest, message);
    }
    let has = |name: &str| value.get(name).is_some();
    // A response is never answered.
    let is_response = !has("method") && (has("result") || has("error"));
    let id = value
        .get("id")
        .filter(|id| id.is_string() || id.is_number());
    let id = id.cloned().unwrap_or_default();
    // What has an identifier and nothing else would pass for a response, and a request with an odd one for a notification; the
    // protocol's whole numbers have 32 bits.
    let is_whole = |id: &Value| id.as_i64().is_some_and(|id| i32::try_from(id).is_ok());
    let is_odd = |id: &Value| !id.is_string() && !is_whole(id);
    let is_call =
        value.get("method").is_some_and(Value::is_string) && !value.get("id").is_some_and(is_odd);
    match serde_json::from_value(value) {
        Ok(message) if is_call || is_response => Ok(Ok(message)),
        _ if is_response => Err(Failed::Once("a response to nothing".to_owned())),
        _ => {
            let message = "this is neither a request nor a notification".to_owned();
            malformed(id, ErrorCode::InvalidRequest, message)
        }
    }
}
