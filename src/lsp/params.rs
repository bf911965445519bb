//! Parameters and results as JSON, and why a request gets none.

use lsp_server::ErrorCode;
use serde_json::Value;

/// Why a request gets no answer.
pub struct Refusal(pub ErrorCode, pub String);

/// What is answered, as JSON.
pub type Answer = Result<Value, Refusal>;

/// What stands at a place in the parameters.
pub fn at<T: serde::de::DeserializeOwned>(params: &Value, path: &str) -> Result<T, Refusal> {
    let found = params.pointer(path).cloned().unwrap_or_default();
    serde_json::from_value(found)
        .map_err(|error| Refusal(ErrorCode::InvalidParams, error.to_string()))
}

/// A field of the parameters; none where it is left out or null.
pub fn optional<T: serde::de::DeserializeOwned>(
    params: &Value,
    name: &str,
) -> Result<Option<T>, Refusal> {
    let field = params.get(name).cloned().unwrap_or_default();
    serde_json::from_value(field)
        .map_err(|error| Refusal(ErrorCode::InvalidParams, format!("`{name}`: {error}")))
}
