//! Fields that a block does not have: what was probably meant, and the field with its value as it
//! should be.
//!
//! A field is renamed only where its value will do: in the block there is a place for it, and the
//! value is of the type that it takes, or can be made to be.

use super::{
    block::{Block, Given},
    fixes::quoted,
    lowering::Lowering,
};
use crate::{
    color::Color,
    diagnostic::{Applicability, Diagnostic, Edit, Fix},
    scene::{error::error, eval::literal, examples::example_beside, model::Image},
    schema::{self, Field, Kind, Type, Value, css},
    source::{SourceId, Span},
    suggest,
    syntax::tree::{self, Name, ValueKind},
};

/// The largest picture.
const LARGEST: Image = Image {
    width: 1 << 20,
    height: 1 << 20,
    background: Color::BLACK,
};

/// What a word that is no field of a block was to be.
struct Meant {
    /// The fields.
    fields: Vec<&'static str>,
    /// The same in words.
    shown: String,
    /// Writes them, where that will do.
    fixes: Vec<Fix>,
}

impl<'s> Lowering<'s> {
    /// Reports a field that the block does not have.
    pub(super) fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        if field.value.span.source == SourceId::File {
            self.unknown.push(field.value.span);
        }
        if self.problems.is_full() {
            return;
        }
        let meant = self.unknown(block, &field.name, &field.value);
        for field in meant {
            if !block.meant.contains(&field) {
                block.meant.push(field);
            }
        }
    }

    /// Reports words that stand for the parts of a field, or for all fields of a way, as `p1`, `p2`
    /// and `p3` do, once for all; answers where they stand.
    pub(super) fn parted(
        &mut self,
        fields: &[tree::Field<'s>],
        block: &mut Block<'s>,
    ) -> Vec<Span> {
        let (row, mut taken) = (block.row, Vec::new());
        let is_unknown = |it: &tree::Field<'_>| row.field(it.name.text).is_none();
        // Most blocks have no such field.
        if !fields.iter().any(is_unknown) {
            return taken;
        }
        for &(rows, names) in row.parted {
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
                self.part(row, names, first, &found, unknown.name);
                taken.extend(found.iter().map(|it| it.name.span));
                block.meant.extend(names);
            }
        }
        taken
    }

    fn part(
        &mut self,
        row: &schema::Block,
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
            let value = self.tried(&it.value, Some(part));
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
        let shown = match only {
            Some(_) => format!("`{written}`"),
            None => quoted(names),
        };
        let is_safe = Applicability::safe_if(row.kind == Kind::Triangle);
        let fix = Fix::new(format!("write {shown}"), edits).with_applicability(is_safe);
        let noun = row.noun;
        let message = format!("{noun} has no field `{}`", unknown.text);
        let problem = error("unknown_field", message).help(fix.title.clone());
        let problem = problem.at(unknown.span, format!("not a field of {noun}"));
        self.problems.push(problem.fixes(are_right.then_some(fix)));
    }

    /// Reports it, also of a `--set` argument, and tells what was probably meant.
    pub(super) fn unknown(
        &mut self,
        block: &Block<'s>,
        name: &Name<'s>,
        value: &tree::Value<'s>,
    ) -> Vec<&'static str> {
        let meant = self.meant(block, name, value);
        if meant.is_none() {
            self.tried(value, None);
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

    fn meant(
        &mut self,
        block: &Block<'s>,
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
            // What means something elsewhere may belong there.
            return Some(match schema::is_word(word) {
                true => meant.unsure(),
                false => meant,
            });
        }
        if row.elsewhere(word).is_some() {
            return None;
        }
        let mut perhaps: Vec<&Field> = row.fields_perhaps(word).collect();
        // A vector of length 1 is a direction rather than a point.
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
        if let Some(several) = row.several.iter().find(|several| is_tried(several.words)) {
            let written = self.spread(block, several.fields, value);
            return Some(Meant::new(
                several.fields,
                quoted(several.fields),
                whole,
                written,
            ));
        }
        // A field's value by itself.
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
        Some(match is_near {
            true => meant,
            false => meant.unsure(),
        })
    }

    /// What was meant is this field. An argument keeps the sign between its name and its value.
    fn renamed(
        &mut self,
        block: &Block<'s>,
        field: &'static Field,
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

    /// What a value is. Of what is wrong with it only names are reported.
    fn tried(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        if let ValueKind::Name(name) = value.kind {
            // It may be a word that only the unknown field knows.
            let is_known = self.names.place(name).is_some() || css::color(name).is_some();
            if !is_known && matches!(wanted, None | Some(Type::Method)) {
                return schema::method(name).map(Value::Method);
            }
        }
        let before = self.problems.len();
        let found = self.trying(value.span, |it| it.evaluate(value, wanted));
        let problems = self.problems.split_off(before).into_iter();
        self.problems
            .extend(problems.filter(Diagnostic::is_of_name));
        found
    }

    /// How a value has to be written for a field, if it will do or can be made to, and whether that
    /// is sure.
    fn fitting(
        &mut self,
        block: &Block<'s>,
        row: &Field,
        value: &tree::Value<'s>,
    ) -> Option<(String, Applicability)> {
        let found = self.tried(value, Some(row.takes));
        if !block.has_place(row) || block.meant.contains(&row.name) {
            return None;
        }
        let text = self.sources.text(value.span);
        let (written, means) = match (found, &value.kind) {
            (None, ValueKind::Missing) => {
                let example = || example_beside(row, &|other| block.given(other)?.value);
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

    /// The number of errors that a block's fields make together, none of which is reported here.
    fn errors_of(&mut self, block: &Block<'s>) -> usize {
        let problems = std::mem::take(&mut self.problems);
        match block.row.kind {
            Kind::Camera => {
                self.camera(block);
            }
            // A picture that may be larger is not known yet.
            Kind::Sampler => {
                self.sampler(block, Some(LARGEST));
            }
            Kind::Image => {}
            Kind::Sphere | Kind::Triangle | Kind::Box | Kind::Checkerboard => {
                self.shape(block);
            }
        }
        let tried = std::mem::replace(&mut self.problems, problems);
        tried.iter().filter(|problem| problem.is_error()).count()
    }

    /// Several fields with the parts of a value.
    fn spread(
        &mut self,
        block: &Block<'s>,
        fields: &[&str],
        value: &tree::Value<'s>,
    ) -> Option<(String, Applicability)> {
        let parts = value.parts();
        if !matches!(value.kind, ValueKind::Tuple(_)) || parts.len() != fields.len() {
            self.tried(value, None);
            return None;
        }
        let written = fields.iter().zip(parts).map(|(name, part)| {
            let (written, applicability) = self.fitting(block, block.row.field(name)?, part)?;
            Some((format!("{name} {written}"), applicability))
        });
        let written: Option<Vec<(String, Applicability)>> = written.collect();
        let (written, applicability): (Vec<String>, Vec<Applicability>) =
            written?.into_iter().unzip();
        // Comments between the parts would go.
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

    /// The same, where something else may be meant.
    fn unsure(mut self) -> Self {
        for fix in &mut self.fixes {
            fix.applicability = fix.applicability.max(Applicability::Unsafe);
        }
        self
    }

    /// One or the other. A value that is of one type only tells which.
    fn or(mut self, other: Self) -> Self {
        self.shown += &format!(" or {}", other.shown);
        self.fields.extend(other.fields);
        self.fixes.extend(other.fixes);
        self
    }
}
