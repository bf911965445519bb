//! Finds the lines that can be folded: blocks, and runs of comments.

use super::analysis::Analysis;
use crate::source::{Span, sort_by_span};

/// Lines that can be folded to the first one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fold {
    /// The span from the text of the first line to the end of the last one.
    pub span: Span,
    /// The kind of the lines.
    pub kind: FoldKind,
}

/// A kind of lines that can be folded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FoldKind {
    /// A block.
    Block,
    /// A comment, or several without other text between them.
    Comment,
}

/// Returns all blocks and comments of more than one line.
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

/// Returns runs of comments on consecutive lines of their own, and each comment behind code by
/// itself.
fn runs_of_comments(analysis: &Analysis<'_>) -> Vec<Span> {
    let mut runs: Vec<Span> = Vec::new();
    let mut behind_code = Vec::new();
    for comment in analysis.comments() {
        let source = analysis.source();
        let start = source.line_range(analysis.line(*comment)).start;
        let before = source.slice(start..comment.start);
        let is_alone = before.trim_start_matches('\u{feff}').trim().is_empty();
        if !is_alone {
            // A comment behind code is about that line, so it belongs to no run.
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

/// Whether there is only one line end between two comments.
fn is_next_line(between: &str) -> bool {
    between.trim().is_empty() && between.matches('\n').count() == 1
}
