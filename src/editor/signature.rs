//! The function that is being called, and which of its arguments is being written.

use super::{analysis::Analysis, cursor};
use crate::{scene::describe, schema, source::Span};
use std::ops::Range;

/// A function as it is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// `atan2(y, x) → angle`
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
    let at = analysis.source().floor_char_boundary(at);
    let (span, index) = cursor::call(analysis, at)?;
    let function = schema::function(analysis.slice(span))?;
    let (label, parameters) = describe::signature(function);
    let last = parameters.len().saturating_sub(1);
    Some(Signature {
        label,
        help: function.help,
        active: match function.more {
            true => index.min(last),
            false => index,
        },
        parameters,
        span,
    })
}
