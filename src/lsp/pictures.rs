//! A request about a document's picture, and its answer: docs/protocol.md has the contract.

use serde_json::Value;

use super::{answers::unknown, convert::Page, params::Answer, prepared::Prepared};
use crate::editor::Analysis;

/// What the names of our own requests begin with.
pub const NAMESPACE: &str = "pinhole/";

/// The answer to a request but that for a frame; null where the text has errors.
pub fn answer(
    about: &str,
    _params: &Value,
    _page: Page<'_>,
    _analysis: &Analysis<'_>,
    prepared: &mut Option<Prepared>,
) -> Answer {
    let Some(_prepared) = prepared else {
        return Ok(Value::Null);
    };
    Err(unknown(&format!("{NAMESPACE}{about}")))
}
