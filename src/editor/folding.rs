//! Finds lines that editors can fold: blocks, and comments on consecutive lines.

use super::analysis::Analysis;
use crate::source::{Span, sort_by_span};

/// Consecutive lines that an editor can fold, so that only the first of them is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fold {
    /// Span from the first character of the first line's text to the end of the last line.
    pub span: Span,
    /// Whether the lines are a block or comments.
    pub kind: FoldKind,
}

/// Kind of lines that can be folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FoldKind {
    /// A block with its braces.
    Block,
    /// A comment, or several comments on consecutive lines.
    Comment,
}

/// Returns the lines that can be folded: all blocks and comments of more than one line.
pub fn folds(analysis: &Analysis<'_>) -> Vec<Fold> {
    let takes_lines = |span: &Span| span.end > span.start && analysis.slice(*span).contains('\n');
    let blocks = analysis.blocks().map(|block| block.span);
    let blocks = blocks.filter(takes_lines).map(|span| Fold {
        span,
        kind: FoldKind::Block,
    });
    let comments = runs_of_comments(analysis).into_iter();
    let comments = comments.filter(takes_lines).map(|span| Fold {
        span,
        kind: FoldKind::Comment,
    });
    let mut folds: Vec<Fold> = blocks.chain(comments).collect();
    sort_by_span(&mut folds, |fold| fold.span);
    folds
}

/// Returns the spans of all comments. Comments on consecutive lines without code are joined to one
/// span. A comment after code on its line is not joined with others.
fn runs_of_comments(analysis: &Analysis<'_>) -> Vec<Span> {
    let mut runs: Vec<Span> = Vec::new();
    let mut behind_code = Vec::new();
    for comment in analysis.comments() {
        let source = analysis.source();
        let start = source.line_range(analysis.line(*comment)).start;
        let before = source.slice(start..comment.start);
        let is_alone = before.trim_start_matches('\u{feff}').trim().is_empty();
        if !is_alone {
            // A comment after code describes that line, so it is not joined with others.
            behind_code.push(*comment);
            continue;
        }
        match runs.last_mut() {
            Some(run) if is_next_line(source.slice(run.end..comment.start)) => {
                run.end = comment.end;
            }
            _ => runs.push(*comment),
        }
    }
    runs.extend(behind_code);
    runs
}

/// Returns whether the text between two comments is a single line end, with or without blanks.
fn is_next_line(between: &str) -> bool {
    between.trim().is_empty() && between.matches('\n').count() == 1
}
