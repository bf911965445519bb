//! From the text to the tree, and on to the scene: in parts side by side where all is well, and as a whole.

use std::collections::HashMap;

use super::Lowering;
use crate::{
    diagnostic::{self, Diagnostic, Fix},
    scene::{
        Reading,
        eval::{Names, predefined},
        overrides::{self, Override},
        survey::{Parts, Survey},
    },
    source::{Source, SourceId, Sources, Span},
    syntax::{
        self,
        tree::{Item, Name},
    },
};

/// Reads a scene: parses the file and the overrides, and makes of them what they mean.
pub fn read(sources: &Sources) -> Reading {
    /// A part is long enough to be worth its hand-over, and so short that many are at work at once.
    const PART: usize = 1 << 16;
    read_in_parts(sources, PART)
}

/// The same with a file in parts of at least so many bytes, which are parsed side by side and made sense of one after the
/// other, so that there is never a tree of the whole. The result does not depend on the parts: a file with mistakes of
/// syntax, or with one whose report tells of the whole file, is read again as a whole.
pub fn read_in_parts(sources: &Sources, bytes: usize) -> Reading {
    let mut diagnostics = Vec::new();
    let overrides = overrides::read(sources, &mut diagnostics);
    let mut lowering = Lowering::new(sources, overrides.clone(), Names::default());
    if !lowering.sets_by_name {
        lowering.keep_last_overrides(&[]);
        let all = syntax::parse_in_parts(&sources.file, SourceId::File, bytes, |items| {
            lowering.items(&items);
            !lowering.names.were_asked_early()
        });
        lowering.override_blocks();
        if all && !lowering.names.were_asked_early() {
            lowering.found = diagnostics;
            return lowering.reading();
        }
    }
    let parsed = syntax::parse(&sources.file, SourceId::File);
    let mut reading = whole(sources, &parsed, overrides, diagnostics).reading();
    prove_fixes(sources, &mut reading.diagnostics);
    reading
}

/// Reads a scene as [`read`] does, and keeps what it was read from and what was understood in spite of errors.
pub fn survey(sources: &Sources) -> Survey<'_> {
    let mut diagnostics = Vec::new();
    let overrides = overrides::read(sources, &mut diagnostics);
    let parsed = syntax::parse(&sources.file, SourceId::File);
    let lowering = whole(sources, &parsed, overrides, diagnostics);
    let (parts, mut diagnostics, names) = lowering.finish();
    prove_fixes(sources, &mut diagnostics);
    Survey {
        sources,
        parsed,
        diagnostics,
        parts,
        names,
    }
}

/// Leaves of the fixes that may not help those that do: what they make of the text is read.
fn prove_fixes(sources: &Sources, diagnostics: &mut [Diagnostic]) {
    /// That takes time, which is not to be seen while the text is typed.
    const MOST: usize = 8;
    const LONGEST: usize = 1 << 16;
    let doubtful = |diagnostic: &Diagnostic| diagnostic.is_fix_doubtful;
    if !diagnostics.iter().any(doubtful) {
        return;
    }
    let before = counted(diagnostics);
    let is_short = sources.file.text().len() <= LONGEST;
    let mut proved = 0;
    for diagnostic in diagnostics.iter_mut().filter(|d| doubtful(d)) {
        proved += 1;
        let is_looked_at = is_short && proved <= MOST;
        let said = said(diagnostic);
        diagnostic.fixes.retain(|fix| {
            is_looked_at && {
                let after = counted(&diagnostics_with(sources, fix));
                // An unclosed comment may have taken the camera: that there is none was only hidden.
                let is_hidden = |said: &Said| said.0 == "pinhole::missing_camera";
                let is_new = |(said, count): (&Said, &usize)| {
                    !is_hidden(said) && before.get(said) < Some(count)
                };
                after.get(&said) < before.get(&said) && !after.iter().any(is_new)
            }
        });
    }
}

type Said = (String, String);

fn said(diagnostic: &Diagnostic) -> Said {
    (diagnostic.code.clone(), diagnostic.message.clone())
}

/// How often each thing is said.
fn counted(diagnostics: &[Diagnostic]) -> HashMap<Said, usize> {
    let mut counted = HashMap::new();
    for error in diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.is_error())
    {
        *counted.entry(said(error)).or_default() += 1;
    }
    counted
}

/// What is wrong with the texts that a fix leads to.
fn diagnostics_with(sources: &Sources, fix: &Fix) -> Vec<Diagnostic> {
    let file = diagnostic::apply(fix, SourceId::File, sources.file.text());
    let file = Source::from_text(sources.file.name(), file);
    let sets = (0_u32..).zip(&sources.sets);
    let sets = sets.map(|(index, set)| diagnostic::apply(fix, SourceId::Set(index), set.text()));
    let sources = Sources::new(file).with_sets(sets);
    let mut found = Vec::new();
    let overrides = overrides::read(&sources, &mut found);
    let parsed = syntax::parse(&sources.file, SourceId::File);
    let (_, diagnostics, _) = whole(&sources, &parsed, overrides, found).finish();
    diagnostics
}

/// Makes sense of the tree of a whole file; `diagnostics` are those of the overrides' syntax.
fn whole<'s>(
    sources: &'s Sources,
    parsed: &syntax::Parsed<'s>,
    overrides: Vec<Override<'s>>,
    mut diagnostics: Vec<Diagnostic>,
) -> Lowering<'s> {
    let problems = parsed.problems.iter();
    let mut found: Vec<_> = problems.map(|p| Diagnostic::fixable(p, sources)).collect();
    found.append(&mut diagnostics);
    let tree = &parsed.tree;
    let names = Names::new(definitions(tree), names_of_objects(tree));
    let mut lowering = Lowering::new(sources, overrides, names);
    lowering.found = found;
    lowering.cut = parsed.cut.is_some();
    lowering.keep_last_overrides(&tree.items);
    lowering.items(&tree.items);
    lowering.override_blocks();
    lowering.fix_definitions(parsed);
    lowering.leave_out_consequences(&tree.items);
    lowering
}

impl<'s> Lowering<'s> {
    /// Makes the scene of what was read.
    fn reading(self) -> Reading {
        let (parts, diagnostics, _) = self.finish();
        let failed = diagnostics.iter().any(Diagnostic::is_error);
        Reading {
            scene: parts.into_scene().filter(|_| !failed),
            diagnostics,
        }
    }

    /// What there is of a scene, errors or not, and the names that were defined.
    fn finish(mut self) -> (Parts, Vec<Diagnostic>, Names<'s>) {
        let parts = self.build();
        let mut diagnostics = std::mem::take(&mut self.found);
        // How a value is written does not matter where its field is unknown.
        diagnostics.retain(|diagnostic| !starts_in(diagnostic, &self.unknown));
        let problems = self.problems.iter();
        diagnostics.extend(problems.map(|p| Diagnostic::fixable(p, self.sources)));
        let slips = self.slips.iter();
        diagnostics.extend(slips.map(|p| Diagnostic::fixable(p, self.sources)));
        invalid_utf8(self.sources, &mut diagnostics);
        diagnostic::sort(&mut diagnostics);
        (parts, diagnostics, self.names)
    }
}

/// Whether a problem stands in one of some places, which are in the order of the text.
fn starts_in(diagnostic: &Diagnostic, places: &[Span]) -> bool {
    let Some(label) = diagnostic.labels.first() else {
        return false;
    };
    let next = places.partition_point(|place| place.end <= label.span.start);
    let place = places.get(next);
    label.span.source == SourceId::File
        && label.span.start < label.span.end
        && place.is_some_and(|place| place.start <= label.span.start)
}

/// The names that a file defines, those that it may define.
fn definitions<'t, 's>(tree: &'t syntax::Tree<'s>) -> impl Iterator<Item = Name<'s>> + 't {
    tree.items.iter().filter_map(|item| match item {
        Item::Definition(definition) => definition.name.filter(|n| predefined(n.text).is_none()),
        Item::Block(_) | Item::Bad(_) => None,
    })
}

/// The names of a file's objects.
fn names_of_objects<'t, 's>(tree: &'t syntax::Tree<'s>) -> impl Iterator<Item = &'s str> + 't {
    tree.items.iter().filter_map(|item| match item {
        Item::Block(block) => block.name.map(|name| name.text),
        Item::Definition(_) | Item::Bad(_) => None,
    })
}

/// Reports bytes that are not UTF-8, in place of what else was found wrong with the words that they are in.
fn invalid_utf8(sources: &Sources, diagnostics: &mut Vec<Diagnostic>) {
    let invalid = sources.file.invalid_utf8();
    let Some(&first) = invalid.first() else {
        return;
    };
    let holds = |span: Span| {
        let next = invalid.partition_point(|&byte| byte < span.start);
        span.source == SourceId::File && invalid.get(next).is_some_and(|&byte| byte < span.end)
    };
    let start = sources.file.text().as_bytes().get(2..4);
    if invalid.starts_with(&[0, 1]) && start.is_some_and(|start| start.contains(&0)) {
        let span = Span::new(SourceId::File, 0, 2);
        let problem = syntax::Problem::Utf16 { span };
        diagnostics.clear();
        diagnostics.push(Diagnostic::fixable(&problem, sources));
        return;
    }
    diagnostics.retain(|diagnostic| !diagnostic.labels.iter().any(|label| holds(label.span)));
    let problem = syntax::Problem::InvalidUtf8 {
        span: Span::new(SourceId::File, first, first + 1),
        more: invalid.len() - 1,
    };
    diagnostics.push(Diagnostic::fixable(&problem, sources));
}
