//! Parameters and results as JSON, and why a request gets none.

use lsp_server::ErrorCode;
use serde_json::Value;

/// Why a request gets no answer.
pub struct Refusal(pub ErrorCode, pub String);

/// What is answered, as JSON.
pub type Answer = Result<Value, Refusal>;

/// What was asked, in the protocol's types.
pub fn parsed<T: serde::de::DeserializeOwned>(params: Value) -> Result<T, Refusal> {
    serde_json::from_value(params)
        .map_err(|error| Refusal(ErrorCode::InvalidParams, error.to_string()))
}

/// What is answered, as JSON.
pub fn written(result: &impl serde::Serialize) -> Answer {
    serde_json::to_value(result)
        .map_err(|error| Refusal(ErrorCode::InternalError, error.to_string()))
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
