//! Quick fixes: the ways out of a diagnostic that are edits.

use super::{Analysis, formatting, words::file};
use crate::{
    diagnostic::{self, Diagnostic, Edit, Fix},
    format::format,
    scene,
    source::{Source, SourceId, Span},
};

/// The ways out of the problems that a range touches, each with its problem. A problem counts where its first place is: the place
/// that an editor underlines. A text in the canonical layout keeps that.
pub fn fixes<'a>(analysis: &'a Analysis<'_>, within: Span) -> Vec<(&'a Diagnostic, Fix)> {
    let touches = |diagnostic: &&Diagnostic| {
        let place = diagnostic.labels.first().map(|label| label.span);
        place.is_some_and(|place| place.start <= within.end && within.start <= place.end)
    };
    let is_here = |fix: &&Fix| {
        let mut edits = fix.edits.iter();
        edits.all(|edit| edit.span.source == SourceId::File)
    };
    let touched = analysis.diagnostics().iter().filter(touches);
    let fixes = touched.flat_map(|diagnostic| {
        let fixes = diagnostic.fixes.iter().filter(is_here);
        fixes.map(move |fix| (diagnostic, fix))
    });
    let fixes: Vec<_> = fixes.collect();
    let keeps_layout = !fixes.is_empty() && is_laid_out(analysis);
    let fixes = fixes.into_iter();
    let fixes = fixes.map(|(diagnostic, fix)| {
        let laid_out = keeps_layout
            .then(|| laid_out(analysis.text(), fix))
            .flatten();
        (diagnostic, laid_out.unwrap_or_else(|| fix.clone()))
    });
    fixes.collect()
}

/// Whether a text is so short that it can be read again for every fix that is offered without anybody's seeing it.
pub fn is_short(analysis: &Analysis<'_>) -> bool {
    analysis.text().len() <= 1 << 15
}

/// Whether a text is short, and in the canonical layout.
fn is_laid_out(analysis: &Analysis<'_>) -> bool {
    is_short(analysis) && formatting(analysis).is_some_and(|changes| changes.is_empty())
}

/// The fix with the text that it leads to laid out, if that changes anything.
fn laid_out(text: &str, fix: &Fix) -> Option<Fix> {
    let fixed = diagnostic::apply(fix, SourceId::File, text);
    let laid_out = format(&Source::from_text("", fixed.as_str())).ok()?;
    let edit = change(text, &laid_out);
    (laid_out != fixed).then(|| Fix::new(fix.title.as_str(), [edit]))
}

/// All that can be put right without being asked, as one change; none if nothing can.
pub fn fix_all(analysis: &Analysis<'_>) -> Option<Fix> {
    let fixed = scene::fix_all(analysis.survey.sources());
    let edit = change(analysis.text(), &fixed.text);
    (!fixed.done.is_empty()).then(|| Fix::new("fix all that can be fixed", [edit]))
}

/// What has to take the place of what for a text to become another one.
fn change(text: &str, new: &str) -> Edit {
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
    Edit::new(place, written)
}
