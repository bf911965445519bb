//! Parameters and results of requests as JSON, and errors.

use lsp_server::{ErrorCode, Message, RequestId, Response};
use serde_json::Value;

/// The error that answers a request.
#[derive(Debug)]
pub struct Refusal(pub ErrorCode, pub String);

impl Refusal {
    /// The parameters are invalid.
    pub fn invalid(why: impl ToString) -> Self {
        Self(ErrorCode::InvalidParams, why.to_string())
    }

    /// The request is valid, but cannot be carried out. Editors show the reason.
    pub fn failed(why: impl ToString) -> Self {
        Self(ErrorCode::RequestFailed, why.to_string())
    }

    /// The client has cancelled the request.
    pub fn cancelled() -> Self {
        Self(ErrorCode::RequestCanceled, "cancelled".to_owned())
    }

    /// The method is unknown.
    pub fn unknown(method: &str) -> Self {
        let why = format!("`{method}` is not known here");
        Self(ErrorCode::MethodNotFound, why)
    }
}

/// The answer to a request, as JSON.
pub type Answer = Result<Value, Refusal>;

/// Reads the value at a JSON pointer in the parameters.
pub fn at<T: serde::de::DeserializeOwned>(params: &Value, path: &str) -> Result<T, Refusal> {
    let found = params.pointer(path).cloned().unwrap_or_default();
    serde_json::from_value(found).map_err(Refusal::invalid)
}

/// Reads a field of the parameters; `None` if it is missing or null.
pub fn optional<T: serde::de::DeserializeOwned>(
    params: &Value,
    name: &str,
) -> Result<Option<T>, Refusal> {
    let field = params.get(name).cloned().unwrap_or_default();
    serde_json::from_value(field).map_err(|error| Refusal::invalid(format!("`{name}`: {error}")))
}

/// Returns the message that answers a request.
pub fn response(id: RequestId, answer: Answer) -> Message {
    let response = match answer {
        Ok(result) => Response::new_ok(id, result),
        Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
    };
    response.into()
}
