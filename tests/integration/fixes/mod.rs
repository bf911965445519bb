//! Tests of the fixes that diagnostics offer. Each fix must remove its problem and add no new
//! error.

mod answers;
mod delimiters;
mod lost_words;
mod mistyped;
mod names;
mod preservation;

use std::collections::BTreeMap;

use pinhole::{
    diagnostic::{Diagnostic, Fix, apply},
    scene,
    source::{Source, SourceId, Sources},
};

use crate::diagnostics::fixtures;

fn diagnostics(sources: &Sources) -> Vec<Diagnostic> {
    scene::read(sources).diagnostics
}

/// Returns the sources after `fix` is applied to the file and to the `--set` arguments.
fn with_fix(sources: &Sources, fix: &Fix) -> Sources {
    let sets = sources.sets();
    let sets = sets.map(|(id, set)| apply(fix, id, set.text()));
    let file = apply(fix, SourceId::File, sources.file.text());
    Sources::new(Source::from_text("a.scn", file)).with_sets(sets)
}

/// Counts diagnostics with equal code and message. Spaces in quoted texts are ignored.
fn counted<'d>(
    diagnostics: impl IntoIterator<Item = &'d Diagnostic>,
) -> BTreeMap<(&'d str, String), usize> {
    let mut counted = BTreeMap::new();
    for diagnostic in diagnostics {
        *counted.entry(said(diagnostic)).or_default() += 1;
    }
    counted
}

fn said(diagnostic: &Diagnostic) -> (&str, String) {
    (&diagnostic.code, diagnostic.message.replace(' ', ""))
}

/// Number of fixes that a test has applied, and complaints about their effects.
#[derive(Default)]
struct Trial {
    fixes: usize,
    complaints: Vec<String>,
}

impl Trial {
    /// Applies each fix of the problems that `is_meant` selects. Records a complaint if the problem
    /// remains, if a new error appears, or if the fix of an error does not reduce the number of
    /// errors.
    fn apply_fixes(
        &mut self,
        before_sources: &Sources,
        is_meant: impl Fn(&Diagnostic, &[Diagnostic]) -> bool,
    ) {
        let before = diagnostics(before_sources);
        let said_before = counted(&before);
        for diagnostic in before.iter().filter(|d| is_meant(d, &before)) {
            for fix in &diagnostic.fixes {
                self.fixes += 1;
                let after = diagnostics(&with_fix(before_sources, fix));
                let errors = |found: &[Diagnostic]| found.iter().filter(|d| d.is_error()).count();
                let are_fewer = errors(&after) < errors(&before);
                let mut complain = |what: &str, said: &(&str, String)| {
                    let text = before_sources.file.text();
                    let complaint = format!("`{}`: {what} {said:?}\n{text}", fix.title);
                    self.complaints.push(complaint);
                };
                let this = said(diagnostic);
                if counted(&after).get(&this) >= said_before.get(&this) {
                    complain("stays", &this);
                }
                if diagnostic.is_error() && !are_fewer {
                    complain("leaves as many errors", &this);
                }
                for (new, times) in counted(after.iter().filter(|d| d.is_error())) {
                    if Some(&times) > said_before.get(&new) {
                        complain("new", &new);
                    }
                }
            }
        }
    }

    #[track_caller]
    fn finish_with_more_than(self, fixes: usize) {
        assert!(self.complaints.is_empty(), "{}", self.complaints.join("\n"));
        assert!(self.fixes > fixes, "{} fixes", self.fixes);
    }
}

#[test]
fn fixes_of_every_fixture_remove_their_problem_and_add_no_error() {
    let mut trial = Trial::default();
    for (_, sources) in fixtures() {
        trial.apply_fixes(&sources, |_, _| true);
    }
    trial.finish_with_more_than(100);
}
