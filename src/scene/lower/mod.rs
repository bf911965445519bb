//! Tree → scene.
//!
//! In: the tree of a file and the overrides. Out: the scene, or what is wrong with it. The items are walked once, in order:
//! every name is defined and every field evaluated where it stands; then the overrides of fields are evaluated, which see
//! all names; then each block is built (an object at once, where no override goes by its name). A problem of one field never hides one of another.

mod build;
mod camera;
mod cuboid;
mod field_fixes;
mod field_value;
mod fields;
mod missing;
mod overriding;
mod read;
mod sampler;
mod triangle;
mod unknown;

pub use read::{analyze, read, read_in_parts, read_unless};

use std::{collections::HashMap, sync::atomic::AtomicBool};

use super::{
    Object,
    error::{error, twice},
    eval::Names,
    fix,
    overrides::Override,
    predefined, schema,
    value::Value,
};
use crate::{
    cancel,
    diagnostic::{Diagnostic, Edit, Fix},
    source::{Sources, Span},
    suggest,
    syntax::tree::{self, Definition, Item, Name, ValueKind},
};

struct Lowering<'s> {
    sources: &'s Sources,
    /// Once it is set, the rest is left out.
    cancel: &'s AtomicBool,
    /// Whether a mistake took the end of the text, such as a comment that is never closed.
    cut: bool,
    names: Names<'s>,
    overrides: Vec<Override<'s>>,
    /// Whether one of them sets a `let`, or a field of an object.
    sets_by_name: bool,
    /// The overrides by the block and the field or `let` that they set; of several the last one.
    targets: HashMap<(Option<&'s str>, &'s str), usize>,
    /// The blocks that are not built yet: those that are no objects, and objects if an argument may set a field of one.
    blocks: Vec<Block<'s>>,
    /// The blocks by the names that `--set` knows them by; of several of one name the first.
    first_blocks: HashMap<&'s str, usize>,
    /// The objects that are built.
    objects: Vec<Object>,
    /// Whether there is anything in the file but comments.
    has_items: bool,
    /// Whether there is an object, built or not.
    has_objects: bool,
    /// Where each object's name stands first.
    first_names: HashMap<&'s str, Span>,
    /// The texts of items that could not be understood.
    bad: Vec<&'s str>,
    /// What is wrong with the syntax.
    found: Vec<Diagnostic>,
    problems: Vec<Diagnostic>,
    /// The values of unknown fields, in the order of the text.
    unknown: Vec<Span>,
}

/// A block with what it was given.
struct Block<'s> {
    row: &'static schema::Block,
    keyword: Span,
    span: Span,
    name: Option<Name<'s>>,
    /// For each field of the row what it was given.
    given: Vec<Option<Given>>,
    /// Fields that were probably meant, by a mistyped name or in what was not understood.
    meant: Vec<&'static str>,
    /// Whether a field may have been lost.
    unfinished: bool,
}

#[derive(Clone, Copy)]
struct Given {
    /// The field's name.
    name: Span,
    /// The value's text.
    span: Span,
    /// None if it failed.
    value: Option<Value>,
    /// The parts, if it is written as a vector.
    parts: Option<[Span; 3]>,
}

impl<'s> Lowering<'s> {
    fn new(
        sources: &'s Sources,
        overrides: Vec<Override<'s>>,
        names: Names<'s>,
        cancel: &'s AtomicBool,
    ) -> Self {
        let targets = overrides.iter().enumerate();
        let targets = targets.map(|(index, set)| {
            let block = set.block.map(|block| block.text);
            ((block, set.name.text), index)
        });
        Self {
            sources,
            cancel,
            cut: false,
            names,
            sets_by_name: overrides.iter().any(overriding::is_by_name),
            targets: targets.collect(),
            overrides,
            blocks: Vec::new(),
            first_blocks: HashMap::new(),
            objects: Vec::new(),
            has_items: false,
            has_objects: false,
            first_names: HashMap::new(),
            bad: Vec::new(),
            found: Vec::new(),
            problems: Vec::new(),
            unknown: Vec::new(),
        }
    }

    /// Makes sense of the next items of the file.
    fn items(&mut self, items: &[Item<'s>]) {
        for item in items {
            if !self.is_wanted() {
                return;
            }
            self.has_items = true;
            match item {
                Item::Definition(definition) => self.definition(definition),
                Item::Block(block) => self.block(block),
                Item::Bad(span) => {
                    let text = self.sources.text(*span);
                    self.names.know_words(text);
                    self.bad.push(text);
                }
            }
        }
    }

    fn is_wanted(&self) -> bool {
        !cancel::is_set(self.cancel)
    }

    fn definition(&mut self, definition: &Definition<'s>) {
        let set = definition.name.and_then(|name| {
            let index = *self.targets.get(&(None, name.text))?;
            self.overrides.get(index).cloned()
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
        // A name without its `let` was reported.
        let reported = definition.keyword.range().is_empty();
        if let Some(what) = predefined(name.text) {
            if !reported {
                let message = format!("`{}` is {what} already", name.text);
                let help = format!("choose another name, such as `my_{}`", name.text);
                self.problems.push(
                    error("predefined_name", message)
                        .at(name.span, "this name is taken")
                        .help(help),
                );
            }
            // What uses it below is silent: what it means there, nobody can tell.
            self.names.define(name, None, None);
        } else if reported && self.names.place(name.text).is_some() {
            // It stays what it is.
        } else if let Some(first) = self.names.place(name.text) {
            let message = format!("`{}` is defined twice", name.text);
            let title = format!("remove this `let {}`", name.text);
            let help = "remove one of them, or give it another name; a name keeps its value";
            self.problems.push(
                twice("duplicate_let", message, [first, name.span])
                    .help(help)
                    .fixes([Fix::remove_whole(title, [definition.span], self.sources)]),
            );
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
            let help = format!(
                "take `{}` away; only objects have names, for a scene has one `{}`",
                name.text, row.name
            );
            self.problems.push(
                error("unexpected_name", format!("{} takes no name", row.noun))
                    .at(name.span, "not here")
                    .help(help)
                    .fixes([self.without_name(&name)]),
            );
        }
        let earlier = match row.is_object {
            true => None,
            false => self.first_blocks.get(row.name),
        };
        let earlier = earlier.and_then(|&index| self.blocks.get(index));
        let duplicate = earlier.is_some();
        if let Some(earlier) = earlier {
            let spans = [earlier.span, block.span];
            let message = format!("there are two `{}` blocks", row.name);
            self.problems.push(
                twice(
                    "duplicate_block",
                    message,
                    [earlier.keyword, block.keyword()],
                )
                .help("keep one, with the fields of both")
                .fixes(fix::one_of_two(row.name, spans, self.sources)),
            );
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
        let is_known = |field: &&tree::Field<'s>| row.field(field.name.text).is_some();
        for field in block.fields.iter().filter(is_known) {
            self.field(field, &mut lowered, &replaced);
        }
        // What else there is tells what they can have meant.
        for field in block.fields.iter().filter(|field| !is_known(field)) {
            self.unknown_field(field, &mut lowered);
        }
        self.conflicts(&lowered, &replaced);
        if row.is_object {
            self.name_of_object(&lowered);
        }
        if !duplicate {
            self.push(lowered);
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
        // Of a block that is only begun, the parser says all.
        if near.is_none() && block.close.is_none() && block.fields.is_empty() {
            return None;
        }
        let kinds = suggest::list(schema::block_names());
        let help = match near {
            Some(near) => format!("did you mean `{}`? The kinds are {kinds}.", near.name),
            None => format!("the kinds are {kinds}"),
        };
        let message = format!("there is no kind of block `{}`", kind.text);
        self.problems.push(
            error("unknown_kind", message)
                .at(kind.span, "not a kind of block")
                .help(help)
                .writing(kind.span, near.map(|near| near.name)),
        );
        near
    }

    fn field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>, replaced: &[&str]) {
        let written = field.name.text;
        let index = block.row.fields.iter().position(|row| row.name == written);
        let row = index.and_then(|index| block.row.fields.get(index));
        let (Some(index), Some(row)) = (index, row) else {
            return;
        };
        if matches!(field.value.kind, ValueKind::Missing) {
            self.missing_value(&field.name, row);
        }
        if replaced.contains(&row.name) {
            return;
        }
        let value = self.typed(row, &field.value);
        let given = Given::new(field.name.span, &field.value, value);
        match block.given.get_mut(index) {
            Some(Some(first)) => {
                let spans = [first.field(), given.field()];
                let message = format!("`{}` is given twice", row.name);
                self.problems.push(
                    twice("duplicate_field", message, [first.name, field.name.span])
                        .help("remove one of them")
                        .fixes(fix::one_of_two(row.name, spans, self.sources)),
                );
            }
            Some(free) => *free = Some(given),
            None => {}
        }
    }

    /// Two fields that exclude each other: the later one is labelled first.
    fn conflicts(&mut self, block: &Block<'s>, replaced: &[&str]) {
        // One report for each choice: for a box with center, size, min and max.
        for choice in block.row.choices {
            let fields = choice.ways.iter().flat_map(|way| way.iter().copied());
            let given =
                fields.filter_map(|name| Some((block.row.field(name)?, block.given(name)?)));
            let mut given: Vec<_> = given.collect();
            given.sort_by_key(|(_, given)| given.name.start);
            let [(first, earlier), ..] = given[..] else {
                continue;
            };
            let excluded: Vec<&str> = block.row.excludes(first.name).collect();
            let later = given.iter().find(|(row, _)| excluded.contains(&row.name));
            let Some(&(second, later)) = later.filter(|(row, _)| !replaced.contains(&row.name))
            else {
                continue;
            };
            let message = format!("`{}` and `{}` exclude each other", second.name, first.name);
            self.problems.push(
                error("conflicting_fields", message)
                    .at(later.name, "this says it again, in another way")
                    .at(earlier.name, "this says it already")
                    .help(format!("remove one of them: {}", choice.why))
                    .fixes(self.one_of(block, choice, [first.name, second.name])),
            );
        }
    }

    /// A field without a value.
    fn missing_value(&mut self, name: &Name<'s>, row: &schema::Field) {
        let example = row.example();
        let edit = Edit::new(fix::behind(name.span, self.sources), format!(" {example}"));
        let fix = Fix::new(format!("write `{} {example}`", name.text), [edit]);
        let (noun, field) = (row.takes.noun(), row.name);
        self.problems.push(Diagnostic {
            // Only reading the scene tells what a field without a value is called.
            is_of_syntax: true,
            ..error("missing_value", format!("`{}` has no value", name.text))
                .at(name.span, "a value should follow this")
                .help(format!(
                    "write {noun} after it, such as `{field} {example}`"
                ))
                .fixes([fix])
        });
    }

    /// Takes the name of a block away.
    fn without_name(&self, name: &Name<'s>) -> Fix {
        let title = format!("take the name `{}` away", name.text);
        Fix::remove(title, name.span, self.sources)
    }

    fn name_of_object(&mut self, block: &Block<'s>) {
        let Some(name) = block.name else { return };
        let text = name.text;
        let problem = if schema::block(text).is_some_and(|row| !row.is_object) {
            let help =
                format!("choose another name: `--set {text}.…` is to reach the block `{text}`");
            error("reserved_name", format!("no object can be named `{text}`"))
                .at(name.span, "this is the name of a block")
                .help(help)
        } else if let Some(&first) = self.first_names.get(text) {
            let message = format!("two objects are named `{text}`");
            twice("duplicate_name", message, [first, name.span])
                .help("give one of them another name")
        } else {
            self.first_names.insert(text, name.span);
            return;
        };
        let problem = problem.fixes([self.without_name(&name)]);
        self.problems.push(problem);
    }
}

impl Given {
    fn new(name: Span, tree: &tree::Value<'_>, value: Option<Value>) -> Self {
        let parts = match &tree.kind {
            ValueKind::Tuple(elements) => match elements.as_slice() {
                [x, y, z] => Some([x.value.span, y.value.span, z.value.span]),
                _ => None,
            },
            _ => None,
        };
        Self {
            name,
            span: tree.span,
            value,
            parts,
        }
    }

    /// Name and value; of an argument's, that is the value alone.
    fn field(self) -> Span {
        match self.name.source == self.span.source {
            true => self.name.to(self.span),
            false => self.span,
        }
    }
}

impl Block<'_> {
    fn given(&self, name: &str) -> Option<Given> {
        let index = self.row.fields.iter().position(|row| row.name == name)?;
        self.given.get(index).copied().flatten()
    }
}

/// Whether a word stands in a text.
fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}
