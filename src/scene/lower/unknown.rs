//! Fields that a block does not have: what was probably meant, and the field with its value as it should be.
//!
//! A field is renamed only where its value will do: in the block there is a place for it, and the value is of the type that it takes,
//! or can be made to be.

use super::{Block, Lowering, field_fixes::quoted, words::rgb};
use crate::{
    diagnostic::Fix,
    math::Angle,
    scene::{
        css,
        error::{Found, Problem},
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
enum Meant<'s> {
    /// This field.
    Field(&'static Field),
    /// This field, with half of the value.
    Half(&'static Field),
    /// Several fields, each with a part of the value.
    Spread(&'static Spread),
    /// The field and its value, written as one word.
    Joined(&'static Field, &'s str),
    /// The value of a field, whose name was left out.
    Value(&'static Field),
}

/// What a value gave.
#[derive(Clone, Copy)]
struct Outcome {
    value: Option<Value>,
    /// Whether it failed, and all that is wrong with it is reported.
    is_reported: bool,
}

impl<'s> Lowering<'s> {
    /// Reports a field that the block does not have.
    pub(super) fn unknown_field(&mut self, field: &tree::Field<'s>, block: &mut Block<'s>) {
        if field.value.span.source == SourceId::File {
            self.unknown.push(field.value.span);
        }
        let meant = self.meant(block.row, &field.name, &field.value);
        block.meant.extend(match meant {
            Some(
                Meant::Field(row) | Meant::Half(row) | Meant::Joined(row, _) | Meant::Value(row),
            ) => vec![row.name],
            Some(Meant::Spread(spread)) => spread.fields.to_vec(),
            None => Vec::new(),
        });
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
        let meant = self.meant(block.row, name, value);
        let meant = meant.filter(|meant| matches!(meant, Meant::Field(_)));
        let problem = self.unknown(block, name, value, meant);
        self.problems.push(problem);
    }

    fn unknown(
        &mut self,
        block: &Block<'s>,
        name: &Name<'s>,
        value: &tree::Value<'s>,
        meant: Option<Meant<'s>>,
    ) -> Found {
        let mut noun = block.row.noun.to_owned();
        if let Some(first) = noun.get_mut(..1) {
            first.make_ascii_uppercase();
        }
        let all = suggest::list(block.row.field_names());
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
        let (meant, fix) = match meant {
            None => (None, None),
            Some(Meant::Field(row)) => {
                let written = self.fitting(block, row, value, &found);
                let fix = written.map(|written| match written {
                    None => Fix::write(name.span, row.name),
                    Some(value) => Fix::write(whole, format!("{} {value}", row.name)),
                });
                (Some(format!("`{}`", row.name)), fix)
            }
            Some(Meant::Half(row)) => {
                let half = match (found.value, &value.kind) {
                    (Some(Value::Number(number)), ValueKind::Number(_)) => {
                        Some((number / 2.0).to_string())
                    }
                    (Some(Value::Number(_)), ValueKind::Chain { .. }) => {
                        Some(format!("({}) / 2", self.sources.text(value.span)))
                    }
                    (Some(Value::Number(_)), _) => {
                        Some(format!("{} / 2", self.sources.text(value.span)))
                    }
                    _ => None,
                };
                let is_free = has_place(block, row);
                let written = half.map(|half| format!("{} {half}", row.name));
                let shown = written.clone().unwrap_or_else(|| row.name.to_owned());
                let fix = written
                    .filter(|_| is_free && found.value.is_some_and(|value| row.allows(value)));
                (
                    Some(format!("`{shown}`")),
                    fix.map(|written| Fix::write(whole, written)),
                )
            }
            Some(Meant::Spread(spread)) => {
                let fix = self
                    .spread(block, spread, value)
                    .map(|written| Fix::write(whole, written));
                (Some(quoted(spread.fields)), fix)
            }
            Some(Meant::Joined(row, rest)) => {
                let written = format!("{} {rest}", row.name);
                let fix = has_place(block, row).then(|| Fix::write(name.span, &written));
                (Some(format!("`{written}`")), fix)
            }
            Some(Meant::Value(row)) => {
                let (shown, written) = match &value.kind {
                    ValueKind::Tuple(_) => (
                        format!("{} {}(…)", row.name, name.text),
                        self.called(row, name, value, found.value),
                    ),
                    _ => (
                        format!("{} {}", row.name, name.text),
                        Some(format!("{} {}", row.name, name.text)),
                    ),
                };
                let fix = match block.given(row.name) {
                    // `color olive green`: of two values the first is the field's.
                    Some(given)
                        if matches!(value.kind, ValueKind::Missing)
                            && given.span.end <= name.span.start =>
                    {
                        Some(Fix::remove(
                            format!("take `{}` away", name.text),
                            name.span,
                            self.sources,
                        ))
                    }
                    _ => written
                        .filter(|_| has_place(block, row))
                        .map(|written| Fix::write(whole, written)),
                };
                (Some(format!("`{shown}`")), fix)
            }
        };
        Problem::UnknownField {
            noun: block.row.noun,
            written: name.text.to_owned(),
            help: match meant {
                Some(meant) => format!("did you mean {meant}? {noun} takes {all}."),
                None => format!("{} takes {all}", block.row.noun),
            },
            span: name.span,
        }
        .with(fix)
    }

    fn meant(
        &self,
        row: &'static schema::Block,
        name: &Name<'s>,
        value: &tree::Value<'s>,
    ) -> Option<Meant<'s>> {
        let written = name.text;
        if let Some(field) = row.field_tried(written) {
            return Some(Meant::Field(field));
        }
        if let Some(field) = row
            .fields
            .iter()
            .find(|field| suggest::is_among(written, field.doubled))
        {
            return Some(Meant::Half(field));
        }
        if let Some(spread) = row
            .spreads
            .iter()
            .find(|spread| suggest::is_among(written, spread.words))
        {
            return Some(Meant::Spread(spread));
        }
        let of_type = |takes: Type| row.fields.iter().find(|field| field.takes == takes);
        let has_no_value = matches!(value.kind, ValueKind::Missing);
        let is_color = |text: &str| css::color(text).is_some();
        if has_no_value {
            let takes = match written {
                _ if schema::method(written).is_some() => Some(Type::Method),
                _ if is_color(written) => Some(Type::Color),
                _ => None,
            };
            if let Some(field) = takes.and_then(of_type) {
                return Some(Meant::Value(field));
            }
            let starts = |field: &&Field| field.name.len() > 2 && written.starts_with(field.name);
            let longest = row
                .fields
                .iter()
                .filter(starts)
                .max_by_key(|field| field.name.len());
            if let Some(field) = longest {
                let rest = written.get(field.name.len()..).unwrap_or_default();
                let fits = match field.takes {
                    Type::Number => rest.parse::<f64>().is_ok(),
                    Type::Color => is_color(rest),
                    Type::Method => schema::method(rest).is_some(),
                    Type::Angle | Type::Vector | Type::Colors => false,
                };
                let kind = self.names.value(rest).map(|value| value.kind());
                if fits || kind == Some(field.takes) {
                    return Some(Meant::Joined(field, rest));
                }
            }
        }
        let function =
            schema::function(written).filter(|_| matches!(value.kind, ValueKind::Tuple(_)));
        if let Some(field) = function.and_then(|function| of_type(function.gives)) {
            return Some(Meant::Value(field));
        }
        row.nearest_field(written).map(Meant::Field)
    }

    /// What a value is, and what is wrong with it. Of that only names are reported.
    fn tried(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Outcome {
        if let ValueKind::Name(name) = value.kind {
            // It may be a word that only the unknown field knows.
            let is_known = self.names.place(name).is_some() || css::color(name).is_some();
            if !is_known && matches!(wanted, None | Some(Type::Method)) {
                return Outcome {
                    value: schema::method(name).map(Value::Method),
                    is_reported: false,
                };
            }
        }
        let before = self.problems.len();
        let found = self.evaluate(value, wanted);
        let mut problems = self.problems.split_off(before);
        let count = problems.len();
        problems.retain(|found| found.problem.is_of_name());
        let is_reported = found.is_none() && problems.len() == count;
        self.problems.extend(problems);
        Outcome {
            value: found,
            is_reported,
        }
    }

    /// Whether a value will do for a field, as it is (`Some(None)`) or in another way.
    fn fitting(
        &self,
        block: &Block<'s>,
        row: &Field,
        value: &tree::Value<'s>,
        found: &Outcome,
    ) -> Option<Option<String>> {
        if !has_place(block, row) {
            return None;
        }
        let is_in_file = value.span.source == SourceId::File;
        match (found.value, &value.kind) {
            (None, ValueKind::Missing) => {
                let example = example_beside(row, &|other| block.given(other)?.value);
                is_in_file.then_some(Some(example))
            }
            (None, _) => found.is_reported.then_some(None),
            (Some(value), _) if value.kind() == row.takes && row.allows(value) => Some(None),
            (Some(Value::Number(number)), ValueKind::Number(text)) if row.takes == Type::Angle => {
                let angle = Value::Angle(Angle::from_degrees(number));
                row.allows(angle).then(|| Some(format!("{text}deg")))
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
            let outcome = self.tried(&element.value, Some(row.takes));
            let fits = outcome
                .value
                .is_some_and(|value| value.kind() == row.takes && row.allows(value));
            if !fits {
                return None;
            }
            written.push(format!("{name} {}", self.sources.text(element.value.span)));
        }
        Some(written.join("  "))
    }

    /// A field with the call of a function, which stood in its place.
    fn called(
        &self,
        row: &Field,
        name: &Name<'s>,
        value: &tree::Value<'s>,
        found: Option<Value>,
    ) -> Option<String> {
        let text = self.sources.text(value.span);
        match (row.takes, found) {
            (Type::Color, Some(Value::Vector(parts))) => {
                let color = rgb(parts, value, text)?;
                Some(format!("{} {color}", row.name))
            }
            (Type::Color, _) => None,
            _ => Some(format!("{} {}{text}", row.name, name.text)),
        }
    }
}

/// Whether a block may still be given a field.
fn has_place(block: &Block<'_>, row: &Field) -> bool {
    let is_given = |name: &str| block.given(name).is_some();
    !is_given(row.name) && !block.row.excludes(row.name).any(is_given)
}
