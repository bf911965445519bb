//! Reads parameters of requests from JSON, and makes responses and errors.

use lsp_server::{ErrorCode, Message, RequestId, Response};
use serde_json::Value;

/// Error with which a request is answered: an error code and a message.
#[derive(Debug)]
pub struct Refusal(pub ErrorCode, pub String);

impl Refusal {
    /// Makes the error for invalid parameters.
    pub fn invalid(why: impl ToString) -> Self {
        Self(ErrorCode::InvalidParams, why.to_string())
    }

    /// Makes the error for a valid request that cannot be carried out. Editors show the reason.
    pub fn failed(why: impl ToString) -> Self {
        Self(ErrorCode::RequestFailed, why.to_string())
    }

    /// Makes the error for a request that the client has cancelled.
    pub fn cancelled() -> Self {
        Self(ErrorCode::RequestCanceled, "cancelled".to_owned())
    }

    /// Makes the error for a request with an unknown method.
    pub fn unknown(method: &str) -> Self {
        let why = format!("`{method}` is not known here");
        Self(ErrorCode::MethodNotFound, why)
    }
}

/// The answer to a request as JSON, or the error that answers it instead.
pub type Answer = Result<Value, Refusal>;

/// Reads the value at the JSON pointer `path` in the parameters. A missing value is read as null.
/// Returns an error if the value has another type than `T`.
pub fn at<T: serde::de::DeserializeOwned>(params: &Value, path: &str) -> Result<T, Refusal> {
    let found = params.pointer(path).cloned().unwrap_or_default();
    serde_json::from_value(found).map_err(Refusal::invalid)
}

/// Reads a field of the parameters. Returns `None` if it is missing or null.
///
/// # Errors
///
/// Returns an error if the field has another type than `T`.
pub fn optional<T: serde::de::DeserializeOwned>(
    params: &Value,
    name: &str,
) -> Result<Option<T>, Refusal> {
    let field = params.get(name).cloned().unwrap_or_default();
    serde_json::from_value(field).map_err(|error| Refusal::invalid(format!("`{name}`: {error}")))
}

/// Makes the message that answers the request `id`.
pub fn response(id: RequestId, answer: Answer) -> Message {
    let response = match answer {
        Ok(result) => Response::new_ok(id, result),
        Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
    };
    response.into()
}
