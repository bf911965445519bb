//! Offers changes of the text: the fixes of diagnostics, and the layout of the formatter.

use std::ops::Range;

use super::{analysis::Analysis, tokens::file};
use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Fix},
    format::format_parsed,
    scene,
    source::{SourceId, Span},
    syntax::tokens::{Lexer, TokenKind},
};

/// Returns the fixes of all problems whose first label touches the byte range `within`, as pairs of
/// a problem and a fix. The first label is the place where editors underline a problem.
pub fn fixes<'a>(
    analysis: &'a Analysis<'_>,
    within: Span,
) -> impl Iterator<Item = (&'a Diagnostic, &'a Fix)> {
    let touches = move |diagnostic: &&Diagnostic| {
        let place = diagnostic.labels.first().map(|label| label.span);
        place.is_some_and(|place| place.start <= within.end && within.start <= place.end)
    };
    let is_here = |fix: &&Fix| {
        let mut edits = fix.edits.iter();
        edits.all(|edit| edit.span.source == SourceId::File)
    };
    let touched = analysis.diagnostics().iter().filter(touches);
    touched.flat_map(move |diagnostic| {
        let fixes = diagnostic.fixes.iter().filter(is_here);
        fixes.map(move |fix| (diagnostic, fix))
    })
}

/// Returns the byte ranges of the placeholders in `written`, the new text of a fix that inserts
/// example values. A placeholder is a number or a list that the author is to replace. If `written`
/// contains neither, the whole text is the placeholder.
pub fn made_up_values(written: &str) -> Vec<Range<usize>> {
    let mut values: Vec<Range<usize>> = Vec::new();
    let (mut lexer, mut open) = (Lexer::new(written, 0), 0_usize);
    loop {
        let token = lexer.token();
        if token.kind == TokenKind::End {
            break;
        }
        let word = written.get(token.start..token.end);
        match values.last_mut() {
            Some(last) if open > 0 => last.end = token.end,
            _ if word == Some("(") || token.kind == TokenKind::Number => {
                values.push(token.start..token.end);
            }
            _ => {}
        }
        match word {
            Some("(") => open += 1,
            Some(")") => open = open.saturating_sub(1),
            _ => {}
        }
    }
    if values.is_empty() {
        let start = written.len() - written.trim_start().len();
        values.push(start..written.trim_end().len().max(start));
    }
    values
}

/// Returns one fix that contains the safe fixes of all problems of the text. Returns `None` if no
/// problem has a safe fix.
pub fn fix_all(analysis: &Analysis<'_>) -> Option<Fix> {
    let fixed = scene::fix_all(analysis.model.sources(), Applicability::Safe);
    let edit = change(analysis.text(), &fixed.text);
    (!fixed.done.is_empty()).then(|| Fix::new("fix all that can be fixed safely", edit).safe())
}

/// Returns the edits that give the text the layout of the formatter. Returns `None` if the text has
/// syntax errors.
pub fn formatting(analysis: &Analysis<'_>) -> Option<Vec<Edit>> {
    let formatted = format_parsed(analysis.source(), &analysis.model.parsed)?;
    let edit = change(analysis.text(), &formatted);
    Some(edit.into_iter().collect())
}

/// Returns the smallest single edit that turns one text into another; `None` if they are equal.
fn change(text: &str, new: &str) -> Option<Edit> {
    if text == new {
        return None;
    }
    let same = |(a, b): &(char, char)| a == b;
    let width = |(c, _): (char, char)| c.len_utf8();
    let start: usize = text
        .chars()
        .zip(new.chars())
        .take_while(same)
        .map(width)
        .sum();
    let [old, new] = [text, new].map(|text| text.get(start..).unwrap_or_default());
    let backwards = old.chars().rev().zip(new.chars().rev());
    let end: usize = backwards.take_while(same).map(width).sum();
    let place = file(start, text.len() - end);
    let written = new.get(..new.len() - end).unwrap_or_default();
    Some(Edit::new(place, written))
}
