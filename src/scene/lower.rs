//! Tree → scene.
//!
//! In: the tree of a file and the overrides. Out: the scene, or what is wrong with it. The items are walked once, in order:
//! every name is defined and every field evaluated where it stands; then the overrides of fields are evaluated, which see
//! all names; then each block is built. A problem of one field never hides one of another.

use std::collections::HashMap;

use glam::DVec3;

use super::{
    Camera, Count, Image, Lens, Object, Reading, Sampler, Scene, Shape, View, css,
    error::Problem,
    eval::{Evaluator, Names, predefined},
    level_direction,
    overrides::{self, Override},
    schema::{self, Condition, Field, Kind, Literal, Preset, Type},
    untangle::untangle,
    value::{self, Value},
};
use crate::{
    color::Color,
    diagnostic::{self, Diagnostic},
    math::{Angle, exact},
    numbers,
    source::{SourceId, Sources, Span},
    suggest,
    syntax::{
        self, shorten,
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
            _ => None,
        });
        let bad: Vec<&str> = bad.collect();
        self.build(&bad)
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
        let earlier = self.blocks.iter().find(|other| other.row.kind == row.kind);
        let duplicate = !row.is_object && earlier.is_some();
        if let Some(earlier) = earlier
            && duplicate
        {
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
            }),
            Some(free) => *free = Some(given),
            None => {}
        }
    }

    fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        self.evaluate_loosely(&field.value);
        block.meant.extend(block.row.nearest_field(field.name.text));
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

    /// The value of a field, if it is of the field's type and keeps its conditions.
    fn typed(&mut self, row: &'static Field, tree: &tree::Value<'s>) -> Option<Value> {
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
            self.out_of_range(row, condition, tree, value);
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
                };
                self.problems.push(problem);
            }
            return None;
        };
        if let Some(method) = schema::method(written) {
            return Some(Value::Method(method));
        }
        let help = match suggest::nearest(written, schema::method_names()) {
            Some(near) => format!("did you mean `{near}`? The methods are {list}."),
            None => format!("the methods are {list}"),
        };
        self.problems.push(Problem::UnknownMethod {
            written: written.to_owned(),
            help,
            span: tree.span,
        });
        None
    }

    fn wrong_type(&mut self, row: &Field, tree: &tree::Value<'s>, value: Value) {
        let evaluator = self.evaluator();
        let label = evaluator.described(tree, value.kind());
        let written = evaluator.quoted(tree.span);
        let text = shorten(evaluator.sources.text(tree.span));
        let problem = if (row.takes, value.kind()) == (Type::Angle, Type::Number) {
            let [degrees, radians] = evaluator.with_units(tree);
            Problem::BareAngle {
                what: format!("`{}`", row.name),
                written,
                help: format!("write `{degrees}` (or `{radians}`)"),
                span: tree.span,
                label,
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
    ) {
        let written = shorten(self.sources.text(tree.span));
        let found = match (&tree.kind, value) {
            (ValueKind::Name(_) | ValueKind::Call { .. } | ValueKind::Chain { .. }, value) => {
                shown(value)
            }
            _ => written,
        };
        let (label, help) = range_words(row, condition, value);
        let message = match condition {
            Condition::NotZero => format!("`{}` must not be zero", row.name),
            _ => format!("`{}` must be {condition}, and it is {found}", row.name),
        };
        self.problems.push(Problem::OutOfRange {
            message,
            help,
            span: tree.span,
            label: label.to_owned(),
        });
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
            let value = self.typed(field, &set.value);
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

    fn build(&mut self, bad: &[&str]) -> Option<Scene> {
        let blocks = std::mem::take(&mut self.blocks);
        for block in &blocks {
            self.missing_fields(block);
        }
        let one = |kind| blocks.iter().find(|block| block.row.kind == kind);
        let image = self.image(one(Kind::Image));
        let sampler = self.sampler(one(Kind::Sampler), image);
        let start = Span::new(SourceId::File, 0, 0);
        let unknown = |name| self.cut || bad.iter().any(|text| mentions(text, name));
        let camera = match one(Kind::Camera) {
            Some(block) => self.camera(block),
            None => {
                if !unknown("camera") {
                    self.problems.push(Problem::MissingCamera { span: start });
                }
                None
            }
        };
        let mut objects = Vec::with_capacity(blocks.len());
        for block in blocks.iter().filter(|block| block.row.is_object) {
            objects.extend(self.object(block));
        }
        let none = !blocks.iter().any(|block| block.row.is_object);
        if none && bad.is_empty() && !self.cut {
            self.problems.push(Problem::NoObjects { span: start });
        }
        Some(Scene {
            image: image?,
            camera: camera?,
            sampler: sampler?,
            objects,
        })
    }

    fn missing_fields(&mut self, block: &Block<'s>) {
        if block.unfinished {
            return;
        }
        let has = |name: &str| block.given(name).is_some() || block.meant.contains(&name);
        let mut missing: Vec<String> = Vec::new();
        let mut examples: Vec<String> = Vec::new();
        let mut half = None;
        for row in block.row.fields {
            if row.preset == Preset::Required && !has(row.name) {
                missing.push(format!("`{}`", row.name));
                examples.push(format!("{} {}", row.name, example(row)));
            }
        }
        if block.row.kind == Kind::Camera && !has("lookat") && !has("direction") {
            missing.push("`lookat` or `direction`".to_owned());
            examples.push("lookat (0, 1, 0)".to_owned());
        }
        if block.row.kind == Kind::Box && !has("center") {
            match (has("min"), has("max")) {
                (true, true) => {}
                (false, false) => {
                    missing.push("`center`, or `min` and `max`".to_owned());
                    examples.push("center (0, 1, 0)".to_owned());
                }
                (true, false) => {
                    missing.push("`max` beside its `min`".to_owned());
                    examples.push("max (1, 1, 1)".to_owned());
                    half = block.given("min").map(|given| given.name);
                }
                (false, true) => {
                    missing.push("`min` beside its `max`".to_owned());
                    examples.push("min (-1, 0, -1)".to_owned());
                    half = block.given("max").map(|given| given.name);
                }
            }
        }
        if missing.is_empty() {
            return;
        }
        let needed = suggest::list(missing.iter().map(String::as_str));
        self.problems.push(Problem::MissingField {
            message: format!("{} needs {needed}", block.row.noun),
            help: format!("write `{}`", examples.join("  ")),
            span: block.keyword,
            label: match missing.len() {
                1 => "it is not given".to_owned(),
                _ => "they are not given".to_owned(),
            },
            half,
        });
    }

    fn image(&mut self, block: Option<&Block<'s>>) -> Option<Image> {
        let row = Fields::of(block, Kind::Image);
        Some(Image {
            width: row.number("width")? as u32,
            height: row.number("height")? as u32,
            background: row.color("background")?,
        })
    }

    fn sampler(&mut self, block: Option<&Block<'s>>, image: Option<Image>) -> Option<Sampler> {
        let fields = Fields::of(block, Kind::Sampler);
        let pixels = image.map(|image| u64::from(image.width) * u64::from(image.height));
        let total = block.and_then(|block| block.given("total"));
        let count = match total {
            Some(given) => {
                let total = fields.number("total").map(|total| total as u64);
                if let (Some(total), Some(pixels)) = (total, pixels)
                    && total < pixels
                {
                    self.problems.push(Problem::FewSamples {
                        total,
                        pixels,
                        span: given.span,
                    });
                }
                total.map(Count::Total)
            }
            None => {
                let per_pixel = fields.number("per_pixel").map(|count| count as u64);
                let most = pixels.map(|pixels| (1 << 53) / pixels);
                if let (Some(per_pixel), Some(most), Some(pixels)) = (per_pixel, most, pixels)
                    && per_pixel > most
                {
                    // The default is never too many.
                    let given = block.and_then(|block| block.given("per_pixel"));
                    let start = Span::new(SourceId::File, 0, 0);
                    self.problems.push(Problem::TooManySamples {
                        per_pixel,
                        pixels,
                        most,
                        span: given.map_or(start, |given| given.span),
                    });
                }
                per_pixel.map(Count::PerPixel)
            }
        };
        Some(Sampler {
            method: fields.method("method")?,
            count: count?,
            seed: fields.number("seed")? as u64,
        })
    }

    fn camera(&mut self, block: &Block<'s>) -> Option<Camera> {
        let fields = Fields::of(Some(block), Kind::Camera);
        let eye = fields.vector("eye");
        let up = fields.vector("up");
        let direction = block.given("direction");
        let view = match direction {
            Some(_) => fields.vector("direction").map(View::Direction),
            None => fields.vector("lookat").map(View::Lookat),
        };
        let seen = block.given("lookat").or(direction);
        if let (Some(eye), Some(view), Some(seen)) = (eye, view, seen) {
            match view {
                View::Lookat(point) if point == eye => self.problems.push(Problem::ViewUndefined {
                    lookat: seen.span,
                    eye: block.given("eye").map_or(block.keyword, |given| given.span),
                }),
                _ => self.up_parallel(block, eye, view, up, seen),
            }
        }
        let near = fields.number("near");
        let far = block
            .given("far")
            .map(|given| (given, fields.number("far")));
        if let (Some(near), Some((given, Some(far)))) = (near, far)
            && near >= far
        {
            self.empty_depth(block, near, far, given);
        }
        let lens = match block.given("fov") {
            Some(_) => fields.angle("fov").map(Lens::Fov),
            None => fields.number("d").map(Lens::Distance),
        };
        Some(Camera {
            eye: eye?,
            view: view?,
            up: up?,
            roll: fields.angle("roll")?,
            lens: lens?,
            view_height: fields.number("view_height")?,
            near: near?,
            far: match far {
                Some((_, far)) => Some(far?),
                None => None,
            },
        })
    }

    fn up_parallel(
        &mut self,
        block: &Block<'s>,
        eye: DVec3,
        view: View,
        up: Option<DVec3>,
        seen: Given,
    ) {
        let Some(up) = up else { return };
        let (from, to) = match view {
            View::Lookat(point) => (eye, point),
            View::Direction(direction) => (DVec3::ZERO, direction),
        };
        if !exact::cross_is_zero(up, from, to) {
            return;
        }
        // Against up, the top of the picture is the part of the level direction across up; along up, the opposite.
        let level = level_direction(up);
        let across = level * up.dot(up) - up * level.dot(up);
        let along = exact::dot_sign(up, from, to).is_gt();
        let top = if along { -across } else { across };
        let shown = axis_name(top).unwrap_or_else(|| {
            let largest = top.abs().max_element();
            match largest > 0.0 && largest.is_finite() {
                true => format!("towards {}", vector(top / largest)),
                false => "across your `up`".to_owned(),
            }
        });
        let suggested = axis_vector(top).unwrap_or_else(|| "(0, 1, 0)".to_owned());
        let given = block.given("up");
        let looks = match view {
            View::Lookat(_) if given.is_some() => "parallel to the view direction".to_owned(),
            View::Lookat(_) => format!("straight along up, which is {} if not given", vector(up)),
            View::Direction(_) if given.is_some() => "parallel to the view direction".to_owned(),
            View::Direction(_) => format!("parallel to up, which is {} if not given", vector(up)),
        };
        self.problems.push(Problem::UpParallel {
            help: format!(
                "the top of the picture is {shown} here; give another `up`, such as `up {suggested}`, to say so yourself"
            ),
            span: given.map_or(seen.span, |given| given.span),
            label: looks,
        });
    }

    fn empty_depth(&mut self, block: &Block<'s>, near: f64, far: f64, given: Given) {
        let near_given = block.given("near");
        let (shown_near, shown_far) = (numbers::short(near), numbers::short(far));
        self.problems.push(Problem::EmptyDepth {
            help: match near_given {
                Some(_) if far > 0.0 && near > far => {
                    format!("exchange them: `near {shown_far}  far {shown_near}`")
                }
                _ => format!("write a number above {shown_near} after `far`, or leave it out"),
            },
            far: given.span,
            far_label: match near_given {
                Some(_) => format!("{shown_far} is not more"),
                None => format!("not more than `near`, which is {shown_near} if not given"),
            },
            near: near_given.map(|given| given.span),
            near_label: format!("than {shown_near}"),
        });
    }

    fn object(&mut self, block: &Block<'s>) -> Option<Object> {
        let fields = Fields::of(Some(block), block.row.kind);
        let shape = match block.row.kind {
            Kind::Sphere => Shape::Sphere(super::Sphere {
                center: fields.vector("center")?,
                radius: fields.number("radius")?,
                color: fields.color("color")?,
            }),
            Kind::Triangle => self.triangle(block, &fields)?,
            Kind::Box => self.cuboid(block, &fields)?,
            Kind::Checkerboard => Shape::Checkerboard(super::Checkerboard {
                y: fields.number("y")?,
                square: fields.number("square")?,
                colors: fields.colors("colors")?,
            }),
            Kind::Image | Kind::Camera | Kind::Sampler => return None,
        };
        Some(Object {
            name: block.name.map(|name| name.text.to_owned()),
            shape,
            span: block.span,
        })
    }

    fn triangle(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Shape> {
        let sides = fields.vector("sides")?;
        if !exact::forms_triangle(sides.to_array()) {
            let [a, b, c] = sides.to_array();
            let (longest, [one, other], place) = if a >= b && a >= c {
                (a, [b, c], "first")
            } else if b >= c {
                (b, [a, c], "second")
            } else {
                (c, [a, b], "third")
            };
            let shown = |x: f64| numbers::short(x);
            self.problems.push(Problem::NotATriangle {
                a: shown(a),
                b: shown(b),
                c: shown(c),
                help: format!(
                    "make the {place} side shorter than the two others together, or each of them longer"
                ),
                span: block.given("sides").map_or(block.keyword, |given| given.span),
                label: format!(
                    "{} is not less than {} + {}",
                    shown(longest),
                    shown(one),
                    shown(other)
                ),
            });
            return None;
        }
        Some(Shape::Triangle(super::Triangle {
            centroid: fields.vector("centroid")?,
            normal: fields.vector("normal")?,
            sides,
            spin: fields.angle("spin")?,
            color: fields.color("color")?,
        }))
    }

    fn cuboid(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Shape> {
        let corners = block.given("min").or(block.given("max"));
        let (min, max) = match corners {
            Some(_) => (fields.vector("min"), fields.vector("max")),
            None => match (fields.vector("center"), fields.vector("size")) {
                (Some(center), Some(size)) => {
                    let (min, max) = exact::box_corners(center, size);
                    (Some(min), Some(max))
                }
                _ => (None, None),
            },
        };
        let color = fields.color("color");
        let (min, max) = (min?, max?);
        let axes = [
            ("x", min.x, max.x),
            ("y", min.y, max.y),
            ("z", min.z, max.z),
        ];
        let span = |name| block.given(name).map_or(block.keyword, |g: Given| g.span);
        if !min.is_finite() || !max.is_finite() {
            let span = span("center");
            self.problems.push(Problem::BoxTooLarge { span });
            return None;
        }
        if let Some(&(axis, low, high)) = axes.iter().find(|(_, low, high)| low >= high) {
            let (low, high) = (numbers::short(low), numbers::short(high));
            self.problems.push(match corners {
                Some(_) => Problem::EmptyBox {
                    axis,
                    help: format!("make `max` greater than `min` on every axis; along {axis} they are {high} and {low}"),
                    span: span("max"),
                    label: format!("{high} along {axis}"),
                    other: Some(span("min")),
                    other_label: format!("{low} along {axis}"),
                },
                None => Problem::EmptyBox {
                    axis,
                    help: "make it larger: so far from the origin, a number has no digits left for its size".to_owned(),
                    span: block.given("size").map_or(span("center"), |g| g.span),
                    label: format!("lost in rounding beside {low}"),
                    other: None,
                    other_label: String::new(),
                },
            });
            return None;
        }
        Some(Shape::Box(super::Cuboid {
            min,
            max,
            color: color?,
        }))
    }
}

impl Block<'_> {
    fn given(&self, name: &str) -> Option<Given> {
        let index = self.row.fields.iter().position(|row| row.name == name)?;
        self.given.get(index).copied().flatten()
    }
}

/// The values of a block's fields, defaults included. None where a value is missing or failed.
struct Fields<'b, 's> {
    block: Option<&'b Block<'s>>,
    kind: Kind,
}

impl<'b, 's> Fields<'b, 's> {
    fn of(block: Option<&'b Block<'s>>, kind: Kind) -> Self {
        Self { block, kind }
    }

    fn value(&self, name: &str) -> Option<Value> {
        if let Some(given) = self.block.and_then(|block| block.given(name)) {
            return given.value;
        }
        let row = schema::BLOCKS.iter().find(|row| row.kind == self.kind)?;
        match row.field(name)?.preset {
            Preset::Value(literal) => preset(literal),
            Preset::Required | Preset::Alternative | Preset::Nothing => None,
        }
    }

    fn number(&self, name: &str) -> Option<f64> {
        match self.value(name)? {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    fn angle(&self, name: &str) -> Option<Angle> {
        match self.value(name)? {
            Value::Angle(angle) => Some(angle),
            _ => None,
        }
    }

    fn vector(&self, name: &str) -> Option<DVec3> {
        match self.value(name)? {
            Value::Vector(vector) => Some(vector),
            _ => None,
        }
    }

    fn color(&self, name: &str) -> Option<Color> {
        match self.value(name)? {
            Value::Color(color) => Some(color),
            _ => None,
        }
    }

    fn colors(&self, name: &str) -> Option<[Color; 2]> {
        match self.value(name)? {
            Value::Colors(colors) => Some(colors),
            _ => None,
        }
    }

    fn method(&self, name: &str) -> Option<super::Method> {
        match self.value(name)? {
            Value::Method(method) => Some(method),
            _ => None,
        }
    }
}

fn preset(literal: Literal) -> Option<Value> {
    Some(match literal {
        Literal::Number(number) => Value::Number(number),
        Literal::Degrees(degrees) => Value::Angle(Angle::from_degrees(degrees)),
        Literal::Vector(vector) => Value::Vector(DVec3::from_array(vector)),
        Literal::Color(name) => Value::Color(css::color(name)?),
        Literal::Colors([first, second]) => {
            Value::Colors([css::color(first)?, css::color(second)?])
        }
        Literal::Method(name) => Value::Method(schema::method(name)?),
    })
}

fn is_target(block: &Block<'_>, target: &str) -> bool {
    match block.name {
        _ if !block.row.is_object => block.row.name == target,
        Some(name) => name.text == target,
        None => false,
    }
}

/// Whether a word stands in a text.
fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
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
    let help = match row.nearest_field(name.text) {
        Some(near) => format!("did you mean `{near}`? {noun} takes {all}."),
        None => format!("{} takes {all}", row.noun),
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

/// A value that a field can have.
fn example(row: &Field) -> String {
    match (row.preset, row.takes) {
        (Preset::Value(literal), _) if literal != Literal::Degrees(0.0) => literal.to_string(),
        (_, Type::Number) => "100".to_owned(),
        (_, Type::Angle) => "30deg".to_owned(),
        (_, Type::Vector) if row.name == "eye" => "(0, 2, 8)".to_owned(),
        (_, Type::Vector) if row.name == "normal" => "(0, 0, 1)".to_owned(),
        (_, Type::Vector) => "(0, 1, 0)".to_owned(),
        (_, Type::Color) => "olive".to_owned(),
        (_, Type::Colors) => "(gray, white)".to_owned(),
        (_, Type::Method) => "jittered".to_owned(),
    }
}

fn holds(condition: Condition, value: Value) -> bool {
    let two_to = |power: u32| (1_u64 << power) as f64;
    match (condition, value) {
        (Condition::Whole, Value::Number(x)) => x.fract() == 0.0,
        (Condition::MoreThan(bound), Value::Number(x)) => x > bound,
        (Condition::AtLeast(bound), Value::Number(x)) => x >= bound,
        (Condition::AtMostTwoTo(power), Value::Number(x)) => x <= two_to(power),
        (Condition::LessThanTwoTo(power), Value::Number(x)) => x < two_to(power),
        (Condition::LessThanHalfTurn, Value::Angle(angle)) => {
            value::compare_with_zero(angle).is_gt() && value::compare_with_half_turn(angle).is_lt()
        }
        (Condition::NotZero, Value::Vector(v)) => v != DVec3::ZERO,
        (Condition::EachMoreThanZero, Value::Vector(v)) => v.min_element() > 0.0,
        _ => true,
    }
}

/// The label and the help for a condition that does not hold.
fn range_words(row: &Field, condition: Condition, value: Value) -> (&'static str, String) {
    let example = example(row);
    let number = match value {
        Value::Number(number) => number,
        _ => 0.0,
    };
    match condition {
        Condition::Whole => {
            let (below, above) = (number.floor(), number.ceil());
            let help = match below >= 1.0 && above < 1e15 {
                true => format!("write `{below}` or `{above}`"),
                false => format!("write a whole number, such as `{example}`"),
            };
            ("not whole", help)
        }
        Condition::MoreThan(bound) if number < bound => (
            "too small",
            format!(
                "write `{}`, or another number above {bound}",
                numbers::short(-number)
            ),
        ),
        Condition::MoreThan(bound) => (
            "too small",
            format!("write a number above {bound}, such as `{example}`"),
        ),
        Condition::AtLeast(bound) => ("too small", format!("write `{bound}` or more")),
        Condition::AtMostTwoTo(power) => {
            ("too large", format!("write `{}` or less", 1_u64 << power))
        }
        Condition::LessThanTwoTo(power) => (
            "too large",
            format!("write `{}` or less", (1_u64 << power) - 1),
        ),
        Condition::LessThanHalfTurn => (
            "no field of view",
            "write an angle that lies between, such as `40deg`".to_owned(),
        ),
        Condition::NotZero => (
            "zero has no direction",
            format!("write a vector that points somewhere, such as `{example}`"),
        ),
        Condition::EachMoreThanZero => (
            "not all of these are above 0",
            format!("write three numbers above 0, such as `{example}`"),
        ),
    }
}

fn type_help(row: &Field, tree: &tree::Value<'_>, found: Type, text: &str) -> String {
    let literal = matches!(&tree.kind, ValueKind::Number(_) | ValueKind::Tuple(_));
    match (row.takes, found, &tree.kind) {
        (Type::Number, Type::Angle, ValueKind::Angle { number, .. }) => {
            format!("write `{number}`, without a unit")
        }
        (Type::Number, Type::Angle, _) => {
            format!("an angle divided by `1deg` is a number: `{text} / 1deg`")
        }
        (Type::Number, Type::Vector, kind) if !matches!(kind, ValueKind::Tuple(_)) => {
            format!("write a number, such as the length of the vector: `length({text})`")
        }
        (Type::Vector, Type::Number, _) if literal && matches!(row.name, "size" | "sides") => {
            format!("write three numbers, such as `({text}, {text}, {text})`")
        }
        (Type::Vector, Type::Number, _) => {
            format!(
                "write three numbers in parentheses, such as `{}`",
                example(row)
            )
        }
        (Type::Color, Type::Vector, _) if literal => {
            format!("write `rgb{text}` if these are red, green and blue from 0 to 255")
        }
        (Type::Color, Type::Colors, ValueKind::Tuple(parts)) if parts.len() == 2 => {
            "write one colour; only a checkerboard has two".to_owned()
        }
        (Type::Color, ..) => format!(
            "write a colour, such as `{}`, `#808000` or `rgb(128, 128, 0)`",
            example(row)
        ),
        (Type::Colors, Type::Color, _) => {
            let other = match text {
                "white" => "gray",
                _ => "white",
            };
            format!("write two colours: `({text}, {other})`")
        }
        _ => format!("write {}, such as `{}`", row.takes.noun(), example(row)),
    }
}

/// A computed value, for a message.
fn shown(value: Value) -> String {
    match value {
        Value::Number(number) => numbers::short(number),
        Value::Vector(v) => vector(v),
        Value::Angle(Angle {
            degrees,
            radians: 0.0,
        }) => format!("{}deg", numbers::short(degrees)),
        Value::Angle(Angle {
            degrees: 0.0,
            radians,
        }) => format!("{}rad", numbers::short(radians)),
        Value::Angle(angle) => {
            let degrees = angle.degrees + angle.radians.to_degrees();
            format!("{}deg", numbers::short(degrees))
        }
        Value::Color(color) => color.to_string(),
        Value::Colors([first, second]) => format!("({first}, {second})"),
        Value::Method(method) => method.name().to_owned(),
    }
}

fn vector(v: DVec3) -> String {
    let [x, y, z] = v.to_array().map(numbers::short);
    format!("({x}, {y}, {z})")
}

/// A vector along an axis, such as `−z`.
fn axis_name(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let sign = if part < 0.0 { '−' } else { '+' };
    Some(format!("{sign}{axis}"))
}

fn axis_vector(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let one = if part < 0.0 { "-1" } else { "1" };
    Some(match axis {
        'x' => format!("({one}, 0, 0)"),
        'y' => format!("(0, {one}, 0)"),
        _ => format!("(0, 0, {one})"),
    })
}

fn axis(v: DVec3) -> Option<(char, f64)> {
    match v.to_array() {
        [x, 0.0, 0.0] if x != 0.0 => Some(('x', x)),
        [0.0, y, 0.0] if y != 0.0 => Some(('y', y)),
        [0.0, 0.0, z] if z != 0.0 => Some(('z', z)),
        _ => None,
    }
}
