//! Applies the first applicable fix of each error. Repeats this step until the text no longer
//! changes.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::lower::read;
use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Fix, apply},
    source::{LineColumn, Source, SourceId, Sources},
};

/// Result of [`fix_all`]: the corrected text, the applied fixes, and the numbers of errors that
/// remain.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fixed {
    /// The corrected text.
    pub text: String,
    /// The fixes that were applied, in order.
    pub done: Vec<Done>,
    /// Number of remaining errors that only unsafe fixes would correct. It is 0 if unsafe fixes
    /// were allowed. A fix is unsafe if it chooses one of several possible meanings, or if it
    /// removes or changes something that the author wrote.
    pub held_back: usize,
    /// Number of remaining errors whose fixes insert only a placeholder, i.e. a made-up value.
    /// Fixes with placeholders are never applied.
    pub placeholders: usize,
    /// Number of remaining errors whose fixes were allowed but not applied. There are such errors
    /// if the maximum number of rounds was reached, or if the text contains bytes that are not
    /// UTF-8. A changed text would lose these bytes.
    pub waiting: usize,
}

/// A fix that was applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Done {
    /// Line and column of the problem in the text to which the fix was applied. Earlier fixes may
    /// have changed the lines of the file.
    pub place: LineColumn,
    /// The title of the fix.
    pub title: String,
}

/// Corrects the errors of a file. Applies safe fixes, and also unsafe ones unless `most` is
/// [`Applicability::Safe`]. Fixes with placeholders are never applied. Errors in `--set` arguments
/// remain, and so do warnings, because what a warning reports may be intended.
pub fn fix_all(sources: &Sources, most: Applicability) -> Fixed {
    let most = most.min(Applicability::Unsafe);
    /// Maximum number of rounds of fixes. A fix may reveal a hidden mistake, which is fixed in the
    /// next round. The limit only makes sure that the function ends; texts are expected to need far
    /// fewer rounds. Errors that have a fix after the last round are counted as `waiting`.
    const ROUNDS: usize = 1000;
    /// Maximum number of bytes that all rounds of fixes parse in total, 32 MiB. The maximum limits
    /// the time. A text of 1 MiB gets at most 32 rounds, so a mistake in it that shows only after
    /// many other fixes may remain. With a larger maximum, fewer mistakes would remain, but the
    /// time could be longer.
    const READ: usize = 1 << 25;
    let mut sources = sources.clone();
    let mut problems = read(&sources).diagnostics;
    let mut done = Vec::new();
    // Problems that remained although their fixes were applied. These fixes are not applied again
    // until other fixes have changed the text.
    let mut staying: HashSet<Problem> = HashSet::new();
    let mut seen = HashSet::new();
    // A fixed text would lose bytes that are not UTF-8, so such a text is not fixed.
    let rounds = if sources.file.invalid_utf8().is_empty() {
        ROUNDS.min(READ / sources.file.text().len().max(1)).max(1)
    } else {
        0
    };
    let mut is_finished = false;
    for _ in 0..rounds {
        let round = Round::new(&sources, &problems, &staying, most);
        let text = apply(&round.fix, SourceId::File, sources.file.text());
        if round.done.is_empty() || seen.contains(&text) {
            is_finished = true;
            break;
        }
        let mut after = sources.clone();
        after.file = Source::from_text(sources.file.name(), text.clone());
        let problems_after = read(&after).diagnostics;
        let still: HashSet<Problem> = problems_after.iter().filter_map(Problem::of).collect();
        let stays = |problem: &&Problem| still.contains(&round.moved(problem));
        let is_idle = |alike: &&Vec<Problem>| alike.iter().all(|problem| stays(&problem));
        let idle = round.lengthened.values().filter(is_idle).flatten();
        let idle: Vec<Problem> = idle.cloned().collect();
        if !idle.is_empty() {
            // The problems in `idle` remain although their fixes were applied. The round is
            // repeated without these fixes.
            staying.extend(idle);
            continue;
        }
        staying.clear();
        seen.insert(text);
        (sources, problems) = (after, problems_after);
        done.extend(round.done);
    }
    let errors = problems.iter().filter(|problem| problem.is_error());
    let first = |problem: &Diagnostic| problem.fixes.iter().map(|fix| fix.applicability).min();
    let left: Vec<Applicability> = errors.filter_map(first).collect();
    let count = |kind| left.iter().filter(|&&other| other == kind).count();
    Fixed {
        text: sources.file.text().to_owned(),
        done,
        held_back: match most {
            Applicability::Safe => count(Applicability::Unsafe),
            _ => 0,
        },
        placeholders: count(Applicability::Placeholder),
        waiting: if is_finished {
            0
        } else {
            left.iter().filter(|&&other| other <= most).count()
        },
    }
}

/// Code, message and place of a problem, by which it is recognized in a changed text.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Problem {
    code: String,
    message: String,
    start: usize,
}

impl Problem {
    fn of(diagnostic: &Diagnostic) -> Option<Self> {
        Some(Self {
            code: diagnostic.code.clone(),
            message: diagnostic.message.clone(),
            start: diagnostic.labels.first()?.span.start,
        })
    }
}

/// The fixes of one round: the first applicable fix of each error, joined into one. If two fixes
/// would change the same place, only the first is included; the other is left for the next round.
struct Round {
    fix: Fix,
    /// Fixes that lengthen the text, each mapped to the problems that offer it. If all of these
    /// problems remain after the fix was applied, the fix is excluded from the next round, because
    /// it could be applied again and again.
    lengthened: HashMap<Vec<Edit>, Vec<Problem>>,
    done: Vec<Done>,
    /// Maps the offset of each edit to the number of bytes by which the edit lengthens the text.
    growth: BTreeMap<usize, isize>,
}

impl Round {
    fn new(
        sources: &Sources,
        problems: &[Diagnostic],
        staying: &HashSet<Problem>,
        most: Applicability,
    ) -> Self {
        let may_apply = |fix: &&Fix| fix.applicability <= most;
        let mut edits: Vec<Edit> = Vec::new();
        // Spans of the text that this round changes, as a map from a span's start to its end. The
        // spans do not touch each other.
        let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
        let (mut lengthened, mut done) = (HashMap::<_, Vec<_>>::new(), Vec::new());
        for diagnostic in problems.iter().filter(|problem| problem.is_error()) {
            let fix = diagnostic.fixes.iter().find(may_apply);
            let (Some(problem), Some(fix)) = (Problem::of(diagnostic), fix) else {
                continue;
            };
            let is_free = |edit: &Edit| {
                let before = taken.range(..=edit.span.end).next_back();
                edit.span.source == SourceId::File
                    && before.is_none_or(|(_, &end)| end < edit.span.start)
            };
            if staying.contains(&problem) {
                continue;
            }
            if let Some(alike) = lengthened.get_mut(&fix.edits) {
                alike.push(problem);
                continue;
            }
            if !fix.edits.iter().all(is_free) {
                continue;
            }
            taken.extend(
                fix.edits
                    .iter()
                    .map(|edit| (edit.span.start, edit.span.end)),
            );
            edits.extend(fix.edits.iter().cloned());
            done.push(Done {
                place: sources.file.place(problem.start),
                title: fix.title.clone(),
            });
            if fix.edits.iter().map(growth).sum::<isize>() > 0 {
                lengthened.insert(fix.edits.clone(), vec![problem]);
            }
        }
        let growth = edits.iter().map(|edit| (edit.span.start, growth(edit)));
        Self {
            growth: growth.collect(),
            fix: Fix::new("fix all", edits),
            lengthened,
            done,
        }
    }

    /// Returns a copy of the problem whose `start` is the offset after the edits of this round.
    fn moved(&self, problem: &Problem) -> Problem {
        let grown: isize = self
            .growth
            .range(..problem.start)
            .map(|(_, grown)| grown)
            .sum();
        Problem {
            start: problem.start.saturating_add_signed(grown),
            ..problem.clone()
        }
    }
}

/// Returns the number of bytes by which an edit lengthens the text.
fn growth(edit: &Edit) -> isize {
    edit.text.len() as isize - (edit.span.end - edit.span.start) as isize
}
