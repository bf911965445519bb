//! Tree → scene.
//!
//! In: the tree of a file and the overrides. Out: the scene, or what is wrong with it. The items are walked once, in order:
//! every name is defined and every field evaluated where it stands; then the overrides of fields are evaluated, which see
//! all names; then each block is built. A problem of one field never hides one of another.

mod build;
mod consequences;
mod definitions;
mod fixing;
mod overriding;
mod reading;
mod words;

pub use reading::{read, read_in_parts, survey};

use std::collections::{HashMap, hash_map::Entry};

use glam::DVec3;

use self::words::{missing_value, of_right_type, range_words, shown, type_help, unknown_field};
use super::{
    Object,
    error::Problem,
    eval::{Evaluator, Names, predefined},
    overrides::Override,
    schema::{self, Condition, Field, Kind, Type},
    untangle::untangle,
    value::Value,
};
use crate::{
    diagnostic::Diagnostic,
    math::{Angle, compare_half_turns},
    source::{SourceId, Sources, Span},
    suggest,
    syntax::{
        self, shorten,
        tree::{self, Definition, Item, Name, ValueKind},
    },
};

struct Lowering<'s> {
    sources: &'s Sources,
    /// Whether an unclosed comment took the end of the text.
    cut: bool,
    names: Names<'s>,
    overrides: Vec<Override<'s>>,
    /// Whether one of them sets a `let`, or a field of an object.
    sets_by_name: bool,
    /// The overrides by the block and the field or `let` that they set.
    targets: HashMap<(Option<&'s str>, &'s str), usize>,
    /// The blocks that are not built yet: those that are no objects, and objects if an argument may set a field of one.
    blocks: Vec<Block<'s>>,
    /// The blocks by the names that `--set` knows them by; of several of one name the first.
    first_blocks: HashMap<&'s str, usize>,
    /// The objects that are built.
    objects: Vec<Object>,
    /// Whether there is an object, built or not.
    has_objects: bool,
    /// The names whose definitions give no value, since the language has these names already.
    denied: Vec<Name<'s>>,
    /// Where each object's name stands first.
    first_names: HashMap<&'s str, Span>,
    /// The texts of items that could not be understood.
    bad: Vec<&'s str>,
    /// What is wrong with the syntax.
    found: Vec<Diagnostic>,
    problems: Vec<Problem>,
    /// Problems of syntax that show only when the names are known.
    slips: Vec<syntax::Problem>,
    /// The values of unknown fields, in the order of the text.
    unknown: Vec<Span>,
    /// Whether the last block was only begun.
    in_begun_blocks: bool,
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
}

impl<'s> Lowering<'s> {
    fn new(sources: &'s Sources, overrides: Vec<Override<'s>>, names: Names<'s>) -> Self {
        Self {
            sources,
            cut: false,
            names,
            sets_by_name: overrides.iter().any(overriding::is_by_name),
            overrides,
            targets: HashMap::new(),
            blocks: Vec::new(),
            first_blocks: HashMap::new(),
            objects: Vec::new(),
            has_objects: false,
            denied: Vec::new(),
            first_names: HashMap::new(),
            bad: Vec::new(),
            found: Vec::new(),
            problems: Vec::new(),
            slips: Vec::new(),
            unknown: Vec::new(),
            in_begun_blocks: false,
        }
    }

    /// Makes sense of the next items of the file.
    fn items(&mut self, items: &[Item<'s>]) {
        for item in items {
            match item {
                Item::Definition(definition) => self.definition(definition),
                Item::Block(block) => self.block(block),
                Item::Bad(span) => self.bad.push(self.sources.text(*span)),
            }
        }
    }

    fn definition(&mut self, definition: &Definition<'s>) {
        let set = definition.name.and_then(|name| {
            let index = *self.targets.get(&(None, name.text))?;
            self.overrides.get(index).cloned()
        });
        let first = definition
            .name
            .is_some_and(|name| self.names.place_of_whole(name.text).is_none());
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
        if predefined(name.text).is_some() {
            self.denied.push(name);
        }
        if reported && (predefined(name.text).is_some() || self.names.place(name.text).is_some()) {
            return;
        }
        if let Some(what) = predefined(name.text) {
            // Its other uses tell whether it can be renamed.
            self.names.ask_for_all();
            self.problems.push(Problem::PredefinedName {
                name: name.text.to_owned(),
                what,
                span: name.span,
                found: value.map(|value| value.kind()),
                fixes: Vec::new(),
            });
        } else if definition.is_part_of_name() {
            self.names.guess(name);
        } else if let Some(first) = self.names.place_of_whole(name.text) {
            self.problems.push(Problem::DuplicateLet {
                name: name.text.to_owned(),
                second: name.span,
                first,
                definition: definition.span,
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
        let earlier = match row.is_object {
            true => None,
            false => self.first_blocks.get(row.name),
        };
        let earlier = earlier.and_then(|&index| self.blocks.get(index));
        let duplicate = earlier.is_some();
        if let Some(earlier) = earlier {
            self.problems.push(Problem::DuplicateBlock {
                name: row.name,
                second: block.keyword(),
                first: earlier.keyword,
                blocks: [earlier.span, block.span],
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
        // Of blocks that are only begun, one after the other, the first is enough; so says the parser, too.
        let begun = block.close.is_none() && block.fields.is_empty();
        let again = self.in_begun_blocks && begun;
        self.in_begun_blocks = begun;
        if again || (begun && near.is_none()) {
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
            near: near.map(|near| near.name.to_owned()),
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
        let value = self.typed(row, &field.value);
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
                fields: [first.field(), given.field()],
            }),
            Some(free) => *free = Some(given),
            None => {}
        }
    }

    fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        self.evaluate_loosely(&field.value);
        if field.value.span.source == SourceId::File {
            self.unknown.push(field.value.span);
        }
        let near = block.row.nearest_field(field.name.text);
        let joined = block.row.joined_field(field.name.text);
        block.meant.extend(near.or(joined));
        self.problems
            .push(unknown_field(block.row, &field.name, &field.value));
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
                    fixes: self.one_of(block, [other, row]),
                });
            }
        }
    }

    /// The value of a field, if it is of the field's type and keeps its conditions.
    fn typed(&mut self, row: &'static Field, tree: &tree::Value<'s>) -> Option<Value> {
        let before = self.problems.len();
        let value = match row.takes {
            Type::Method => return self.method(row, tree),
            takes => self.evaluate(tree, Some(takes))?,
        };
        if value.kind() != row.takes {
            self.wrong_type(row, tree, value);
            return None;
        }
        let broken = row.must.iter().find(|condition| !holds(**condition, value));
        if let Some(&condition) = broken {
            let rounded_to_zero = matches!(
                (&tree.kind, self.problems.last()),
                (ValueKind::Number(_), Some(Problem::NumberUnderflow { .. }))
            ) && self.problems.len() > before;
            if rounded_to_zero {
                self.problems.truncate(before);
            }
            let found = match (&tree.kind, value) {
                (ValueKind::Name(_) | ValueKind::Call(_) | ValueKind::Chain { .. }, value) => {
                    shown(value, condition)
                }
                _ if rounded_to_zero => {
                    format!(
                        "{}, which rounds to 0",
                        shorten(self.sources.text(tree.span))
                    )
                }
                _ => shorten(self.sources.text(tree.span)),
            };
            self.out_of_range(row, condition, tree, value, &found);
            return None;
        }
        Some(value)
    }

    fn method(&mut self, row: &'static Field, tree: &tree::Value<'s>) -> Option<Value> {
        let list = suggest::list(schema::method_names());
        let ValueKind::Name(written) = tree.kind else {
            if !matches!(tree.kind, ValueKind::Bad | ValueKind::Missing) {
                let found = self.evaluate(tree, None)?.kind();
                let problem = Problem::WrongType {
                    name: row.name.to_owned(),
                    takes: row.takes.noun(),
                    written: self.evaluator().quoted(tree.span),
                    found: found.noun().to_owned(),
                    help: format!("the methods are {list}"),
                    span: tree.span,
                    label: found.noun().to_owned(),
                    instead: Vec::new(),
                };
                self.problems.push(problem);
            }
            return None;
        };
        if let Some(method) = schema::method(written) {
            return Some(Value::Method(method));
        }
        let near = suggest::nearest(written, schema::method_names());
        let help = match near {
            Some(near) => format!("did you mean `{near}`? The methods are {list}."),
            None => format!("the methods are {list}"),
        };
        self.problems.push(Problem::UnknownMethod {
            written: written.to_owned(),
            help,
            span: tree.span,
            near: near.map(str::to_owned),
        });
        None
    }

    fn wrong_type(&mut self, row: &Field, tree: &tree::Value<'s>, value: Value) {
        let evaluator = self.evaluator();
        let label = evaluator.described(tree, value.kind());
        let written = evaluator.quoted(tree.span);
        let whole = evaluator.sources.text(tree.span);
        let text = shorten(whole);
        let problem = if let (Type::Angle, Value::Number(number)) = (row.takes, value) {
            let [degrees, radians] = evaluator.with_units(tree);
            // A unit that cannot be meant is not offered: `fov 45rad` would be the next mistake.
            let angles = [Angle::from_degrees(number), Angle::from_radians(number)];
            let fits = angles.map(|angle| {
                let mut must = row.must.iter();
                must.all(|condition| holds(*condition, Value::Angle(angle)))
            });
            let instead = evaluator.as_angle(tree).into_iter().zip(fits);
            Problem::BareAngle {
                what: format!("`{}`", row.name),
                written,
                help: match fits {
                    [true, false] => format!("write `{degrees}`"),
                    [false, true] => format!("write `{radians}`"),
                    _ => format!("write `{degrees}` (or `{radians}`)"),
                },
                span: tree.span,
                label,
                instead: instead
                    .filter_map(|(text, fits)| fits.then_some(text))
                    .collect(),
            }
        } else {
            Problem::WrongType {
                name: row.name.to_owned(),
                takes: row.takes.noun(),
                written,
                found: value.kind().noun().to_owned(),
                help: type_help(row, tree, value.kind(), &text),
                span: tree.span,
                label,
                instead: of_right_type(row, tree, value.kind(), whole),
            }
        };
        self.problems.push(problem);
    }

    fn out_of_range(
        &mut self,
        row: &Field,
        condition: Condition,
        tree: &tree::Value<'s>,
        value: Value,
        found: &str,
    ) {
        let (label, help, instead) = range_words(row, condition, value);
        let message = match condition {
            Condition::NotZero => format!("`{}` must not be zero", row.name),
            _ => format!("`{}` must be {condition}, and it is {found}", row.name),
        };
        let (span, label) = match part_not_above_zero(condition, tree, value) {
            Some(part) => (part, "not above 0"),
            None => (tree.span, label),
        };
        self.problems.push(Problem::OutOfRange {
            message,
            help,
            span,
            label: label.to_owned(),
            whole: tree.span,
            instead,
        });
    }

    fn evaluate(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        self.evaluator().value(value, wanted)
    }

    /// Looks for mistakes in the value of something unknown.
    fn evaluate_loosely(&mut self, value: &tree::Value<'s>) {
        if !matches!(value.kind, ValueKind::Name(_)) {
            let before = self.problems.len();
            self.evaluate(value, None);
            // What type was meant is not known; only a name is wrong in any.
            let found = self.problems.split_off(before);
            self.problems
                .extend(found.into_iter().filter(Problem::is_of_name));
        }
    }

    fn evaluator(&mut self) -> Evaluator<'_, 's> {
        Evaluator {
            sources: self.sources,
            names: &self.names,
            problems: &mut self.problems,
        }
    }

    fn name_of_object(&mut self, block: &Block<'s>) {
        let Some(name) = block.name else { return };
        let reserved = schema::block(name.text).is_some_and(|row| !row.is_object);
        if reserved {
            self.problems.push(Problem::ReservedName {
                name: name.text.to_owned(),
                span: name.span,
            });
            return;
        }
        match self.first_names.entry(name.text) {
            Entry::Occupied(first) => self.problems.push(Problem::DuplicateName {
                name: name.text.to_owned(),
                second: name.span,
                first: *first.get(),
            }),
            Entry::Vacant(free) => {
                free.insert(name.span);
            }
        }
    }
}

impl Given {
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

/// The first part of a written vector that is not above 0, if all were to be.
fn part_not_above_zero(condition: Condition, tree: &tree::Value<'_>, value: Value) -> Option<Span> {
    let (Condition::EachMoreThanZero, ValueKind::Tuple(parts), Value::Vector(v)) =
        (condition, &tree.kind, value)
    else {
        return None;
    };
    let mut parts = parts.iter().zip(v.to_array());
    parts.find_map(|(part, x)| (x <= 0.0).then_some(part.value.span))
}

/// Whether a word stands in a text.
fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
}

/// Whether a value keeps a condition; one of another type has no say in it.
fn holds(condition: Condition, value: Value) -> bool {
    let two_to = |power: u32| (1_u64 << power) as f64;
    match (condition, value) {
        (Condition::Whole, Value::Number(x)) => x.fract() == 0.0,
        (Condition::MoreThan(bound), Value::Number(x)) => x > bound,
        (Condition::AtLeast(bound), Value::Number(x)) => x >= bound,
        (Condition::AtMostTwoTo(power), Value::Number(x)) => x <= two_to(power),
        (Condition::LessThanTwoTo(power), Value::Number(x)) => x < two_to(power),
        (Condition::LessThanHalfTurn, Value::Angle(angle)) => {
            compare_half_turns(angle, 0.0).is_gt() && compare_half_turns(angle, 1.0).is_lt()
        }
        (Condition::NotZero, Value::Vector(v)) => v != DVec3::ZERO,
        (Condition::EachMoreThanZero, Value::Vector(v)) => v.min_element() > 0.0,
        _ => true,
    }
}
