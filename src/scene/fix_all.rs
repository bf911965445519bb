//! All that can be put right without being asked: the first fix of each error, again until nothing changes.

use std::collections::{BTreeMap, HashSet};

use super::read;
use crate::{
    diagnostic::{Edit, Fix, apply},
    source::{Place, Source, SourceId, Sources},
};

/// A text after its errors were fixed.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// The text.
    pub text: String,
    /// What was done, in order.
    pub done: Vec<Done>,
}

/// A fix that was applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Done {
    /// Where the problem was, in the text as it was then.
    pub place: Place,
    /// What the fix does.
    pub title: String,
}

/// Fixes the errors of a file. Those in arguments stay, and warnings are not touched: what they tell of may be meant.
pub fn fix_all(sources: &Sources) -> Fixed {
    /// A fix can show what another mistake hid; so many in a row are more than any text has.
    const ROUNDS: usize = 1000;
    let mut sources = sources.clone();
    let mut done = Vec::new();
    let mut seen = HashSet::new();
    // Bytes that are no text would be lost.
    let rounds = match sources.file.invalid_utf8().is_empty() {
        true => ROUNDS,
        false => 0,
    };
    for _ in 0..rounds {
        let (fix, now_done) = one_round(&sources);
        let text = apply(&fix, SourceId::File, sources.file.text());
        if now_done.is_empty() || !seen.insert(text.clone()) {
            break;
        }
        sources.file = Source::from_text(sources.file.name(), text);
        done.extend(now_done);
    }
    Fixed {
        text: sources.file.text().to_owned(),
        done,
    }
}

/// The first fixes of all errors as one, but for those that would change what another one changes: they wait for the next round.
fn one_round(sources: &Sources) -> (Fix, Vec<Done>) {
    let mut edits: Vec<Edit> = Vec::new();
    // The ends of the places that are changed, by their starts. No two of them touch.
    let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
    let mut done = Vec::new();
    for diagnostic in read(sources).diagnostics {
        let (Some(label), Some(fix)) = (diagnostic.labels.first(), diagnostic.fixes.first()) else {
            continue;
        };
        let is_free = |edit: &Edit| {
            let before = taken.range(..=edit.span.end).next_back();
            edit.span.source == SourceId::File
                && before.is_none_or(|(_, &end)| end < edit.span.start)
        };
        if !diagnostic.is_error() || !fix.edits.iter().all(is_free) {
            continue;
        }
        taken.extend(
            fix.edits
                .iter()
                .map(|edit| (edit.span.start, edit.span.end)),
        );
        edits.extend(fix.edits.iter().cloned());
        done.push(Done {
            place: sources.file.place(label.span.start),
            title: fix.title.clone(),
        });
    }
    (Fix::new("fix all", edits), done)
}
