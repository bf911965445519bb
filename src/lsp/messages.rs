//! Reads and writes messages as JSON.

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response, ResponseError};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Maximum number of JSON values in a message; a message with more is refused. Without a limit,
/// parsing a message could exhaust the memory: an object whose text has 8 bytes occupies about 400
/// bytes. A message with 40 000 changes of a text is still below the limit.
const MOST_VALUES: usize = 1 << 19;

/// Error for a text that is not a valid message.
#[derive(Debug)]
pub enum Malformed {
    /// Response to send to the client: an error that says why the text is malformed.
    Answered(Value),
    /// Message for the log, if the text is a malformed response. A response is never answered.
    Unanswered(String),
}

/// Parses a message from JSON.
///
/// # Errors
///
/// Returns [`Malformed`] if the text is not a message.
pub fn read(text: &[u8]) -> Result<Message, Malformed> {
    let malformed = |id, code: ErrorCode, message: String| {
        // The response is made as JSON, because the response type of lsp-server does not support an
        // `id` of null.
        let error = json!({ "code": code as i32, "message": message });
        let response = json!({ "jsonrpc": "2.0", "id": id, "error": error });
        Err(Malformed::Answered(response))
    };
    if value_bound(text) > MOST_VALUES {
        let message = format!("this message has more than {MOST_VALUES} values");
        return malformed(request_id(text), ErrorCode::InvalidRequest, message);
    }
    let value: Value = match serde_json::from_slice(text) {
        Ok(value) => value,
        Err(error) => {
            let message = format!("this is not JSON: {error}");
            return malformed(request_id(text), ErrorCode::ParseError, message);
        }
    };
    if value.is_array() {
        let message = "messages come one by one".to_owned();
        return malformed(Value::Null, ErrorCode::InvalidRequest, message);
    }
    let has = |name: &str| value.get(name).is_some();
    // A response is never answered, even if it is malformed.
    let is_response = !has("method") && (has("result") || has("error"));
    let id = identifier(value.get("id").cloned());
    match message(value) {
        Some(message) => Ok(message),
        None if is_response => Err(Malformed::Unanswered("a response to nothing".to_owned())),
        None => {
            let message = "this is neither a request nor a notification".to_owned();
            malformed(id, ErrorCode::InvalidRequest, message)
        }
    }
}

/// Converts a JSON value to a message. Returns `None` if the value is not a message. The conversion
/// in lsp-server is not used: it would copy each text in the value, and treat a request with an
/// invalid identifier as a notification.
fn message(mut value: Value) -> Option<Message> {
    let mut take = |name: &str| value.get_mut(name).map(Value::take);
    let id = match take("id") {
        None => None,
        Some(Value::String(id)) => Some(RequestId::from(id)),
        // Integers in the protocol have 32 bits, so a larger number is not a valid identifier.
        Some(id) => Some(i32::try_from(id.as_i64()?).ok()?.into()),
    };
    let method = match take("method") {
        None => None,
        Some(Value::String(method)) => Some(method),
        Some(_) => return None,
    };
    let params = take("params").unwrap_or_default();
    Some(match (id, method) {
        (Some(id), Some(method)) => Message::from(Request { id, method, params }),
        (None, Some(method)) => Notification { method, params }.into(),
        (Some(id), None) => {
            let response_result = match take("error") {
                Some(error) => Err(serde_json::from_value(error).ok()?),
                None => Ok(take("result")?),
            };
            let response = Response {
                id,
                response_result,
            };
            response.into()
        }
        (None, None) => return None,
    })
}

/// Returns an upper bound on the number of values in a JSON text. Counts the characters `[`, `,`
/// and `:` outside of strings, since each value except the first follows one of them. Allocates no
/// memory, however many values the text contains.
fn value_bound(text: &[u8]) -> usize {
    let (mut values, mut is_in_text, mut is_escaped) = (1, false, false);
    for byte in text {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = is_in_text,
            b'"' => is_in_text = !is_in_text,
            b'[' | b',' | b':' if !is_in_text => values += 1,
            _ => {}
        }
    }
    values
}

/// Returns the identifier of a request that cannot be parsed, so that the sender can be answered.
/// Returns null if no identifier is found. Browsers can send such requests: a JSON string may
/// contain half of a surrogate pair as an escape, which a Rust string cannot hold.
fn request_id(text: &[u8]) -> Value {
    #[derive(Deserialize)]
    struct Asked {
        id: Value,
    }
    // Only the field `id` is parsed. The other fields are skipped.
    let asked = serde_json::from_slice(text).ok();
    identifier(asked.map(|asked: Asked| asked.id))
}

/// Returns `id` if it is a string or a number, and otherwise null. JSON-RPC requires null in the
/// response to a request whose identifier is unknown.
fn identifier(id: Option<Value>) -> Value {
    id.filter(|id| id.is_string() || id.is_number())
        .unwrap_or_default()
}

/// Serialises a message to JSON.
pub fn to_text(message: &Message) -> String {
    #[derive(Default, Serialize)]
    struct Text<'a> {
        jsonrpc: &'static str,
        #[serde(skip_serializing_if = "Option::is_none")]
        id: Option<&'a RequestId>,
        #[serde(skip_serializing_if = "Option::is_none")]
        method: Option<&'a str>,
        #[serde(skip_serializing_if = "is_none_or_null")]
        params: Option<&'a Value>,
        #[serde(skip_serializing_if = "Option::is_none")]
        result: Option<&'a Value>,
        #[serde(skip_serializing_if = "Option::is_none")]
        error: Option<&'a ResponseError>,
    }
    fn is_none_or_null(params: &Option<&Value>) -> bool {
        params.is_none_or(Value::is_null)
    }
    let mut text = Text {
        jsonrpc: "2.0",
        ..Text::default()
    };
    match message {
        Message::Request(it) => {
            text.id = Some(&it.id);
            text.method = Some(&it.method);
            text.params = Some(&it.params);
        }
        Message::Notification(it) => {
            text.method = Some(&it.method);
            text.params = Some(&it.params);
        }
        Message::Response(it) => {
            text.id = Some(&it.id);
            text.result = it.response_result.as_ref().ok();
            text.error = it.response_result.as_ref().err();
        }
    }
    // Serialising cannot fail, since all keys are strings.
    serde_json::to_string(&text).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_too_many_values_nothing_is_built() {
        let message = |params: &str| format!(r#"{{ "id": 7, "method": "m", "params": {params} }}"#);
        for value in ["[]", "{}", "1", r#"{"a":1}"#, r#"[{"a":[]}]"#] {
            let many = format!("[{value}{}]", format!(",{value}").repeat(MOST_VALUES));
            let Err(Malformed::Answered(response)) = read(message(&many).as_bytes()) else {
                panic!("{value}");
            };
            assert_eq!(response["id"], 7);
            assert_eq!(response["error"]["code"], ErrorCode::InvalidRequest as i32);
        }
        // The first message has a long string and the second 40 000 changes. Both are accepted: a
        // string is one value, even if it contains `[`, `,` and `:`.
        let text = r#"\"[,:\\"#.repeat(MOST_VALUES);
        let place = r#"{ "line": 1, "character": 2 }"#;
        let change =
            format!(r#"{{ "range": {{ "start": {place}, "end": {place} }}, "text": "a" }},"#);
        let changes = change.repeat(40_000);
        for params in [
            format!(r#"{{ "text": "{text}" }}"#),
            format!("[{changes} 1]"),
        ] {
            assert!(read(message(&params).as_bytes()).is_ok(), "{params:.80}");
        }
    }

    #[test]
    fn whoever_asks_gets_an_answer_whatever_the_parameters_are() {
        let deep = format!("{}{}", "[".repeat(1000), "]".repeat(1000));
        for params in [r#""\ud800""#, r#"{ "text": "x\udc00y" }"#, "1e999", &deep] {
            for id in ["7", r#""page-7""#] {
                let text = format!(r#"{{ "id": {id}, "method": "m", "params": {params} }}"#);
                let Err(Malformed::Answered(response)) = read(text.as_bytes()) else {
                    panic!("{text:.80}");
                };
                assert_eq!(response["id"].to_string(), id, "{text:.80}");
                assert_eq!(response["error"]["code"], ErrorCode::ParseError as i32);
            }
        }
        for text in [
            r#"{ "method": "m", "params": "\ud800" }"#,
            "",
            "{",
            r#"{ "id": 7 "#,
        ] {
            let Err(Malformed::Answered(response)) = read(text.as_bytes()) else {
                panic!("{text}");
            };
            assert_eq!(response["id"], Value::Null, "{text}");
        }
    }
}
