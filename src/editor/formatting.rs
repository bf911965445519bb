//! The canonical layout, as the fewest changes that lead to it.
//!
//! Only white space changes, so that a change is a run of it that takes the place of another. Whatever an editor remembers of
//! the text (the cursor, marks, folds) stays where it was.

use super::{Analysis, tokens::file};
use crate::{format::format_parsed, source::Span};

/// What takes the place of what; nothing if the text has mistakes of syntax.
pub fn formatting(analysis: &Analysis<'_>) -> Option<Vec<(Span, String)>> {
    let formatted = format_parsed(analysis.source(), &analysis.model.parsed)?;
    Some(changes(analysis.text(), &formatted))
}

fn changes(old: &str, new: &str) -> Vec<(Span, String)> {
    let mut changes = Vec::new();
    let (mut from, mut to) = (0, 0);
    loop {
        let [before, after] = [(old, from), (new, to)].map(|(text, at)| {
            let rest = text.get(at..).unwrap_or_default();
            let blank = rest.len() - rest.trim_ascii_start().len();
            rest.get(..blank).unwrap_or_default()
        });
        if before != after {
            // Of a run that only grows or shrinks, its start stays.
            let same = before
                .bytes()
                .zip(after.bytes())
                .take_while(|(a, b)| a == b)
                .count();
            let end = from + before.len();
            let change = after.get(same..).unwrap_or_default();
            changes.push((file(from + same, end), change.to_owned()));
        }
        from += before.len();
        to += after.len();
        // One layout may part what the other joins: no more is looked at than is passed.
        let [left, right] = [(old, from), (new, to)]
            .map(|(text, at)| text.as_bytes().get(at..).unwrap_or_default());
        let is_ink = |byte: &u8| !byte.is_ascii_whitespace();
        let both = left.iter().zip(right);
        let ink = both.take_while(|(a, b)| is_ink(a) && is_ink(b)).count();
        if ink == 0 {
            return changes;
        }
        from += ink;
        to += ink;
    }
}
