//! Quick fixes: the ways out of a diagnostic that are edits.

use super::Analysis;
use crate::{
    diagnostic::{Diagnostic, Fix},
    source::{SourceId, Span},
};

/// The ways out of the problems that a range touches, each with its problem. A problem counts where its first place is: the place
/// that an editor underlines.
pub fn fixes<'a>(analysis: &'a Analysis<'_>, within: Span) -> Vec<(&'a Diagnostic, &'a Fix)> {
    let touches = |diagnostic: &&Diagnostic| {
        let place = diagnostic.labels.first().map(|label| label.span);
        place.is_some_and(|place| place.start <= within.end && within.start <= place.end)
    };
    let is_here = |fix: &&Fix| {
        let mut edits = fix.edits.iter();
        edits.all(|edit| edit.span.source == SourceId::File)
    };
    let touched = analysis.diagnostics().iter().filter(touches);
    touched
        .flat_map(|diagnostic| {
            let fixes = diagnostic.fixes.iter().filter(is_here);
            fixes.map(move |fix| (diagnostic, fix))
        })
        .collect()
}
