//! Evaluates the value of a field, and checks its type and its conditions.

use glam::DVec3;

use super::lowering::Lowering;
use crate::{
    color::in_bytes,
    diagnostic::{Applicability, Diagnostic},
    math::Angle,
    numbers,
    scene::{error::error, eval::Evaluator},
    schema::{self, Condition, FieldRow, Preset, Type, Value},
    suggest,
    syntax::{
        shorten,
        tree::{self, Element, Unit, ValueKind},
    },
};

impl<'s> Lowering<'s> {
    /// Evaluates the value of a field. Reports an error, and returns `None`, if the value has
    /// errors or another type than the field, or breaks the field's conditions.
    pub(super) fn typed(
        &mut self,
        row: &'static FieldRow,
        tree: &tree::Value<'s>,
    ) -> Option<Value> {
        self.with_tried_suggestions(tree.span, |it| it.typed_once(row, tree))
    }

    fn typed_once(&mut self, row: &'static FieldRow, tree: &tree::Value<'s>) -> Option<Value> {
        let before = self.problems.len();
        let value = match (row.takes, &tree.kind) {
            (Type::Method, ValueKind::Name(written)) => return self.method(written, tree),
            (Type::Vector | Type::Colors | Type::FaceColors, _) => {
                self.evaluate(tree, Some(row.takes))?
            }
            (Type::Color, ValueKind::Tuple(elements))
                if elements.len() == 2 && self.is_odd.is_some() =>
            {
                self.evaluate(tree, Some(Type::Colors))?
            }
            (_, ValueKind::Tuple(elements)) if elements.len() != 3 => {
                self.unexpected_list(row, tree, elements);
                return None;
            }
            _ => self.evaluate(tree, Some(row.takes))?,
        };
        let value = match (row.takes, value, self.is_odd) {
            (Type::Color, Value::Colors([even, odd]), Some(is_odd)) => {
                Value::Color(if is_odd { odd } else { even })
            }
            _ => value,
        };
        if value.kind() != row.takes {
            let problem = self.wrong_type(row, tree, value);
            self.problems.push(problem);
            return None;
        }
        let broken = row.must.iter().find(|condition| !condition.holds(value));
        let Some(&condition) = broken else {
            return Some(value);
        };
        // A number that is not 0 but is rounded to 0 has a warning already. If it breaks the
        // field's condition, the error replaces the warning.
        let is_rounded = self.problems.len() > before && value == Value::Number(0.0);
        if is_rounded {
            self.problems.truncate(before);
        }
        let written = shorten(self.sources.text(tree.span));
        let found = match (&tree.kind, value) {
            _ if is_rounded => format!("{written}, which rounds to 0"),
            (ValueKind::Name(_) | ValueKind::Call(_) | ValueKind::Chain { .. }, value) => {
                match value {
                    Value::Number(number) => numbers::comparable(number, &[number.round()]),
                    Value::Angle(Angle {
                        degrees,
                        radians: 0.0,
                    }) => format!("{}deg", numbers::comparable(degrees, &[degrees.round()])),
                    _ => value.to_string(),
                }
            }
            _ => written,
        };
        let message = format!("`{}` must be {condition}, and it is {found}", row.name);
        let (allowed, applicability) = allowed(row, condition, value);
        error("out_of_range", message)
            .at(tree.span, "out of range")
            .help(format!("write, for example, `{} {allowed}`", row.name))
            .writing(tree.span, applicability, [allowed])
            .report(&mut self.problems);
        None
    }

    /// Reports a list as the value of a field that takes no list.
    fn unexpected_list(
        &mut self,
        row: &'static FieldRow,
        tree: &tree::Value<'s>,
        elements: &[Element<'s>],
    ) {
        for element in elements {
            if self.evaluate(&element.value, None).is_none() {
                return;
            }
        }
        let texts = elements.iter();
        let texts: Vec<&str> = texts.map(|it| self.sources.text(it.value.span)).collect();
        let meant = match (row.takes, texts.as_slice()) {
            (Type::Color, [r, g, b, _]) => Some(format!("rgb({r}, {g}, {b})")),
            // Two equal numbers were probably meant as one number, so one is suggested if the field
            // has a default. The value of a field without a default, such as `far`, depends on
            // other fields, so no number is suggested.
            (Type::Number, [first, second])
                if first == second && matches!(row.preset, Preset::Value(_)) =>
            {
                Some((*first).to_owned())
            }
            _ => None,
        };
        let meant = meant.map(|meant| (meant, Applicability::Unsafe));
        let problem = self
            .other_type(row, tree, "a list", meant)
            .at(tree.span, "a list");
        self.problems.push(problem);
    }

    /// Returns the method named `written`. If there is no such method, reports the name and returns
    /// `None`.
    fn method(&mut self, written: &str, tree: &tree::Value<'s>) -> Option<Value> {
        if let Some(method) = schema::method(written) {
            return Some(Value::Method(method));
        }
        let list = suggest::list(schema::method_names());
        let near = schema::nearest_method(written);
        let is_sure = near.is_some_and(|near| schema::is_sure_method(written, near));
        error("unknown_method", format!("there is no method `{written}`"))
            .at(tree.span, "not a method")
            .help(match near {
                Some(near) => format!("did you mean `{near}`? The methods are {list}."),
                None => format!("the methods are {list}"),
            })
            .writing(tree.span, Applicability::safe_if(is_sure), near)
            .report(&mut self.problems);
        None
    }

    /// Returns the error that a value has another type than its field.
    fn wrong_type(&mut self, row: &FieldRow, tree: &tree::Value<'s>, value: Value) -> Diagnostic {
        if let (Type::Angle, Value::Number(number)) = (row.takes, value) {
            let what = format!("`{}`", row.name);
            // A unit is offered only if the field's condition then holds: `fov 45rad` would be an
            // error.
            let fits = |unit: Unit| row.allows(Value::Angle(unit.of(number)));
            return self.evaluator().bare_angle(&what, tree, number, fits);
        }
        let meant = self.converted(row, tree, value);
        let label = self.evaluator().described(tree, value.kind());
        self.other_type(row, tree, value.kind().noun(), meant)
            .at(tree.span, label)
    }

    /// Returns a replacement for a value that has another type than the field, such as `30deg` for
    /// `30`, and whether replacing the value is safe. Returns `None` if the intended value is
    /// unknown.
    pub(super) fn converted(
        &mut self,
        row: &FieldRow,
        tree: &tree::Value<'s>,
        value: Value,
    ) -> Option<(String, Applicability)> {
        let text = self.sources.text(tree.span);
        let unsure = |text: String| (text, Applicability::Unsafe);
        match (row.takes, value, &tree.kind) {
            (Type::Angle, Value::Number(number), ValueKind::Number(_)) => {
                let [(unit, _), _] = self.evaluator().units(tree, number);
                let angle = Value::Angle(unit.of(number));
                row.allows(angle)
                    .then(|| unsure(format!("{text}{}", unit.name())))
            }
            (Type::Number, Value::Angle(_), ValueKind::Angle { number, .. }) => {
                let fits = row.allows(Value::Number(number.parse().ok()?));
                fits.then(|| unsure((*number).to_owned()))
            }
            (Type::Vector, Value::Number(_), ValueKind::Number(_))
                if row.must.contains(&Condition::EachMoreThanZero) =>
            {
                Some(unsure(format!("({text}, {text}, {text})")))
            }
            (Type::Color, Value::Vector(parts), _) => rgb(parts, tree, text),
            // A single colour is used for both kinds of squares.
            (Type::Colors, Value::Color(_), _) => Some(unsure(format!("({text}, {text})"))),
            _ => None,
        }
    }

    /// Returns the error that a value has another type than its field. `found` is the value's type
    /// in words, and `meant` the text to write instead, if that is known.
    fn other_type(
        &mut self,
        row: &FieldRow,
        tree: &tree::Value<'s>,
        found: &str,
        meant: Option<(String, Applicability)>,
    ) -> Diagnostic {
        let (name, takes) = (row.name, row.takes.noun());
        let written = self.evaluator().quoted(tree.span);
        let (meant, applicability) = meant.unzip();
        error(
            "wrong_type",
            format!("`{name}` is {takes}, and {written} is {found}"),
        )
        .help(match &meant {
            Some(meant) => format!("write `{}`", shorten(meant)),
            None => format!("write {takes}, such as `{}`", row.example),
        })
        .writing(
            tree.span,
            applicability.unwrap_or(Applicability::Unsafe),
            meant,
        )
    }

    /// Returns the value of an expression; `wanted` is the type that the context requires, if it is
    /// known. If the expression has errors, reports them and returns `None`.
    pub(super) fn evaluate(
        &mut self,
        value: &tree::Value<'s>,
        wanted: Option<Type>,
    ) -> Option<Value> {
        self.evaluator().value(value, wanted)
    }

    fn evaluator(&mut self) -> Evaluator<'_, 's> {
        Evaluator {
            sources: self.sources,
            names: &self.names,
            problems: &mut self.problems,
        }
    }
}

/// Returns a replacement that meets the broken `condition`, and the applicability of the fix. The
/// replacement is derived from `value` if possible; otherwise it is a placeholder.
fn allowed(row: &FieldRow, condition: Condition, value: Value) -> (String, Applicability) {
    let allowed = match (condition, value) {
        (Condition::Whole, Value::Number(number))
            if row.allows(Value::Number(number.round().max(1.0))) =>
        {
            let whole = number.round().max(1.0).to_string();
            return (whole, Applicability::Unsafe);
        }
        (Condition::MoreThan(bound), Value::Number(number)) if number < bound => {
            return (numbers::short(-number), Applicability::Unsafe);
        }
        (Condition::AtLeast(bound), _) => bound.to_string(),
        (Condition::AtMostTwoTo(power), _) => (1_u64 << power).to_string(),
        (Condition::LessThanTwoTo(power), _) => ((1_u64 << power) - 1).to_string(),
        _ => row.example.to_owned(),
    };
    (allowed, Applicability::Placeholder)
}

/// Returns the `rgb` call for a colour that was written as a vector. If a channel is greater than
/// 1, the channels are assumed to go from 0 to 255, and are used as they are. Otherwise, they are
/// assumed to go from 0 to 1, and are multiplied by 255. Returns `None` if a channel is negative or
/// greater than 255, or if a channel that must be multiplied is not a literal.
fn rgb(parts: DVec3, tree: &tree::Value<'_>, text: &str) -> Option<(String, Applicability)> {
    let ValueKind::Tuple(elements) = &tree.kind else {
        return None;
    };
    let is_literal = |element: &Element<'_>| matches!(element.value.kind, ValueKind::Number(_));
    if parts.min_element() < 0.0 || parts.max_element() > 255.0 {
        return None;
    }
    if parts.max_element() > 1.0 {
        return Some((format!("rgb{text}"), Applicability::Safe));
    }
    let bytes = parts.to_array().map(in_bytes).join(", ");
    let are_literals = elements.iter().all(is_literal);
    are_literals.then(|| (format!("rgb({bytes})"), Applicability::Unsafe))
}
