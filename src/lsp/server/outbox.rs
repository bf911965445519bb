//! What is said to a client: responses and notifications, each written at once.

use std::io::{self, Write};

use gen_lsp_types as lsp;
use lsp_server::ErrorCode;
use serde_json::{Value, json};

/// Why a request gets no answer.
pub struct Refusal(pub ErrorCode, pub String);

/// A result as JSON, written at once: an answer of thousands of tokens needs no tree of values in between.
pub type Answer = Result<String, Refusal>;

/// What was asked, in the protocol's types.
pub fn parsed<T: serde::de::DeserializeOwned>(params: Value) -> Result<T, Refusal> {
    serde_json::from_value(params)
        .map_err(|error| Refusal(ErrorCode::InvalidParams, error.to_string()))
}

/// What is answered, as JSON.
pub fn written(result: &impl serde::Serialize) -> Answer {
    serde_json::to_string(result)
        .map_err(|error| Refusal(ErrorCode::InternalError, error.to_string()))
}

/// Writes a response.
pub fn respond(
    output: &mut dyn Write,
    id: &impl serde::Serialize,
    answer: Answer,
) -> io::Result<()> {
    let id = json!(id);
    send(
        output,
        &match answer {
            Ok(result) => format!("{{\"jsonrpc\":\"2.0\",\"id\":{id},\"result\":{result}}}"),
            Err(Refusal(code, message)) => {
                let error = json!({ "code": code as i32, "message": message });
                json!({ "jsonrpc": "2.0", "id": id, "error": error }).to_string()
            }
        },
    )
}

/// Writes what is wrong with a text; nothing is with one that was closed.
pub fn publish(
    output: &mut dyn Write,
    uri: &lsp::Uri,
    version: Option<i32>,
    diagnostics: &[lsp::Diagnostic],
) -> io::Result<()> {
    let mut params = json!({ "uri": uri, "diagnostics": diagnostics });
    if let Some(version) = version {
        params["version"] = version.into();
    }
    let method = "textDocument/publishDiagnostics";
    let message = json!({ "jsonrpc": "2.0", "method": method, "params": params });
    send(output, &message.to_string())
}

fn send(output: &mut dyn Write, message: &str) -> io::Result<()> {
    write!(output, "Content-Length: {}\r\n\r\n{message}", message.len())?;
    output.flush()
}
