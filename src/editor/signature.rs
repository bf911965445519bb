//! The function that is being called, and which of its arguments is being written.

use super::Analysis;
use crate::{
    scene::schema::{self, Function, Type},
    source::Span,
};
use std::ops::Range;

/// A function as it is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// `atan2(number, number) → angle`
    pub label: String,
    /// What it is, in a line.
    pub help: &'static str,
    /// Where each parameter stands in the label, in bytes.
    pub parameters: Vec<Range<usize>>,
    /// Which one is being written.
    pub active: usize,
    /// The function's name in the text.
    pub span: Span,
}

/// The innermost call around a place.
pub fn signature(analysis: &Analysis<'_>, at: usize) -> Option<Signature> {
    let (span, commas) = analysis.call(at)?;
    let function = schema::function(analysis.slice(span))?;
    let (label, parameters) = label(function);
    let last = parameters.len().saturating_sub(1);
    Some(Signature {
        label,
        help: function.help,
        active: match function.more {
            true => commas.min(last),
            false => commas,
        },
        parameters,
        span,
    })
}

/// How a function is called, and where its parameters stand in that.
pub(super) fn label(function: &Function) -> (String, Vec<Range<usize>>) {
    let mut label = format!("{}(", function.name);
    let mut parameters = Vec::new();
    for (index, takes) in function.takes.iter().enumerate() {
        if index > 0 {
            label.push_str(", ");
        }
        let start = label.len();
        // The name of an argument stands for it, or its type.
        let name = function.parameters.get(index);
        label.push_str(name.copied().unwrap_or_else(|| bare(*takes)));
        parameters.push(start..label.len());
    }
    if function.more {
        label.push_str(", ");
        let start = label.len();
        label.push('…');
        parameters.push(start..label.len());
    }
    label.push_str(&format!(") → {}", bare(function.gives)));
    (label, parameters)
}

/// A type without its article.
pub(super) fn bare(kind: Type) -> &'static str {
    let noun = kind.noun();
    noun.split_once(' ').map_or(noun, |(_, bare)| bare)
}
