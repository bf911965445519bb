//! Tree → blocks with their values.
//!
//! In: the tree of a file and the overrides. Out: the scene, or what is wrong with it. The items are walked once, in order:
//! every name is defined and every field evaluated where it stands; then the overrides of fields are evaluated, which see
//! all names; then the scene is built. A problem of one field never hides one of another.

use std::collections::HashMap;

use super::{
    Reading, Scene,
    build::{self, Block, Given, Unread, mentions},
    error::Problem,
    eval::{Evaluator, Names, predefined},
    field::{self, example},
    overrides::{self, Override},
    schema::{self, Field, Kind, Type},
    untangle::untangle,
    value::Value,
};
use crate::{
    diagnostic::{self, Diagnostic},
    source::{SourceId, Sources, Span},
    suggest,
    syntax::{
        self,
        tree::{self, Definition, Item, Name, ValueKind},
    },
};

/// Reads a scene: parses the file and the overrides, and makes of them what they mean.
pub fn read(sources: &Sources) -> Reading {
    let parsed = syntax::parse(&sources.file, SourceId::File);
    let problems = parsed.problems.iter();
    let mut diagnostics: Vec<_> = problems.map(|p| Diagnostic::from_problem(p)).collect();
    let overrides = overrides::read(sources, &mut diagnostics);
    let mut lowering = Lowering {
        sources,
        cut: parsed.cut.is_some(),
        names: Names::new(definitions(&parsed.tree)),
        overrides,
        blocks: Vec::new(),
        problems: Vec::new(),
        slips: Vec::new(),
        in_begun_blocks: false,
    };
    let scene = lowering.scene(&parsed.tree);
    let problems = lowering.problems.iter();
    diagnostics.extend(problems.map(|p| Diagnostic::from_problem(p)));
    let slips = lowering.slips.iter();
    diagnostics.extend(slips.map(|p| Diagnostic::from_problem(p)));
    invalid_utf8(sources, &mut diagnostics);
    diagnostic::sort(&mut diagnostics);
    let failed = diagnostics.iter().any(Diagnostic::is_error);
    Reading {
        scene: scene.filter(|_| !failed),
        diagnostics,
    }
}

/// The names that a file defines, those that it may define.
fn definitions<'t, 's>(tree: &'t syntax::Tree<'s>) -> impl Iterator<Item = Name<'s>> + 't {
    tree.items.iter().filter_map(|item| match item {
        Item::Definition(definition) => definition.name.filter(|n| predefined(n.text).is_none()),
        Item::Block(_) | Item::Bad(_) => None,
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
    diagnostics.retain(|diagnostic| !diagnostic.labels.iter().any(|label| holds(label.span)));
    let problem = syntax::Problem::InvalidUtf8 {
        span: Span::new(SourceId::File, first, first + 1),
        more: invalid.len() - 1,
    };
    diagnostics.push(Diagnostic::from_problem(&problem));
}

struct Lowering<'s> {
    sources: &'s Sources,
    /// Whether an unclosed comment took the end of the text.
    cut: bool,
    names: Names<'s>,
    overrides: Vec<Override<'s>>,
    blocks: Vec<Block<'s>>,
    problems: Vec<Problem>,
    /// Problems of syntax that show only when the names are known.
    slips: Vec<syntax::Problem>,
    /// Whether the last block was only begun.
    in_begun_blocks: bool,
}

impl<'s> Lowering<'s> {
    fn scene(&mut self, tree: &syntax::Tree<'s>) -> Option<Scene> {
        self.keep_last_overrides();
        for item in &tree.items {
            match item {
                Item::Definition(definition) => self.definition(definition),
                Item::Block(block) => self.block(block),
                Item::Bad(_) => {}
            }
        }
        self.names_of_objects();
        self.override_fields();
        self.override_targets();
        let bad = tree.items.iter().filter_map(|item| match item {
            Item::Bad(span) => Some(self.sources.text(*span)),
            Item::Definition(_) | Item::Block(_) => None,
        });
        let unread = Unread {
            items: bad.collect(),
            cut: self.cut,
        };
        build::scene(&self.blocks, &unread, &mut self.problems)
    }

    fn definition(&mut self, definition: &Definition<'s>) {
        let set = definition.name.and_then(|name| {
            let is = |o: &&Override<'_>| o.block.is_none() && o.name.text == name.text;
            self.overrides.iter().find(is).cloned()
        });
        let first = definition
            .name
            .is_some_and(|name| self.names.place(name.text).is_none());
        let value = match &set {
            Some(set) if first => self.evaluate(&set.value, None),
            Some(_) => None,
            None => self.evaluate(&definition.value, None),
        };
        let Some(name) = definition.name else {
            return;
        };
        if let Some(what) = predefined(name.text) {
            self.problems.push(Problem::PredefinedName {
                name: name.text.to_owned(),
                what,
                span: name.span,
            });
        } else if let Some(first) = self.names.place(name.text) {
            self.problems.push(Problem::DuplicateLet {
                name: name.text.to_owned(),
                second: name.span,
                first,
            });
        } else {
            self.names.define(name, value, set.map(|set| set.id));
        }
    }

    fn block(&mut self, block: &tree::Block<'s>) {
        let Some(row) = self.row(block) else {
            for field in &block.fields {
                // A single name may be a word that only the unknown block knows.
                if !matches!(field.value.kind, ValueKind::Name(_)) {
                    self.evaluate(&field.value, None);
                }
            }
            return;
        };
        if let Some(name) = block.name
            && !row.is_object
            && block.bad.is_empty()
        {
            self.problems.push(Problem::UnexpectedName {
                noun: row.noun,
                kind: row.name,
                name: name.text.to_owned(),
                span: name.span,
            });
        }
        let same = |other: &&Block<'_>| other.row.kind == row.kind;
        let earlier = match row.is_object {
            true => None,
            false => self.blocks.iter().find(same),
        };
        let duplicate = earlier.is_some();
        if let Some(earlier) = earlier {
            self.problems.push(Problem::DuplicateBlock {
                name: row.name,
                second: block.keyword(),
                first: earlier.keyword,
            });
        }
        let mut lowered = Block {
            row,
            keyword: block.keyword(),
            span: block.span,
            name: block.name.filter(|_| row.is_object),
            given: vec![None; row.fields.len()],
            meant: Vec::new(),
            // The end is missing, or what stands before the `{` may have been a field.
            unfinished: block.close.is_none()
                || block
                    .bad
                    .iter()
                    .any(|bad| Some(bad.start) < block.open.map(|open| open.start)),
        };
        for span in &block.bad {
            let text = self.sources.text(*span);
            let mentioned = row.field_names().filter(|name| mentions(text, name));
            lowered.meant.extend(mentioned);
        }
        let replaced = self.replaced_fields(&lowered);
        for field in untangle(
            &block.fields,
            row,
            &self.names,
            self.sources,
            &mut self.slips,
        )
        .iter()
        {
            self.field(field, &mut lowered, &replaced);
        }
        self.conflicts(&lowered, &replaced);
        if !duplicate {
            self.blocks.push(lowered);
        }
    }

    /// The table's row for a block; for a mistyped kind that of the nearest one.
    fn row(&mut self, block: &tree::Block<'s>) -> Option<&'static schema::Block> {
        let kind = block.kind?;
        let row = schema::block(kind.text);
        if row.is_some() {
            return row;
        }
        let near = schema::nearest_block(kind.text);
        // Of blocks that are only begun, one after the other, the first is enough; so says the parser, too.
        let begun = block.close.is_none() && block.fields.is_empty();
        let again = self.in_begun_blocks && begun;
        self.in_begun_blocks = begun;
        if again {
            return near;
        }
        let kinds = suggest::list(schema::block_names());
        let help = match near {
            Some(near) => format!("did you mean `{}`? The kinds are {kinds}.", near.name),
            None => format!("the kinds are {kinds}"),
        };
        self.problems.push(Problem::UnknownKind {
            written: kind.text.to_owned(),
            help,
            span: kind.span,
        });
        near
    }

    fn field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>, replaced: &[&str]) {
        let written = field.name.text;
        let index = block.row.fields.iter().position(|row| row.name == written);
        let row = index.and_then(|index| block.row.fields.get(index));
        let (Some(index), Some(row)) = (index, row) else {
            self.unknown_field(field, block);
            return;
        };
        if matches!(field.value.kind, ValueKind::Missing) {
            self.problems.push(missing_value(&field.name, Some(row)));
        }
        if replaced.contains(&row.name) {
            return;
        }
        let value = field::value(&mut self.evaluator(), row, &field.value);
        let given = Given {
            name: field.name.span,
            span: field.value.span,
            value,
        };
        match block.given.get_mut(index) {
            Some(Some(first)) => self.problems.push(Problem::DuplicateField {
                name: row.name.to_owned(),
                second: field.name.span,
                first: first.name,
            }),
            Some(free) => *free = Some(given),
            None => {}
        }
    }

    fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        self.evaluate_loosely(&field.value);
        let near = block.row.nearest_field(field.name.text);
        let joined = block.row.joined_field(field.name.text);
        block.meant.extend(near.or(joined));
        self.problems.push(unknown_field(block.row, &field.name));
    }

    /// Two fields that exclude each other: the later one is labelled first.
    fn conflicts(&mut self, block: &Block<'s>, replaced: &[&str]) {
        let mut reported = Vec::new();
        for (row, given) in block.row.fields.iter().zip(&block.given) {
            let Some(given) = given else { continue };
            for (other, other_given) in block.row.fields.iter().zip(&block.given) {
                let excluded = row.excludes.contains(&other.name);
                let Some(earlier) = other_given.filter(|o| o.name.start < given.name.start) else {
                    continue;
                };
                // One report for a box with center, size, min and max.
                if !excluded || replaced.contains(&row.name) || !reported.is_empty() {
                    continue;
                }
                reported.push(row.name);
                let why = match block.row.kind {
                    Kind::Camera if row.takes == Type::Vector => {
                        "either a point or a direction says where the camera looks"
                    }
                    Kind::Camera => "either the distance or the angle says how much it sees",
                    Kind::Sampler => "either one says how many samples there are",
                    _ => "a box is given by center and size, or by min and max",
                };
                self.problems.push(Problem::ConflictingFields {
                    later: row.name.to_owned(),
                    earlier: other.name.to_owned(),
                    why: why.to_owned(),
                    second: given.name,
                    first: earlier.name,
                });
            }
        }
    }

    fn evaluate(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        self.evaluator().value(value, wanted)
    }

    /// Looks for mistakes in the value of something unknown.
    fn evaluate_loosely(&mut self, value: &tree::Value<'s>) {
        if !matches!(value.kind, ValueKind::Name(_)) {
            self.evaluate(value, None);
        }
    }

    fn evaluator(&mut self) -> Evaluator<'_, 's> {
        Evaluator {
            sources: self.sources,
            names: &self.names,
            problems: &mut self.problems,
        }
    }

    fn names_of_objects(&mut self) {
        let mut first: HashMap<&str, Span> = HashMap::new();
        for block in &self.blocks {
            let Some(name) = block.name else { continue };
            let reserved = schema::block(name.text).is_some_and(|row| !row.is_object);
            if reserved {
                self.problems.push(Problem::ReservedName {
                    name: name.text.to_owned(),
                    span: name.span,
                });
            } else if let Some(&first) = first.get(name.text) {
                self.problems.push(Problem::DuplicateName {
                    name: name.text.to_owned(),
                    second: name.span,
                    first,
                });
            } else {
                first.insert(name.text, name.span);
            }
        }
    }

    /// Of several overrides of one target, or of fields that exclude each other, only the last counts.
    fn keep_last_overrides(&mut self) {
        let all = std::mem::take(&mut self.overrides);
        let mut kept: Vec<Override<'s>> = Vec::new();
        for next in all {
            kept.retain(|earlier| {
                let same_block = match (&earlier.block, &next.block) {
                    (Some(a), Some(b)) => a.text == b.text,
                    (None, None) => true,
                    _ => false,
                };
                let same = earlier.name.text == next.name.text;
                let excluded = next.block.is_some()
                    && schema::BLOCKS
                        .iter()
                        .filter_map(|row| row.field(next.name.text))
                        .any(|row| row.excludes.contains(&earlier.name.text));
                !(same_block && (same || excluded))
            });
            kept.push(next);
        }
        self.overrides = kept;
    }

    /// The fields of a block that an override replaces, alternatives included.
    fn replaced_fields(&self, block: &Block<'s>) -> Vec<&'static str> {
        let mut replaced = Vec::new();
        for set in &self.overrides {
            if set
                .block
                .is_some_and(|target| is_target(block, target.text))
                && let Some(row) = block.row.field(set.name.text)
            {
                replaced.push(row.name);
                replaced.extend(row.excludes);
            }
        }
        replaced
    }

    /// Evaluates the overrides of fields, now that every name is defined.
    fn override_fields(&mut self) {
        for set in self.overrides.clone() {
            let Some(target) = set.block else { continue };
            let addable = schema::block(target.text).filter(|row| !row.is_object);
            let mut index = self.blocks.iter().position(|b| is_target(b, target.text));
            if index.is_none()
                && let Some(row) = addable
            {
                index = Some(self.blocks.len());
                self.blocks.push(Block {
                    row,
                    keyword: target.span,
                    span: target.span,
                    name: None,
                    given: vec![None; row.fields.len()],
                    meant: Vec::new(),
                    unfinished: false,
                });
            }
            let Some(row) = index.and_then(|i| self.blocks.get(i)).map(|b| b.row) else {
                continue;
            };
            let at = row
                .fields
                .iter()
                .position(|field| field.name == set.name.text);
            let Some((at, field)) = at.and_then(|at| Some((at, row.fields.get(at)?))) else {
                self.problems.push(unknown_field(row, &set.name));
                continue;
            };
            let value = field::value(&mut self.evaluator(), field, &set.value);
            let given = Given {
                name: set.name.span,
                span: set.value.span,
                value,
            };
            let block = index.and_then(|index| self.blocks.get_mut(index));
            if let Some(slot) = block.and_then(|block| block.given.get_mut(at)) {
                *slot = Some(given);
            }
        }
    }

    /// Reports overrides whose target does not exist.
    fn override_targets(&mut self) {
        if self.overrides.is_empty() {
            return;
        }
        let objects: Vec<&str> = self
            .blocks
            .iter()
            .filter_map(|b| Some(b.name?.text))
            .collect();
        let mut lets: Vec<&str> = self.names.all().collect();
        lets.sort_unstable();
        for set in &self.overrides {
            let problem = match &set.block {
                Some(block) => {
                    let found = self.blocks.iter().any(|b| is_target(b, block.text));
                    (!found).then(|| overrides::no_such_block(block, &objects))
                }
                None => {
                    let found = self.names.knows(set.name.text);
                    (!found).then(|| overrides::no_such_let(&set.name, &lets, &objects))
                }
            };
            self.problems.extend(problem);
        }
    }
}

fn is_target(block: &Block<'_>, target: &str) -> bool {
    match block.name {
        _ if !block.row.is_object => block.row.name == target,
        Some(name) => name.text == target,
        None => false,
    }
}

fn missing_value(name: &Name<'_>, row: Option<&Field>) -> Problem {
    let help = match row {
        Some(row) => format!(
            "write {} after it, such as `{} {}`",
            row.takes.noun(),
            row.name,
            example(row)
        ),
        None => "write a value after it".to_owned(),
    };
    Problem::MissingValue {
        name: name.text.to_owned(),
        help,
        span: name.span,
    }
}

fn unknown_field(row: &'static schema::Block, name: &Name<'_>) -> Problem {
    let mut fields: Vec<&str> = row.field_names().collect();
    let noun = capital(row.noun);
    let all = suggest::list(fields.drain(..));
    let help = match (row.nearest_field(name.text), row.joined_field(name.text)) {
        (Some(near), _) => format!("did you mean `{near}`? {noun} takes {all}."),
        (None, Some(joined)) => {
            let rest = name.text.get(joined.len()..).unwrap_or_default();
            format!("did you mean `{joined} {rest}`? {noun} takes {all}.")
        }
        (None, None) => format!("{} takes {all}", row.noun),
    };
    Problem::UnknownField {
        noun: row.noun,
        written: name.text.to_owned(),
        help,
        span: name.span,
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_ascii_uppercase());
    first.into_iter().chain(letters).collect()
}
