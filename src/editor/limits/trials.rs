//! Analyzes the text again with other numbers in it, to find out whether these numbers cause
//! errors.

use super::literal::{Literal, rounded};
use crate::{
    editor::Analysis,
    source::{Source, Sources},
};

/// Maximum cost of all trials for one answer to the editor, in bytes of analyzed text. A trial
/// analyzes the text with another number in it; a text of 1 KiB can be tried 64 times. With a
/// larger maximum, the limits of sliders in long texts would be found more often, but the answer
/// could take longer.
const BYTES: usize = 1 << 16;

/// Cost of making one object of a scene, in bytes of text: making an object is assumed to take as
/// long as the analysis of 12 bytes. A rough value suffices, since it serves only to limit the time
/// of an answer.
const OBJECT: usize = 12;

/// Analyses of a text with another number in place of a literal. Their total cost is limited by
/// [`BYTES`].
#[derive(Debug)]
pub struct Trials<'a, 's> {
    analysis: &'a Analysis<'s>,
    /// Number of errors in the unchanged text.
    errors: usize,
    /// Cost of the trials that can still be made, in bytes of analyzed text.
    left: usize,
}

impl<'a, 's> Trials<'a, 's> {
    /// Counts the errors of the unchanged text. No trial is made yet.
    pub fn new(analysis: &'a Analysis<'s>) -> Self {
        Self {
            analysis,
            errors: errors(analysis),
            left: BYTES,
        }
    }

    /// Returns whether the text with `value` in place of `literal` has at most as many errors as
    /// the unchanged text. Returns `None` if the trial would cost too much, or if `value` is not
    /// finite. `objects` is an estimate of how many objects the changed text contains.
    fn is_right(&mut self, literal: &Literal, value: f64, objects: usize) -> Option<bool> {
        let read = self.analysis.text().len();
        let takes = read.saturating_add(OBJECT.saturating_mul(objects));
        if takes > self.left || !value.is_finite() {
            return None;
        }
        let text = literal.replaced(self.analysis.source(), value);
        let sources = Sources::new(Source::from_text(self.analysis.source().name(), text));
        let tried = Analysis::new(&sources);
        let made = OBJECT * tried.model.parts.objects.len();
        self.left = self.left.saturating_sub(read + made);
        Some(errors(&tried) <= self.errors)
    }

    /// Estimates how many objects the text contains if `value` replaces the literal `count`.
    /// Assumes the worst case: in the block with the most `for` indices, the literal limits every
    /// index.
    fn objects_with(&self, count: &Literal, value: f64) -> usize {
        let repetitions = self.analysis.blocks().flat_map(|it| &it.repetition);
        let indices = repetitions.map(|it| it.indices.len()).max().unwrap_or(0);
        let growth = (value.abs() / count.value.abs().max(1.0)).max(1.0);
        let objects = self.analysis.model.parts.objects.len().max(1) as f64;
        (0..indices).fold(objects, |all, _| all * growth) as usize
    }

    /// Returns whether the literal seems to be a count, as in `for i < n`. A literal seems to be a
    /// count if it is a whole number, both adding and subtracting 0.1 cause an error, and adding 1
    /// or subtracting 1 causes none.
    pub fn is_count(&mut self, literal: &Literal) -> bool {
        let mut is_right = |by: f64| {
            let value = rounded(literal.value + by, 0.1);
            self.is_right(literal, value, self.objects_with(literal, value))
        };
        literal.is_whole()
            && is_right(0.1) == Some(false)
            && is_right(-0.1) == Some(false)
            && (is_right(1.0) == Some(true) || is_right(-1.0) == Some(true))
    }

    /// Searches the numbers from the literal towards `end`, in steps of `step`, for the last valid
    /// one. A number is valid if the text with this number has no new error. Uses bisection.
    /// Returns `end` if it is valid or cannot be tried. Returns `None` if even the first step
    /// causes an error.
    ///
    /// If the budget for trials runs out during the search, returns the last number found to be
    /// valid, or `end` if none was found. If valid and invalid numbers alternate, returns a valid
    /// number that is followed by an invalid one.
    pub fn last_right(
        &mut self,
        literal: &Literal,
        end: f64,
        step: f64,
        is_count: bool,
    ) -> Option<f64> {
        let objects = if is_count {
            self.objects_with(literal, end)
        } else {
            self.analysis.model.parts.objects.len()
        };
        if end == literal.value || self.is_right(literal, end, objects) != Some(false) {
            return Some(end);
        }
        let way = end - literal.value;
        let at = |steps: u32| {
            let aside = f64::from(steps) * step;
            rounded(literal.value + aside.copysign(way), step)
        };
        let (mut right, mut wrong) = (0, (way.abs() / step).ceil() as u32);
        while wrong - right > 1 {
            let middle = right.midpoint(wrong);
            match self.is_right(literal, at(middle), objects) {
                Some(true) => right = middle,
                Some(false) => wrong = middle,
                None => return Some(if right == 0 { end } else { at(right) }),
            }
        }
        (right > 0).then(|| at(right))
    }
}

/// Returns the number of errors in a text.
fn errors(analysis: &Analysis<'_>) -> usize {
    let diagnostics = analysis.diagnostics().iter();
    diagnostics.filter(|it| it.is_error()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `last_right` looks for the largest number of repetitions, up to 14, that causes no error. If
    /// a block has one index, `last_right` analyzes the scene with 14, which uses up a part of the
    /// budget `left`. If it has five, 14 would make 14^5 objects, half a million. Analyzing them
    /// would take too long, so 14 is accepted without a trial, and `left` stays the same.
    #[test]
    fn a_count_is_not_tried_where_it_would_make_very_many_objects() {
        let heads = [
            ("a < n", true),
            ("a < n, b < n, c < n, d < n, e < n", false),
        ];
        for (head, is_read) in heads {
            let text = format!("let n = 4\nsphere for {head} {{ center (a, 0, 0) }}\n");
            let sources = Sources::new(Source::from_text("", text));
            let analysis = Analysis::new(&sources);
            let definition = analysis.model.definitions().next().unwrap();
            let count = Literal::of(&definition.value).unwrap();
            let mut trials = Trials::new(&analysis);
            assert_eq!(trials.last_right(&count, 14.0, 1.0, true), Some(14.0));
            assert_eq!(trials.left < BYTES, is_read, "{head}");
        }
    }
}
