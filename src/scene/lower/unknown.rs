//! Fields that a block does not have: what was probably meant, and the field with its value as it should be.
//!
//! A field is renamed only where its value will do: in the block there is a place for it, and the value is of the type that it takes,
//! or can be made to be.

use super::{Block, Lowering, field_fixes::quoted, field_value::rgb};
use crate::{
    diagnostic::{Diagnostic, Fix},
    math::Angle,
    scene::{
        css,
        error::error,
        example_beside,
        schema::{self, Field, Spread, Type},
        value::Value,
    },
    source::SourceId,
    suggest,
    syntax::tree::{self, Name, ValueKind},
};

/// What a word that is no field of a block was to be.
#[derive(Clone, Copy)]
enum Meant {
    /// This field.
    Field(&'static Field),
    /// This field, with half of the value.
    Half(&'static Field),
    /// Several fields, each with a part of the value.
    Spread(&'static Spread),
    /// The value of this field, whose name was left out.
    Value(&'static Field),
}

impl<'s> Lowering<'s> {
    /// Reports a field that the block does not have.
    pub(super) fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        if field.value.span.source == SourceId::File {
            self.unknown.push(field.value.span);
        }
        let meant = meant(block.row, &field.name, &field.value);
        match meant {
            Some(Meant::Field(row) | Meant::Half(row) | Meant::Value(row)) => {
                block.meant.push(row.name);
            }
            Some(Meant::Spread(spread)) => block.meant.extend(spread.fields),
            None => {}
        }
        let problem = self.unknown(block, &field.name, &field.value, meant);
        self.problems.push(problem);
    }

    /// The same of a `--set` argument.
    pub(super) fn unknown_target(
        &mut self,
        block: &Block<'s>,
        name: &Name<'s>,
        value: &tree::Value<'s>,
    ) {
        let meant = meant(block.row, name, value);
        let meant = meant.filter(|meant| matches!(meant, Meant::Field(_)));
        let problem = self.unknown(block, name, value, meant);
        self.problems.push(problem);
    }

    fn unknown(
        &mut self,
        block: &Block<'s>,
        name: &Name<'s>,
        value: &tree::Value<'s>,
        meant: Option<Meant>,
    ) -> Diagnostic {
        let whole = match name.span.source == value.span.source && value.span.end > name.span.end {
            true => name.span.to(value.span),
            false => name.span,
        };
        // Looks for mistakes in the value, whatever it is for. What type is wanted is not known; only a name is wrong in any.
        let wanted = match meant {
            Some(Meant::Field(row)) => Some(row.takes),
            _ => None,
        };
        let found = self.tried(value, wanted);
        let text = self.sources.text(value.span);
        let (shown, fix) = match meant {
            None => (None, None),
            Some(Meant::Field(row)) => {
                let fix = match self.fitting(block, row, value, found) {
                    Some(written) if written == text => Some(Fix::write(name.span, row.name)),
                    Some(written) => Some(Fix::write(whole, format!("{} {written}", row.name))),
                    None => None,
                };
                (Some(format!("`{}`", row.name)), fix)
            }
            Some(Meant::Half(row)) => match (found, &value.kind) {
                (Some(Value::Number(number)), ValueKind::Number(_)) => {
                    let written = format!("{} {}", row.name, number / 2.0);
                    let fits = has_place(block, row) && row.allows(Value::Number(number));
                    let fix = fits.then(|| Fix::write(whole, &written));
                    (Some(format!("`{written}`")), fix)
                }
                _ => (Some(format!("`{}` with half of it", row.name)), None),
            },
            Some(Meant::Spread(spread)) => {
                let written = self.spread(block, spread, value);
                let fix = written.map(|written| Fix::write(whole, written));
                (Some(quoted(spread.fields)), fix)
            }
            Some(Meant::Value(row)) => {
                let (shown, written) = match (&value.kind, found) {
                    (ValueKind::Missing, _) => (name.text.to_owned(), Some(name.text.to_owned())),
                    (_, Some(Value::Vector(parts))) => {
                        (format!("{}(…)", name.text), rgb(parts, value, text))
                    }
                    _ => (format!("{}(…)", name.text), None),
                };
                let written = written.filter(|_| has_place(block, row));
                let fix = written.map(|it| Fix::write(whole, format!("{} {it}", row.name)));
                (Some(format!("`{} {shown}`", row.name)), fix)
            }
        };
        let noun = block.row.noun;
        let all = suggest::list(block.row.field_names());
        error(
            "unknown_field",
            format!("{noun} has no field `{}`", name.text),
        )
        .at(name.span, format!("not a field of {noun}"))
        .help(match shown {
            Some(shown) => {
                let article = noun.split_at(1);
                let noun = article.0.to_ascii_uppercase() + article.1;
                format!("did you mean {shown}? {noun} takes {all}.")
            }
            None => format!("{noun} takes {all}"),
        })
        .fixes(fix)
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
        let found = self.evaluate(value, wanted);
        let problems = self.problems.split_off(before).into_iter();
        self.problems
            .extend(problems.filter(Diagnostic::is_of_name));
        found
    }

    /// How a value has to be written for a field, if it will do or can be made to.
    fn fitting(
        &self,
        block: &Block<'s>,
        row: &Field,
        value: &tree::Value<'s>,
        found: Option<Value>,
    ) -> Option<String> {
        if !has_place(block, row) {
            return None;
        }
        let text = self.sources.text(value.span);
        match (found, &value.kind) {
            (None, ValueKind::Missing) => {
                let example = || example_beside(row, &|other| block.given(other)?.value);
                (value.span.source == SourceId::File).then(example)
            }
            (Some(value), _) if value.kind() == row.takes => {
                row.allows(value).then(|| text.to_owned())
            }
            (Some(Value::Number(number)), ValueKind::Number(text)) if row.takes == Type::Angle => {
                let angle = Value::Angle(Angle::from_degrees(number));
                row.allows(angle).then(|| format!("{text}deg"))
            }
            _ => None,
        }
    }

    /// Several fields with the parts of a value.
    fn spread(
        &mut self,
        block: &Block<'s>,
        spread: &Spread,
        value: &tree::Value<'s>,
    ) -> Option<String> {
        let ValueKind::Tuple(elements) = &value.kind else {
            return None;
        };
        if elements.len() != spread.fields.len() {
            return None;
        }
        let mut written = Vec::new();
        for (name, element) in spread.fields.iter().zip(elements) {
            let row = block.row.field(name).filter(|row| has_place(block, row))?;
            let value = self.tried(&element.value, Some(row.takes))?;
            if value.kind() != row.takes || !row.allows(value) {
                return None;
            }
            written.push(format!("{name} {}", self.sources.text(element.value.span)));
        }
        Some(written.join("  "))
    }
}

fn meant(row: &'static schema::Block, name: &Name<'_>, value: &tree::Value<'_>) -> Option<Meant> {
    let written = name.text;
    if let Some(field) = row.field_tried(written) {
        return Some(Meant::Field(field));
    }
    let is_tried = |words| suggest::is_among(written, words);
    if let Some(field) = row.fields.iter().find(|field| is_tried(field.doubled)) {
        return Some(Meant::Half(field));
    }
    if let Some(spread) = row.spreads.iter().find(|spread| is_tried(spread.words)) {
        return Some(Meant::Spread(spread));
    }
    // A field's value by itself.
    let takes = match value.kind {
        ValueKind::Missing if schema::method(written).is_some() => Some(Type::Method),
        ValueKind::Missing if css::color(written).is_some() => Some(Type::Color),
        ValueKind::Tuple(_) if written == "rgb" => Some(Type::Color),
        _ => None,
    };
    let mut fields = row.fields.iter();
    if let Some(field) = takes.and_then(|takes| fields.find(|field| field.takes == takes)) {
        return Some(Meant::Value(field));
    }
    row.nearest_field(written).map(Meant::Field)
}

/// Whether a block may still be given a field.
fn has_place(block: &Block<'_>, row: &Field) -> bool {
    let is_given = |name: &str| block.given(name).is_some();
    !is_given(row.name) && !block.row.excludes(row.name).any(is_given)
}
