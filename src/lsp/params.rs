//! Parameters and results as JSON, and why a request gets none.

use lsp_server::{ErrorCode, Message, RequestId, Response};
use serde_json::Value;

/// Why a request gets no answer.
#[derive(Debug)]
pub struct Refusal(pub ErrorCode, pub String);

impl Refusal {
    /// What was asked is not what can be asked.
    pub fn invalid(why: impl ToString) -> Self {
        Self(ErrorCode::InvalidParams, why.to_string())
    }

    /// The request was right, and cannot be done; editors show the reason.
    pub fn failed(why: impl ToString) -> Self {
        Self(ErrorCode::RequestFailed, why.to_string())
    }

    /// The client does not want the answer any more.
    pub fn cancelled() -> Self {
        Self(ErrorCode::RequestCanceled, "cancelled".to_owned())
    }

    /// There is no such method.
    pub fn unknown(method: &str) -> Self {
        let why = format!("`{method}` is not known here");
        Self(ErrorCode::MethodNotFound, why)
    }
}

/// What is answered, as JSON.
pub type Answer = Result<Value, Refusal>;

/// What stands at a place in the parameters.
pub fn at<T: serde::de::DeserializeOwned>(params: &Value, path: &str) -> Result<T, Refusal> {
    let found = params.pointer(path).cloned().unwrap_or_default();
    serde_json::from_value(found).map_err(Refusal::invalid)
}

/// A field of the parameters; none where it is left out or null.
pub fn optional<T: serde::de::DeserializeOwned>(
    params: &Value,
    name: &str,
) -> Result<Option<T>, Refusal> {
    let field = params.get(name).cloned().unwrap_or_default();
    serde_json::from_value(field).map_err(|error| Refusal::invalid(format!("`{name}`: {error}")))
}

/// The message that answers a request.
pub fn response(id: RequestId, answer: Answer) -> Message {
    let response = match answer {
        Ok(result) => Response::new_ok(id, result),
        Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
    };
    response.into()
}
