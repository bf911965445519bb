//! All that can be put right at once: the first fix of each error that may be applied, again until
//! nothing changes.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::lower::read;
use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Fix, apply},
    source::{LineColumn, Source, SourceId, Sources},
};

/// A text after its errors were fixed.
#[derive(Clone, Debug)]
pub struct Fixed {
    /// The text.
    pub text: String,
    /// What was done, in order.
    pub done: Vec<Done>,
    /// Number of errors left whose fixes choose among meanings, or remove or change something.
    pub held_back: usize,
    /// Number of errors left whose fixes only make up a value.
    pub placeholders: usize,
    /// Number of errors left whose fixes another call would apply: the text has too many of them
    /// for one call, or bytes that are not UTF-8, which a fixed text would not keep.
    pub waiting: usize,
}

/// A fix that was applied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Done {
    /// Where the problem was, in the text as it was then.
    pub place: LineColumn,
    /// What the fix does.
    pub title: String,
}

/// Fixes the errors of a file by safe fixes, or by unsafe ones, too; values are never made up.
/// Errors in arguments stay, and warnings are not touched: what they tell of may be meant.
pub fn fix_all(sources: &Sources, most: Applicability) -> Fixed {
    let most = most.min(Applicability::Unsafe);
    /// A fix can show what another mistake hid; so many in a row are more than any text has.
    const ROUNDS: usize = 1000;
    /// Maximum number of bytes that are read for it: of long texts with more mistakes than a
    /// reading tells, some are left.
    const READ: usize = 1 << 25;
    let mut sources = sources.clone();
    let mut problems = read(&sources).diagnostics;
    let mut done = Vec::new();
    // Problems of this text that stay though their fixes are typed in.
    let mut staying: HashSet<Problem> = HashSet::new();
    let mut seen = HashSet::new();
    // Bytes that are no text would be lost.
    let rounds = match sources.file.invalid_utf8().is_empty() {
        true => ROUNDS.min(READ / sources.file.text().len().max(1)).max(1),
        false => 0,
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
            // The same once more, without them.
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
        waiting: match is_finished {
            true => 0,
            false => left.iter().filter(|&&other| other <= most).count(),
        },
    }
}

/// A problem of a text, to be known again in a changed one.
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

/// The first fixes of all errors as one, but for those that would change what another one changes:
/// they wait for the next round.
struct Round {
    fix: Fix,
    /// The edits that make the text longer, and the problems that offer them: where all of these
    /// stay, they would do so without end.
    lengthened: HashMap<Vec<Edit>, Vec<Problem>>,
    done: Vec<Done>,
    /// How much longer the text becomes at each place where it is changed.
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
        // The ends of the places that are changed, by their starts. No two of them touch.
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

    /// A problem as it is in the changed text, if it is still there.
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

/// How much longer the text becomes by an edit.
fn growth(edit: &Edit) -> isize {
    edit.text.len() as isize - (edit.span.end - edit.span.start) as isize
}
