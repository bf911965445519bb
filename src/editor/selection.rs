//! What a growing selection takes in: the word, the expressions around it, the field, the block, the file.

use super::{Analysis, tokens::file};
use crate::source::Span;

/// The spans around a place, each within the next one; the last is the whole file.
pub fn selection(analysis: &Analysis<'_>, at: usize) -> Vec<Span> {
    let path = analysis.path(at);
    let mut spans = Vec::new();
    let comments = analysis.comments();
    let next = comments.partition_point(|comment| comment.end < at);
    let comment = comments.get(next).filter(|comment| comment.start <= at);
    spans.extend(comment.copied());
    if comment.is_none() {
        spans.extend(analysis.token_at(at).map(|token| token.span));
    }
    spans.extend(path.values.iter().rev().map(|value| value.span));
    spans.extend(path.field.map(|field| field.span));
    if let Some(block) = path.block {
        // What stands between the braces, without the blanks next to them.
        if let (Some(open), Some(close)) = (block.open, block.close) {
            let inner = analysis.source().slice(open.end..close.start);
            let start = open.end + inner.len() - inner.trim_start().len();
            spans.push(file(start, start + inner.trim().len()));
        }
        spans.push(block.span);
    }
    spans.extend(path.definition.map(|definition| definition.span));
    spans.push(file(0, analysis.text().len()));
    growing(spans, at)
}

/// Those that hold the place, each larger than the one before it.
fn growing(spans: Vec<Span>, at: usize) -> Vec<Span> {
    let mut growing: Vec<Span> = Vec::new();
    for span in spans {
        let holds = span.start <= at && at <= span.end && !span.range().is_empty();
        let grows = growing
            .last()
            .is_none_or(|last| span.start <= last.start && last.end <= span.end && *last != span);
        if holds && grows {
            growing.push(span);
        }
    }
    growing
}
