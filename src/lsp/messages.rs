//! Messages as JSON.

use lsp_server::{ErrorCode, Message};
use serde::Serialize;
use serde_json::{Value, json};

/// Why a text is no message.
#[derive(Debug)]
pub enum Malformed {
    /// The response that it gets.
    Answered(Value),
    /// It gets none, as responses do; what is to be said to a log.
    Unanswered(String),
}

/// The message that a text is.
///
/// # Errors
///
/// It is none.
pub fn read(text: &[u8]) -> Result<Message, Malformed> {
    let malformed = |id, code: ErrorCode, message: String| {
        // A response of lsp-server cannot have the id null.
        let error = json!({ "code": code as i32, "message": message });
        let response = json!({ "jsonrpc": "2.0", "id": id, "error": error });
        Err(Malformed::Answered(response))
    };
    let value: Value = match serde_json::from_slice(text) {
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
        Ok(message) if is_call || is_response => Ok(message),
        _ if is_response => Err(Malformed::Unanswered("a response to nothing".to_owned())),
        _ => {
            let message = "this is neither a request nor a notification".to_owned();
            malformed(id, ErrorCode::InvalidRequest, message)
        }
    }
}

/// The text of a message.
pub fn written(message: &Message) -> String {
    #[derive(Serialize)]
    struct Text<'a> {
        jsonrpc: &'static str,
        #[serde(flatten)]
        message: &'a Message,
    }
    let text = Text {
        jsonrpc: "2.0",
        message,
    };
    // Nothing in a message cannot be written: its keys are texts.
    serde_json::to_string(&text).unwrap_or_default()
}
