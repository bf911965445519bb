//! Types of the language server protocol that the server reads or that several answers share. Other
//! answers are made directly as JSON, because a crate with all types of the protocol took nine
//! seconds to compile.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// URI by which the client identifies a document.
#[derive(Clone, Debug, Deserialize, Eq, Hash, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Uri(pub String);

/// A position between two characters. Line and column are counted from 0.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub struct Position {
    pub line: u32,
    pub character: u32,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub struct Range {
    pub start: Position,
    pub end: Position,
}

/// A colour; each channel ranges from 0 to 1.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Color {
    pub red: f32,
    pub green: f32,
    pub blue: f32,
    pub alpha: f32,
}

/// Removes the fields of a JSON object that are null, since the protocol omits missing values.
pub fn without_nulls(mut object: Value) -> Value {
    if let Value::Object(fields) = &mut object {
        fields.retain(|_, field| !field.is_null());
    }
    object
}
