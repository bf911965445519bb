//! Finds the signature of the function whose arguments are being typed.

use super::{analysis::Analysis, cursor};
use crate::{scene::describe, schema, source::Span};
use std::ops::Range;

/// Signature of a function, shown while its arguments are being typed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// The displayed signature, such as `atan2(y, x) → angle`.
    pub label: String,
    /// Description of the function, in one line.
    pub help: &'static str,
    /// Byte ranges of the parameters in the label.
    pub parameters: Vec<Range<usize>>,
    /// Index of the parameter that is being typed, counted from 0.
    pub active: usize,
    /// Span of the function's name in the text.
    pub span: Span,
}

/// Returns the signature of the function in the innermost call around the offset `at`. Returns
/// `None` if no call of a known function surrounds it.
pub fn signature(analysis: &Analysis<'_>, at: usize) -> Option<Signature> {
    let at = analysis.source().floor_char_boundary(at);
    let (span, index) = cursor::call(analysis, at)?;
    let function = schema::function(analysis.slice(span))?;
    let (label, parameters) = describe::signature(function);
    let last = parameters.len().saturating_sub(1);
    Some(Signature {
        label,
        help: function.help,
        active: if function.more {
            index.min(last)
        } else {
            index
        },
        parameters,
        span,
    })
}
