//! Fields that a block does not have: what was probably meant, and the field with its value as it should be.
//!
//! A field is renamed only where its value will do: in the block there is a place for it, and the value is of the type that it takes,
//! or can be made to be.

use super::{
    block::{Block, Given},
    fixes::quoted,
    lowering::Lowering,
};
use crate::{
    color::Color,
    diagnostic::{Diagnostic, Fix},
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
    fix: Option<Fix>,
}

impl<'s> Lowering<'s> {
    /// Reports a field that the block does not have.
    pub(super) fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        if field.value.span.source == SourceId::File {
            self.unknown.push(field.value.span);
        }
        let meant = self.unknown(block, &field.name, &field.value);
        block.meant.extend(meant);
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
        let (help, fields, fix) = match meant {
            Some(meant) => {
                let takes = takes.replacen('a', "A", 1);
                let help = format!("did you mean {}? {takes}.", meant.shown);
                (help, meant.fields, meant.fix)
            }
            None => (takes, Vec::new(), None),
        };
        self.problems.push(problem.help(help).fixes(fix));
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
            return Some(self.renamed(block, field, name, value, whole));
        }
        if let Some(field) = row.fields.iter().find(|field| is_tried(field.doubled)) {
            let number = match (self.fitting(block, field, value), &value.kind) {
                (Some(number), ValueKind::Number(_)) => number.parse().ok(),
                _ => None,
            };
            let written = number.map(|number: f64| format!("{} {}", field.name, number / 2.0));
            let shown = match &written {
                Some(written) => format!("`{written}`"),
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
            let written = block.has_place(field).then_some(written);
            return Some(Meant::new(&[field.name], shown, whole, written));
        }
        let near = row.nearest_field(word)?;
        Some(self.renamed(block, near, name, value, whole))
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
            Some(written) if written != self.sources.text(value.span) => {
                let written = format!("{} {written}", field.name);
                let written = Some(written).filter(|_| value.span.source == SourceId::File);
                Meant::new(&[field.name], shown, whole, written)
            }
            written => {
                let written = written.map(|_| field.name.to_owned());
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

    /// How a value has to be written for a field, if it will do or can be made to.
    fn fitting(
        &mut self,
        block: &Block<'s>,
        row: &Field,
        value: &tree::Value<'s>,
    ) -> Option<String> {
        let found = self.tried(value, Some(row.takes));
        if !block.has_place(row) {
            return None;
        }
        let text = self.sources.text(value.span);
        let (written, means) = match (found, &value.kind) {
            (None, ValueKind::Missing) => {
                let example = || example_beside(row, &|other| block.given(other)?.value);
                return (value.span.source == SourceId::File).then(example);
            }
            (Some(value), _) if value.kind() == row.takes => {
                (row.allows(value).then(|| text.to_owned())?, Some(value))
            }
            (Some(found), _) => {
                let written = self.converted(row, value, found)?;
                let means = literal(&written, row.takes);
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
                self.object(block);
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
    ) -> Option<String> {
        let parts = value.parts();
        if !matches!(value.kind, ValueKind::Tuple(_)) || parts.len() != fields.len() {
            self.tried(value, None);
            return None;
        }
        let written = fields.iter().zip(parts).map(|(name, part)| {
            let written = self.fitting(block, block.row.field(name)?, part);
            Some(format!("{name} {}", written?))
        });
        let written: Option<Vec<String>> = written.collect();
        written.map(|written| written.join("  "))
    }
}

impl Meant {
    fn new(fields: &[&'static str], shown: String, place: Span, written: Option<String>) -> Self {
        Self {
            fields: fields.to_vec(),
            shown,
            fix: written.map(|written| Fix::write(place, written)),
        }
    }
}
