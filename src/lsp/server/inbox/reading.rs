//! From bytes to messages: a header that announces a length, and so many bytes of JSON.

use std::io::{self, BufRead, Read};

use lsp_server::ErrorCode;
use serde_json::Value;

use super::Incoming;

/// The longest message, in bytes. What announces more has lost its way, and what would follow it is anybody's guess.
const LONGEST: u64 = 1 << 30;

/// The longest line of a header; those that are known take some thirty bytes.
const LONGEST_HEADER: u64 = 4096;

/// Something that is not a message, and has an answer.
#[derive(Debug)]
pub struct Malformed {
    /// The id that it has; null if it has none.
    pub id: Value,
    /// What it lacks.
    pub code: ErrorCode,
    /// The same in words.
    pub message: String,
}

/// Why nothing was read.
pub enum Failed {
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
pub fn next(input: &mut impl BufRead) -> Result<Option<Incoming>, Failed> {
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
