//! Converts each item of a file, i.e. each definition or block, to a part of the scene.

use super::{
    fixes,
    lowering::{Lowering, mentions},
};
use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Fix},
    scene::{
        error::{error, twice},
        lowered_block::{Given, LoweredBlock},
    },
    schema::{self, BOX, BlockKind, BlockRow, TRIANGLE, Type, predefined},
    source::{Span, sort_by_span},
    suggest,
    syntax::tree::{self, Definition, Item, Name, ValueKind},
};

impl<'s> Lowering<'s> {
    /// Converts the next definitions and blocks of the file to parts of the scene.
    pub(super) fn items(&mut self, items: &[Item<'s>]) {
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

    fn definition(&mut self, definition: &Definition<'s>) {
        let name = definition.name;
        let first = name.and_then(|name| self.names.place(name.text));
        let value = self.with_tried_suggestions(definition.value.span, |it| {
            it.evaluate(&definition.value, None)
        });
        let Some(name) = name else { return };
        // If the keyword's span is empty, the definition was written without `let`, and the parser
        // has reported it.
        let reported = definition.keyword.range().is_empty();
        match (predefined(name.text), first) {
            (Some(what), _) => {
                if !reported {
                    let message = format!("`{}` is {} already", name.text, what.noun());
                    let help = format!("choose another name, such as `my_{}`", name.text);
                    let problem = error("predefined_name", message);
                    let problem = problem.at(name.span, "this name is taken").help(help);
                    self.problems.push(problem);
                }
                // The name is defined without a value. A use of the name could mean the predefined
                // value or this definition, so it has no value and is not reported.
                self.names.define(name, None, &definition.value);
            }
            (None, None) => {
                self.names.define(name, value, &definition.value);
            }
            // The parser has reported this definition, and the first one stays valid.
            (None, Some(_)) if reported => {}
            (None, Some(first)) => {
                let message = format!("`{}` is defined twice", name.text);
                let title = format!("remove this `let {}`", name.text);
                let written = self.sources.text(name.span.to(definition.value.span));
                let text = self.sources.get(first.source).text();
                let text = text.get(first.start..).unwrap_or_default();
                let is_equal = value.is_some()
                    && value == self.names.value(name.text)
                    && text.starts_with(written);
                let fix = if is_equal {
                    fixes::remove_equal(title, definition.span, self.sources)
                } else {
                    Fix::remove_whole(title, definition.span, self.sources)
                };
                let help = "remove one of them, or give it another name; a name keeps its value";
                twice("duplicate_let", message, [first, name.span])
                    .help(help)
                    .fixes([fix])
                    .report(&mut self.problems);
            }
        }
    }

    fn block(&mut self, block: &tree::Block<'s>) {
        let Some(row) = self.row(block) else { return };
        self.name_of_block(row, block);
        let first = self.blocks.iter().find(|first| first.row.kind == row.kind);
        let duplicate = first.map(|first| {
            let message = format!("there are two `{}` blocks", row.name);
            twice("duplicate_block", message, [first.keyword, block.keyword()])
                .help(match row.kind {
                    BlockKind::Camera => "keep one; `--set camera.eye='(4, 2, 8)'` shows the scene from elsewhere, and `pinhole sheet --sweep` from many places",
                    _ => "keep one, with the fields of both",
                })
                .fixes(fixes::one_of_two(
                    row.name,
                    [first.span, block.span],
                    self.sources,
                ))
        });
        let is_duplicate = duplicate.is_some();
        self.problems.extend(duplicate);
        self.has_objects |= row.is_object;
        if let Some(repetition) = &block.repetition {
            if row.is_object {
                return self.repeated(row, block, repetition);
            }
            if !repetition.indices.is_empty() {
                self.not_repeated(row, repetition);
            }
        }
        let lowered = self.lowered(row, block);
        if row.is_object {
            self.object(&lowered, &[]);
        } else if !is_duplicate {
            self.blocks.push(lowered);
        }
    }

    /// Evaluates the fields of a block, and reports their problems. An unknown field is reported,
    /// too.
    pub(super) fn lowered(
        &mut self,
        row: &'static BlockRow,
        block: &tree::Block<'s>,
    ) -> LoweredBlock<'s> {
        let open = block.open.map(|open| open.start);
        let mut lowered = LoweredBlock {
            keyword: block.keyword(),
            name: block.name.filter(|_| row.is_object),
            // If the end of the block is missing, or text before its `{` could not be parsed,
            // fields may be lost. Missing fields are then not reported.
            unfinished: block.close.is_none() || block.bad.iter().any(|bad| Some(bad.start) < open),
            ..LoweredBlock::empty(row, block.span)
        };
        for span in &block.bad {
            let text = self.sources.text(*span);
            let mentioned = row.field_names().filter(|name| mentions(text, name));
            lowered.meant.extend(mentioned);
            // If the indices of a `for` could not be parsed, their names are not reported as
            // undefined where they are used.
            if Some(span.start) < open {
                self.names.know_words(text);
            }
        }
        let split_fields = self.split_fields(&block.fields, &mut lowered);
        let is_left = |field: &&tree::Field<'s>| !split_fields.contains(&field.name.span);
        let is_known = |field: &&tree::Field<'s>| row.field(field.name.text).is_some();
        let left = || block.fields.iter().filter(is_left);
        for field in left().filter(is_known) {
            self.field(field, &mut lowered);
        }
        let unknown: Vec<_> = left().filter(|field| !is_known(field)).collect();
        // If two unknown words probably mean the same field, it is uncertain which of them is
        // right. The field is nevertheless recorded as given, so that it is not also reported as
        // missing.
        let mut tried: Vec<&str> = Vec::new();
        for field in unknown
            .iter()
            .filter_map(|it| row.field_tried(it.name.text))
        {
            if tried.contains(&field.name) {
                lowered.meant.push(field.name);
            }
            tried.push(field.name);
        }
        // Unknown fields are handled last, because they cannot mean a field that the block already
        // has.
        for field in unknown {
            self.unknown_field(field, &mut lowered);
        }
        self.conflicts(&lowered);
        if row.is_object {
            self.missing_fields(&lowered);
        }
        lowered
    }

    /// Returns the schema's row for the kind of a block. If the kind is unknown, reports it and
    /// returns the row of the nearest kind, if there is one.
    fn row(&mut self, block: &tree::Block<'s>) -> Option<&'static BlockRow> {
        let kind = block.kind?;
        let row = schema::block(kind.text);
        if row.is_some() {
            return row;
        }
        let near = schema::nearest_block(kind.text);
        let is_sure = |near: &BlockRow| {
            let is_tried = suggest::is_among(kind.text, near.also_tried);
            // A `plane` of another program has one colour and no squares, so replacing it by a
            // checkerboard is not safe.
            let is_plane = matches!(kind.text, "plane" | "floor" | "ground");
            is_tried && !is_plane && !schema::is_word(kind.text)
                || suggest::is_only_near(kind.text, near.name, schema::block_names())
        };
        // A block of an unknown kind may be meant as an object, so missing objects are not
        // reported.
        self.has_objects |= near.is_none();
        // If the block has no fields and no `}`, the parser has reported it already.
        if near.is_none() && block.close.is_none() && block.fields.is_empty() {
            return None;
        }
        let kinds = suggest::list(schema::block_names());
        let help = match near {
            Some(near) => format!("did you mean `{}`? The kinds are {kinds}.", near.name),
            None if block.repetition.is_some() || block.name.is_some_and(|it| it.text == "for") => {
                format!(
                    "write the kind first, as in `sphere {} for i < 8 {{`",
                    kind.text
                )
            }
            None if schema::OTHER_SHAPES
                .split(' ')
                .any(|shape| shape == kind.text) =>
            {
                format!("the kinds are {kinds}; other shapes are made of triangles")
            }
            None => format!("the kinds are {kinds}"),
        };
        let message = format!("there is no kind of block `{}`", kind.text);
        error("unknown_kind", message)
            .at(kind.span, "not a kind of block")
            .help(help)
            .writing(
                kind.span,
                Applicability::safe_if(near.is_some_and(is_sure)),
                near.map(|near| near.name),
            )
            .report(&mut self.problems);
        near
    }

    /// Evaluates a field that the block's kind has. Reports a field that is given twice, and keeps
    /// the first one.
    fn field(&mut self, field: &tree::Field<'s>, block: &mut LoweredBlock<'s>) {
        let before = self.problems.len();
        let mut rows = block.row.fields.iter().enumerate();
        let Some((at, row)) = rows.find(|(_, row)| row.name == field.name.text) else {
            return;
        };
        if matches!(field.value.kind, ValueKind::Missing) {
            self.missing_value(&field.name, row);
        }
        let given = Given {
            name: field.name.span,
            span: field.value.span,
            value: self.typed(row, &field.value),
        };
        if self.problems.len() > before {
            let mut others = [BOX.color.name, BOX.colors.name].into_iter();
            let is_free = others.find(|name| *name != row.name).is_some_and(|it| {
                block.row.field(it).is_some() && block.given_by_name(it).is_none()
            });
            self.other_colors(before, field, row.takes, is_free);
        }
        let Some(slot) = block.given.get_mut(at) else {
            return;
        };
        if let Some(first) = slot {
            let message = format!("`{}` is given twice", row.name);
            let fields = [first.field(), given.field()];
            twice("duplicate_field", message, [first.name, given.name])
                .help("remove one of them")
                .fixes(fixes::one_of_two(row.name, fields, self.sources))
                .report(&mut self.problems);
        } else {
            *slot = Some(given);
        }
    }

    /// Improves the report of a field with a wrong number of colours, such as `color (red, green,
    /// blue)`. Suggests `colors` instead of `color`, or `color` instead of `colors`, if the number
    /// is right for the suggested field. `is_free` is true if the block does not have the suggested
    /// field yet.
    fn other_colors(&mut self, before: usize, field: &tree::Field<'s>, takes: Type, is_free: bool) {
        let is_color = |value: &tree::Value<'s>| match &value.kind {
            ValueKind::Call(call) => call.function.text == "rgb",
            kind => matches!(kind, ValueKind::Name(_) | ValueKind::ColorCode(_)),
        };
        let parts = match &field.value.kind {
            ValueKind::Tuple(_) => field.value.parts(),
            _ => vec![&field.value],
        };
        let (other, help) = match (takes, parts.len(), self.is_odd) {
            (Type::Color, 3, _) if is_free => (BOX.colors.name, ""),
            (Type::FaceColors, 1, _) | (Type::FaceColors, 2, Some(_)) if is_free => {
                (BOX.color.name, "")
            }
            (Type::Color, 2, None) => (
                "",
                "write one colour; a pair takes turns where objects have indices, as in `for i < 8`",
            ),
            (Type::FaceColors, 2, None) => (
                "",
                "write three colours, of the faces across x, y and z, or one `color`",
            ),
            _ => return,
        };
        let new = self.problems.get_mut(before..).unwrap_or_default();
        if let [problem] = new
            && problem.code == "pinhole::wrong_type"
            && parts.into_iter().all(is_color)
        {
            let fix = (!other.is_empty()).then(|| Fix::write(field.name.span, other).safe());
            let title = fix.as_ref().map(|fix| fix.title.clone());
            problem.help = title.or(Some(help.to_owned()));
            problem.fixes = fix.into_iter().collect();
        }
    }

    /// Reports two fields that exclude each other. The first label is at the later field.
    fn conflicts(&mut self, block: &LoweredBlock<'s>) {
        // Each group of fields that exclude each other is reported at most once, even for a box
        // with center, size, min and max.
        for choice in block.row.choices {
            let fields = choice.ways.iter().flat_map(|way| way.iter().copied());
            let given = fields
                .filter_map(|name| Some((block.row.field(name)?, block.given_by_name(name)?)));
            let mut given: Vec<_> = given.collect();
            sort_by_span(&mut given, |(_, given)| given.name);
            let [(first, earlier), ..] = given[..] else {
                continue;
            };
            let excluded: Vec<&str> = block.row.excludes(first.name).collect();
            let later = given.iter().find(|(row, _)| excluded.contains(&row.name));
            let Some(&(second, later)) = later else {
                continue;
            };
            let message = format!("`{}` and `{}` exclude each other", second.name, first.name);
            let (help, fix) = match self.other_corner(block) {
                Some(fix) => (fix.title.clone(), Some(fix)),
                None => (format!("remove one of them: {}", choice.why), None),
            };
            error("conflicting_fields", message)
                .at(
                    later.name,
                    match second.name {
                        it if it == TRIANGLE.spin.name => "the vertices fix the turn already",
                        _ => "this says it again, in another way",
                    },
                )
                .at(
                    earlier.name,
                    match first.name {
                        it if it == TRIANGLE.spin.name => "the vertices fix the turn",
                        _ => "this says it already",
                    },
                )
                .help(help)
                .fixes(fix)
                .fixes(self.one_of(block, choice, [first.name, second.name]))
                .report(&mut self.problems);
        }
    }

    /// For a box with a `size` and one corner, returns a fix that replaces the size by the other
    /// corner.
    fn other_corner(&self, block: &LoweredBlock<'s>) -> Option<Fix> {
        if block.row.kind != BlockKind::Box || block.given(BOX.center).is_some() {
            return None;
        }
        let size = block.given(BOX.size)?;
        let (corner, other, sign) = match (block.given(BOX.min), block.given(BOX.max)) {
            (Some(corner), None) => (corner, BOX.max.name, "+"),
            (None, Some(corner)) => (corner, BOX.min.name, "-"),
            _ => return None,
        };
        let texts = [corner, size].map(|it| self.sources.text(it.span));
        let written = format!("{} {sign} {}", texts[0], texts[1]);
        // If `min` is to be written as `max - size` and the size is a sum, the size would need
        // parentheses, so there is no fix.
        let is_sum = sign == "-" && size.value.is_some() && !texts[1].starts_with('(');
        let is_sum = is_sum && texts[1].contains(['+', '-']);
        (!is_sum).then(|| Fix::write(size.field(), format!("{other} {written}")))
    }

    /// Reports a field without a value. The fix writes an example after the name; a `=` or `:` that
    /// follows the name is replaced.
    fn missing_value(&mut self, name: &Name<'s>, row: &schema::FieldRow) {
        let (noun, field, example) = (row.takes.noun(), row.name, row.example);
        let text = self.sources.get(name.span.source).text();
        let rest = text
            .get(name.span.end..)
            .unwrap_or_default()
            .trim_start_matches([' ', '\t']);
        let end = match rest.strip_prefix(['=', ':']) {
            Some(rest) => text.len() - rest.len(),
            None => name.span.end,
        };
        let behind = Span::new(name.span.source, name.span.end, end);
        let edit = Edit::new(behind, format!(" {example}"));
        self.problems.push(Diagnostic {
            // This is a syntax problem. It is reported here, because the parser does not know which
            // names are fields.
            is_of_syntax: true,
            ..error("missing_value", format!("`{field}` has no value"))
                .at(name.span, "a value should follow this")
                .help(format!(
                    "write {noun} after it, such as `{field} {example}`"
                ))
                .fixes([Fix::new(format!("write `{field} {example}`"), [edit]).placeholder()])
        });
    }

    /// Records the name of an object. Reports a name that cannot be used, and a name of a block
    /// that is not an object.
    fn name_of_block(&mut self, row: &BlockRow, block: &tree::Block<'s>) {
        let Some(name) = block.name else { return };
        let text = name.text;
        let problem = if !row.is_object {
            // A part of the block's text could not be parsed. The name may belong to this part, so
            // it is not reported.
            if !block.bad.is_empty() {
                return;
            }
            let help = format!(
                "take `{text}` away; only objects have names, for a scene has one `{}`",
                row.name
            );
            error("unexpected_name", format!("{} takes no name", row.noun))
                .at(name.span, "not here")
                .help(help)
        } else if text == "for" {
            error("reserved_name", "no object can be named `for`")
                .at(name.span, "this repeats an object")
                .help("choose another name, or write how often it is repeated, as in `for i < 8`")
        } else if schema::block(text).is_some_and(|row| !row.is_object) {
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
        let title = format!("take the name `{text}` away");
        let fix = Fix::remove(title, name.span, self.sources);
        self.problems.push(problem.fixes([fix]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_other_programs_are_no_kinds_of_blocks() {
        for shape in schema::OTHER_SHAPES.split(' ') {
            assert!(schema::nearest_block(shape).is_none(), "{shape}");
        }
    }
}
