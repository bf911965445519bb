//! Reads a scene: parses the text and converts its tree. A large file is read in parts if it has no
//! mistakes, and otherwise as a whole.

use std::sync::atomic::AtomicBool;

use super::lowering::Lowering;
use crate::{
    cancel::{self, Cancelled},
    diagnostic::{self, Diagnostic},
    scene::{
        eval::Names,
        model::Reading,
        overrides,
        semantic_model::{Parts, SemanticModel},
    },
    schema::{self, predefined},
    source::{SourceId, Sources, Span, sort_by_span},
    syntax::{
        self,
        tree::{self, Item, ValueKind},
    },
};

/// Number of bytes at the start of a file in which zero bytes are counted. Zero bytes show that the
/// file is binary rather than text. Binary files usually have zero bytes near their start. With a
/// larger number, a file whose first zero byte comes later would also be recognized, but the search
/// would take longer.
const BINARY_BYTES: usize = 1 << 14;

/// Reads a scene: parses the file and the `--set` arguments, and converts them to a scene.
pub fn read(sources: &Sources) -> Reading {
    read_in_parts(sources, PART_BYTES)
}

/// Reads a scene as [`read`] does, but stops soon after `cancel` is set.
///
/// # Errors
///
/// Returns [`Cancelled`] if `cancel` is set.
pub fn read_unless(sources: &Sources, cancel: &AtomicBool) -> Result<Reading, Cancelled> {
    let reading = read_as_far(sources, PART_BYTES, cancel);
    cancel::unless_set(cancel, reading)
}

/// Minimum size, in bytes, of the parts in which a file is read. Several threads parse the parts,
/// and a file that is too short for two parts is read as a whole. With a much smaller size,
/// starting the threads could take longer than they save. The tree of a larger part would need more
/// memory, and cancelling would take effect later.
const PART_BYTES: usize = 1 << 16;

/// Reads a scene as [`read`] does, in parts of at least `bytes` bytes. The parts are converted one
/// after the other, so that the tree of the whole file is never in memory.
///
/// The result does not depend on the size of the parts: a file with mistakes is read again as a
/// whole, because one report may refer to places in several parts.
pub fn read_in_parts(sources: &Sources, bytes: usize) -> Reading {
    read_as_far(sources, bytes, &cancel::NEVER)
}

/// Reads a scene in parts of at least `bytes` bytes. If `cancel` is set, the result is incomplete
/// and must be discarded.
fn read_as_far(sources: &Sources, bytes: usize, cancel: &AtomicBool) -> Reading {
    in_parts(sources, bytes, cancel).unwrap_or_else(|| {
        let parsed = syntax::parse_unless(&sources.file, SourceId::File, cancel);
        whole(sources, &parsed, cancel).reading()
    })
}

/// Reads a file in parts of at least `bytes` bytes. Returns `None` if it has problems.
fn in_parts<'s>(sources: &'s Sources, bytes: usize, cancel: &'s AtomicBool) -> Option<Reading> {
    let mut lowering = Lowering::new(sources, Names::default(), cancel);
    let mut overrides = overrides::read(sources, &mut lowering.problems);
    // The value of a `--set` argument may use all names of the file. Items with such a value are
    // therefore converted last.
    let mut last = Vec::new();
    let file = &sources.file;
    // Objects that depend on no other item are converted on the thread that parsed them.
    let prepare = |mut items: Vec<Item<'s>>| {
        let mut part = Lowering::new(sources, Names::default(), cancel);
        let alone: Vec<_> = items
            .extract_if(.., |item| part.stands_alone(item))
            .collect();
        part.items(&alone);
        (part, items)
    };
    let all = lowering.is_right()
        && syntax::parse_in_parts(
            file,
            SourceId::File,
            bytes,
            cancel,
            prepare,
            |(part, mut items)| {
                let is_new = lowering.add(part);
                overrides::apply(&mut overrides, &mut items);
                last.extend(items.extract_if(.., |item| overrides::is_set(item)));
                lowering.items(&items);
                is_new && lowering.is_right()
            },
        );
    if !all {
        return None;
    }
    lowering.problems = overrides::add(overrides, &mut last, sources, lowering.names.budget());
    lowering.items(&last);
    let objects = &mut lowering.objects;
    objects.sort_by_key(|object| object.span.start);
    lowering.is_right().then(|| lowering.reading())
}

/// Reads a scene as [`read`] does, and also returns its tree and those parts of the scene that have
/// no errors.
pub fn analyze(sources: &Sources) -> SemanticModel<'_> {
    let parsed = syntax::parse(&sources.file, SourceId::File);
    let (parts, diagnostics, names) = whole(sources, &parsed, &cancel::NEVER).finish();
    SemanticModel {
        sources,
        parsed,
        diagnostics,
        parts,
        names,
    }
}

/// Converts the syntax tree of a whole file to a scene.
fn whole<'s>(
    sources: &'s Sources,
    parsed: &syntax::Parsed<'s>,
    cancel: &'s AtomicBool,
) -> Lowering<'s> {
    let mut lowering = Lowering::new(sources, Names::of(&parsed.tree), cancel);
    let wanted = parsed.problems.iter().take_while(|_| lowering.is_wanted());
    lowering.found = wanted.cloned().collect();
    lowering.cut = parsed.is_cut;
    if sources.sets.is_empty() {
        lowering.items(&parsed.tree.items);
        return lowering;
    }
    let mut items = parsed.tree.items.clone();
    let mut overrides = overrides::read(sources, &mut lowering.found);
    overrides::apply(&mut overrides, &mut items);
    lowering.problems = overrides::add(overrides, &mut items, sources, lowering.names.budget());
    // The value of a `--set` argument may use all names of the file. All definitions are therefore
    // converted before the blocks.
    let is_definition = |item: &Item<'_>| matches!(item, Item::Definition(_));
    let (definitions, others): (Vec<_>, Vec<_>) = items.into_iter().partition(is_definition);
    lowering.items(&definitions);
    lowering.items(&others);
    lowering
}

impl<'s> Lowering<'s> {
    /// Returns the scene, if it has no errors, and the problems.
    fn reading(self) -> Reading {
        let (parts, diagnostics, _) = self.finish();
        let failed = diagnostics.iter().any(Diagnostic::is_error);
        Reading {
            scene: parts.into_scene().filter(|_| !failed),
            diagnostics,
        }
    }

    /// Returns whether an item is an object that does not depend on other items or `--set`
    /// arguments: it uses no defined name, and no argument changes it.
    fn stands_alone(&self, item: &Item<'s>) -> bool {
        let Item::Block(block) = item else {
            return false;
        };
        let row = block.kind.and_then(|kind| schema::block(kind.text));
        row.is_some_and(|row| row.is_object)
            && block.repetition.is_none()
            && (block.name.is_none() || self.sources.sets.is_empty())
            && !block.fields.iter().any(|field| has_names(&field.value))
    }

    /// Adds the objects of a part of the file that was converted on another thread. Returns `false`
    /// if the part has problems, or an object with the name of an earlier one.
    fn add(&mut self, mut part: Self) -> bool {
        self.has_items |= part.has_items;
        self.has_objects |= part.has_objects;
        self.objects.append(&mut part.objects);
        self.boards.append(&mut part.boards);
        let is_right = part.is_right();
        let mut names = part.first_names.into_iter();
        is_right && names.all(|(name, place)| self.first_names.insert(name, place).is_none())
    }

    /// Returns whether there are no problems so far.
    fn is_right(&self) -> bool {
        self.problems.is_empty() && self.names.problems.borrow().is_empty()
    }

    /// Returns the parts of the scene that have no errors, all problems, and the defined names.
    fn finish(mut self) -> (Parts, Vec<Diagnostic>, Names<'s>) {
        let parts = self.build();
        let mut diagnostics = std::mem::take(&mut self.found);
        // Syntax problems within the value of an unknown field are dropped.
        diagnostics.retain(|diagnostic| !starts_in(diagnostic, &self.unknown));
        let mut of_names = Vec::from(self.names.problems.take());
        // A fix for an undefined name contains an edit for each use of the name. The uses were not
        // always found in the order of the text, so the edits are sorted.
        for fix in of_names.iter_mut().flat_map(|problem| &mut problem.fixes) {
            sort_by_span(&mut fix.edits, |edit| edit.span);
        }
        let found = Vec::from(std::mem::take(&mut self.problems)).into_iter();
        diagnostics.extend(found.chain(of_names).take_while(|_| self.is_wanted()));
        invalid_utf8(self.sources, &mut diagnostics);
        let fixes = diagnostics
            .iter_mut()
            .flat_map(|problem| &mut problem.fixes);
        fixes.for_each(|fix| fix.make_careful(self.sources));
        // A `--set` argument may be used in several places. If its angle lacks a unit, this is
        // reported only once.
        let mut in_sets: Vec<Span> = Vec::new();
        let is_reported_once = |it: &Diagnostic| it.is("bare_angle");
        diagnostics.retain(|it| match it.labels.first().map(|label| label.span) {
            Some(span) if span.source != SourceId::File && is_reported_once(it) => {
                let is_new = !in_sets.contains(&span);
                in_sets.push(span);
                is_new
            }
            _ => true,
        });
        diagnostic::sort(&mut diagnostics);
        (parts, diagnostics, self.names)
    }
}

/// Returns whether a value uses names that are not predefined.
fn has_names(value: &tree::Value<'_>) -> bool {
    match &value.kind {
        ValueKind::Name(name) => predefined(name).is_none(),
        ValueKind::Number(_) => false,
        _ => value.parts().into_iter().any(has_names),
    }
}

/// Returns whether the first label of a problem starts in one of `places`, which must be in the
/// order of the text.
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

/// Reports bytes that are not UTF-8, and drops other problems with labels that contain such bytes.
/// A UTF-16 or binary file is reported as such, and all its other problems are dropped.
fn invalid_utf8(sources: &Sources, diagnostics: &mut Vec<Diagnostic>) {
    let invalid = sources.file.invalid_utf8();
    if sources.file.is_utf16() {
        diagnostics.clear();
        let first = Span::new(SourceId::File, 0, 2);
        diagnostics.push(syntax::UTF16.at(first, &[], None));
        return;
    }
    // A text has no zero bytes, except perhaps one or two by mistake. A file with more of them is
    // taken for a binary file.
    let mut start = sources.file.text().as_bytes();
    start = start.get(..BINARY_BYTES).unwrap_or(start);
    if start.contains(&0) && start.iter().filter(|&&byte| byte == 0).count() > 2 {
        diagnostics.clear();
        let first = Span::new(SourceId::File, 0, sources.file.floor_char_boundary(4));
        diagnostics.push(syntax::FOREIGN_FILE.at(first, &["a binary file", ""], None));
        return;
    }
    let Some(&first) = invalid.first() else {
        return;
    };
    let holds = |span: Span| {
        let next = invalid.partition_point(|&byte| byte < span.start);
        span.source == SourceId::File && invalid.get(next).is_some_and(|&byte| byte < span.end)
    };
    diagnostics.retain(|diagnostic| !diagnostic.labels.iter().any(|label| holds(label.span)));
    let span = Span::new(SourceId::File, first, first + 1);
    let times = syntax::further_places(invalid.len() - 1);
    diagnostics.push(syntax::INVALID_UTF8.at(span, &[&times], None));
}
