//! Reports fields that a block does not have, with the fields that were probably meant.
//!
//! A fix renames a field only if this causes no error. The block must not have the new field or a
//! field that excludes it. The value must have the new field's type, or must be convertible to it.

use super::{fixes::quoted, lowering::Lowering};
use crate::{
    color::Color,
    diagnostic::{Applicability, Diagnostic, Edit, Fix},
    scene::{
        error::error,
        eval::literal,
        examples::example_beside,
        lowered_block::{Given, LoweredBlock},
        model::Image,
        shape::Shape,
    },
    schema::{self, BlockKind, BlockRow, FieldRow, Type, Value, css},
    source::{SourceId, Span},
    suggest,
    syntax::tree::{self, Name, ValueKind},
};

/// Largest possible picture. It is used instead of the scene's image when a sampler is checked
/// before the picture's size is known. A number of samples that is allowed for this picture is
/// allowed for every other picture, too.
const LARGEST: Image = Image {
    width: 1 << 20,
    height: 1 << 20,
    background: Color::BLACK,
};

/// The meaning of an unknown word: the fields that it probably stands for.
struct Meant {
    /// Names of the fields that were probably meant.
    fields: Vec<&'static str>,
    /// The names of the fields, joined for a message.
    shown: String,
    /// Alternative fixes that write the fields in place of the unknown word; empty if they would
    /// lead to an error.
    fixes: Vec<Fix>,
}

impl<'s> Lowering<'s> {
    /// Reports a field that the block does not have, and records the fields that were probably
    /// meant, so that they are not reported as missing.
    pub(super) fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut LoweredBlock<'s>) {
        if field.value.span.source == SourceId::File {
            self.unknown.push(field.value.span);
        }
        if self.problems.is_full() {
            return;
        }
        let meant = self.report_unknown(block, &field.name, &field.value);
        for field in meant {
            if !block.meant.contains(&field) {
                block.meant.push(field);
            }
        }
    }

    /// Reports several unknown words in one problem. The words may stand for the coordinates of one
    /// field, such as `x`, `y` and `z` for a centre. They may also stand for several fields, such
    /// as `p1`, `p2` and `p3` for the vertices of a triangle. Returns the spans of these words.
    pub(super) fn split_fields(
        &mut self,
        fields: &[tree::Field<'s>],
        block: &mut LoweredBlock<'s>,
    ) -> Vec<Span> {
        let (row, mut taken) = (block.row, Vec::new());
        let is_unknown = |it: &tree::Field<'_>| row.field(it.name.text).is_none();
        // Most blocks have no unknown field. For these, the function returns early.
        if !fields.iter().any(is_unknown) {
            return taken;
        }
        for &(rows, names) in row.split_words {
            for words in rows.split('|') {
                let mut found: Vec<&tree::Field<'s>> = Vec::new();
                for word in words.split(' ') {
                    let mut fields = fields.iter();
                    found.extend(fields.find(|it| suggest::is_among(it.name.text, word)));
                }
                let unknown = found.iter().find(|it| is_unknown(it));
                let is_all = found.len() == words.split(' ').count();
                let (Some(unknown), true, [first, ..]) = (unknown, is_all, names) else {
                    continue;
                };
                let is_given = |it: &tree::Field<'_>| {
                    let is_found = found.iter().any(|of| of.name.span == it.name.span);
                    !is_found && names.contains(&it.name.text)
                };
                let is_set = unknown.value.span.source != SourceId::File;
                let is_taken = found.iter().any(|it| taken.contains(&it.name.span));
                if is_set || is_taken || fields.iter().any(is_given) {
                    continue;
                }
                self.report_parts(row, names, first, &found, unknown.name);
                taken.extend(found.iter().map(|it| it.name.span));
                block.meant.extend(names);
            }
        }
        taken
    }

    /// Reports the unknown fields `found` in one problem. If `names` has one element, they stand
    /// for the coordinates or colours of this field. Otherwise, each stands for the field at the
    /// same position in `names`.
    fn report_parts(
        &mut self,
        row: &BlockRow,
        names: &[&str],
        first: &str,
        found: &[&tree::Field<'s>],
        unknown: Name<'s>,
    ) {
        let only = row.field(first).filter(|_| names.len() == 1);
        let part = only.and_then(|only| only.takes.parts());
        let part = part.map_or(Type::Vector, |(part, _)| part);
        let (mut are_right, mut list) = (true, String::new());
        for it in found {
            let value = self.evaluate_quietly(&it.value, Some(part));
            are_right &= value.is_some_and(|value| value.kind() == part);
            list += if list.is_empty() { "" } else { ", " };
            list += self.sources.text(it.value.span);
        }
        let written = format!("{first} ({list})");
        let mut edits = Vec::new();
        for (at, it) in found.iter().enumerate() {
            edits.push(match (names.get(at), only) {
                (Some(_), Some(_)) => Edit::new(it.span, written.clone()),
                (Some(name), None) => Edit::new(it.name.span, *name),
                (None, _) => Edit::remove(it.span, self.sources),
            });
        }
        let shown = only.map_or_else(|| quoted(names), |_| format!("`{written}`"));
        let is_safe = Applicability::safe_if(row.kind == BlockKind::Triangle);
        let fix = Fix::new(format!("write {shown}"), edits).with_applicability(is_safe);
        let noun = row.noun;
        let message = format!("{noun} has no field `{}`", unknown.text);
        let problem = error("unknown_field", message).help(fix.title.clone());
        let problem = problem.at(unknown.span, format!("not a field of {noun}"));
        self.problems.push(problem.fixes(are_right.then_some(fix)));
    }

    /// Reports an unknown field of a block or of a `--set` argument. Returns the fields that were
    /// probably meant.
    fn report_unknown(
        &mut self,
        block: &LoweredBlock<'s>,
        name: &Name<'s>,
        value: &tree::Value<'s>,
    ) -> Vec<&'static str> {
        let meant = self.meant(block, name, value);
        if meant.is_none() {
            self.evaluate_quietly(value, None);
        }
        let noun = block.row.noun;
        let takes = format!("{noun} takes {}", suggest::list(block.row.field_names()));
        let problem = error(
            "unknown_field",
            format!("{noun} has no field `{}`", name.text),
        )
        .at(name.span, format!("not a field of {noun}"));
        let (help, fields, fixes) = match meant {
            Some(meant) => {
                let takes = takes.replacen('a', "A", 1);
                let help = format!("did you mean {}? {takes}.", meant.shown);
                (help, meant.fields, meant.fixes)
            }
            None => match block.row.elsewhere(name.text) {
                Some(elsewhere) => (elsewhere.to_owned(), Vec::new(), Vec::new()),
                None => (takes, Vec::new(), Vec::new()),
            },
        };
        self.problems.push(problem.help(help).fixes(fixes));
        fields
    }

    /// Returns the fields that the unknown field `name` was probably meant to be. Returns `None` if
    /// there is no guess.
    fn meant(
        &mut self,
        block: &LoweredBlock<'s>,
        name: &Name<'s>,
        value: &tree::Value<'s>,
    ) -> Option<Meant> {
        let (row, word) = (block.row, name.text);
        let end = value.span.end.max(name.span.end);
        let whole = Span::new(name.span.source, name.span.start, end);
        let is_of_file = value.span.source == SourceId::File;
        let is_tried = |words| is_of_file && suggest::is_among(word, words);
        if let Some(field) = row.field_tried(word) {
            let meant = self.renamed(block, field, name, value, whole);
            // If the word is a keyword or the name of another block's field, the field may have
            // been meant for another block, so the fix is not safe.
            let is_known = schema::is_word(word);
            return Some(if is_known { meant.unsure() } else { meant });
        }
        if row.elsewhere(word).is_some() {
            return None;
        }
        let mut perhaps: Vec<&FieldRow> = row.fields_perhaps(word).collect();
        // A vector of length 1 is more likely a direction than a point. The fields are then
        // suggested in reverse order, `direction` before `lookat`.
        let is_unit = |text: &str| match literal(text, Type::Vector) {
            Some(Value::Vector(vector)) => (vector.length() - 1.0).abs() < 1e-3,
            _ => false,
        };
        if perhaps.len() > 1 && is_unit(self.sources.text(value.span)) {
            perhaps.reverse();
        }
        let perhaps = perhaps.into_iter();
        let perhaps = perhaps.map(|field| self.renamed(block, field, name, value, whole).unsure());
        if let Some(perhaps) = perhaps.reduce(Meant::or) {
            return Some(perhaps);
        }
        if let Some(field) = row.fields.iter().find(|field| is_tried(field.doubled)) {
            let number = match (self.fitting(block, field, value), &value.kind) {
                (Some((number, _)), ValueKind::Number(_)) => number.parse().ok(),
                _ => None,
            };
            let written = number.map(|number: f64| format!("{} {}", field.name, number / 2.0));
            let written = written.map(|written| (written, Applicability::Unsafe));
            let shown = match &written {
                Some((written, _)) => format!("`{written}`"),
                None => format!("`{}` with half of it", field.name),
            };
            return Some(Meant::new(&[field.name], shown, whole, written));
        }
        let mut several = row.several.iter();
        if let Some(&(_, fields)) = several.find(|(words, _)| is_tried(words)) {
            let written = self.spread(block, fields, value);
            return Some(Meant::new(fields, quoted(fields), whole, written));
        }
        // The word may be a value whose field's name is missing, such as `red`. The type of the
        // value then determines the field.
        let takes = match value.kind {
            ValueKind::Missing if schema::method(word).is_some() => Some(Type::Method),
            ValueKind::Missing if css::color(word).is_some() => Some(Type::Color),
            ValueKind::Tuple(_) if word == "rgb" => Some(Type::Color),
            _ => None,
        };
        if let Some(field) = row.fields.iter().find(|field| Some(field.takes) == takes) {
            if !matches!(value.kind, ValueKind::Missing) {
                return Some(self.renamed(block, field, name, value, whole));
            }
            let written = format!("{} {word}", field.name);
            let shown = format!("`{written}`");
            let has_place = block.has_place(field);
            let written = has_place.then_some((written, Applicability::Safe));
            return Some(Meant::new(&[field.name], shown, whole, written));
        }
        let near = row.nearest_field(word)?;
        let meant = self.renamed(block, near, name, value, whole);
        let is_near = suggest::nearest(word, [near.name]).is_some()
            && suggest::is_only_near(word, near.name, row.field_names())
            && !schema::is_word(word);
        Some(if is_near { meant } else { meant.unsure() })
    }

    /// Returns the meaning of an unknown field that probably stands for `field`. Its fix renames
    /// the field and, if necessary, converts the value. There is no fix if the value does not suit
    /// `field`, or if the value must be converted but stands in a `--set` argument.
    fn renamed(
        &mut self,
        block: &LoweredBlock<'s>,
        field: &'static FieldRow,
        name: &Name<'s>,
        value: &tree::Value<'s>,
        whole: Span,
    ) -> Meant {
        let written = self.fitting(block, field, value);
        let shown = format!("`{}`", field.name);
        match written {
            Some((written, applicability)) if written != self.sources.text(value.span) => {
                let written = (format!("{} {written}", field.name), applicability);
                let written = Some(written).filter(|_| value.span.source == SourceId::File);
                Meant::new(&[field.name], shown, whole, written)
            }
            written => {
                let written = written.map(|_| (field.name.to_owned(), Applicability::Safe));
                Meant::new(&[field.name], shown, name.span, written)
            }
        }
    }

    /// Evaluates a value, but reports only its undefined names. Returns `None` if the value has
    /// errors.
    fn evaluate_quietly(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        if let ValueKind::Name(name) = value.kind {
            // A name that is neither defined nor a colour may be the name of a sampling method. The
            // name is then read as a method, and not reported as undefined.
            let is_known = self.names.place(name).is_some() || css::color(name).is_some();
            if !is_known && matches!(wanted, None | Some(Type::Method)) {
                return schema::method(name).map(Value::Method);
            }
        }
        let before = self.problems.len();
        let found = self.with_tried_suggestions(value.span, |it| it.evaluate(value, wanted));
        let problems = self.problems.split_off(before).into_iter();
        self.problems
            .extend(problems.filter(Diagnostic::is_of_name));
        found
    }

    /// Returns the text of a value, converted to the type of the field `row` if necessary, and
    /// whether writing it is safe. Returns `None` if the field cannot be added to the block, or if
    /// the value does not fit and cannot be converted.
    fn fitting(
        &mut self,
        block: &LoweredBlock<'s>,
        row: &FieldRow,
        value: &tree::Value<'s>,
    ) -> Option<(String, Applicability)> {
        let found = self.evaluate_quietly(value, Some(row.takes));
        if !block.has_place(row) || block.meant.contains(&row.name) {
            return None;
        }
        let text = self.sources.text(value.span);
        let (written, means) = match (found, &value.kind) {
            (None, ValueKind::Missing) => {
                let example = || example_beside(row, &|other| block.given_by_name(other)?.value);
                let is_of_file = value.span.source == SourceId::File;
                return is_of_file.then(|| (example(), Applicability::Placeholder));
            }
            (Some(value), _) if value.kind() == row.takes => {
                let written = row.allows(value).then(|| text.to_owned())?;
                ((written, Applicability::Safe), Some(value))
            }
            (Some(found), _) => {
                let written = self.converted(row, value, found)?;
                let means = literal(&written.0, row.takes);
                (written, means)
            }
            (None, _) => return None,
        };
        let given = Given {
            name: value.span,
            span: value.span,
            value: means,
        };
        let with_it = block.with(row, given);
        (self.errors_of(&with_it) <= self.errors_of(block)).then_some(written)
    }

    /// Returns the number of errors that building the block from its fields causes. Reports
    /// nothing.
    fn errors_of(&mut self, block: &LoweredBlock<'s>) -> usize {
        let problems = std::mem::take(&mut self.problems);
        match block.row.kind {
            BlockKind::Camera => {
                self.camera(block);
            }
            // The size of the picture may not be known yet, so the largest one is assumed.
            BlockKind::Sampler => {
                self.sampler(block, Some(LARGEST));
            }
            BlockKind::Image => {}
            // All other kinds of blocks are objects.
            _ => {
                Shape::lower(block, &mut self.problems);
            }
        }
        let tried = std::mem::replace(&mut self.problems, problems);
        tried.iter().filter(|problem| problem.is_error()).count()
    }

    /// Distributes the elements of the list `value` among `fields`. Returns the text of these
    /// fields with their values, and whether writing it is safe. Returns `None` if `value` is not a
    /// list with one element for each field, or if an element does not fit its field.
    fn spread(
        &mut self,
        block: &LoweredBlock<'s>,
        fields: &[&str],
        value: &tree::Value<'s>,
    ) -> Option<(String, Applicability)> {
        let parts = value.parts();
        if !matches!(value.kind, ValueKind::Tuple(_)) || parts.len() != fields.len() {
            self.evaluate_quietly(value, None);
            return None;
        }
        let written = fields.iter().zip(parts).map(|(name, part)| {
            let (written, applicability) = self.fitting(block, block.row.field(name)?, part)?;
            Some((format!("{name} {written}"), applicability))
        });
        let written: Option<Vec<(String, Applicability)>> = written.collect();
        let (written, applicability): (Vec<String>, Vec<Applicability>) =
            written?.into_iter().unzip();
        // A comment between the elements would be lost, so the fix is not safe if there is one.
        let text = self.sources.text(value.span);
        let has_comment = text.contains("//") || text.contains("/*");
        let least = Applicability::safe_if(!has_comment);
        let applicability = applicability.into_iter().fold(least, Applicability::max);
        Some((written.join("  "), applicability))
    }
}

impl Meant {
    fn new(
        fields: &[&'static str],
        shown: String,
        place: Span,
        written: Option<(String, Applicability)>,
    ) -> Self {
        let fix =
            |(written, applicability)| Fix::write(place, written).with_applicability(applicability);
        Self {
            fields: fields.to_vec(),
            shown,
            fixes: written.into_iter().map(fix).collect(),
        }
    }

    /// Marks the fixes as unsafe, because the word may have another meaning.
    fn unsure(mut self) -> Self {
        for fix in &mut self.fixes {
            fix.applicability = fix.applicability.max(Applicability::Unsafe);
        }
        self
    }

    /// Joins two possible meanings of an unknown word, with the fixes of both.
    fn or(mut self, other: Self) -> Self {
        self.shown += &format!(" or {}", other.shown);
        self.fields.extend(other.fields);
        self.fixes.extend(other.fixes);
        self
    }
}
