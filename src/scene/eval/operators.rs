//! Evaluates negations and binary operators.

use super::evaluator::{Evaluator, LARGEST};
use crate::{
    diagnostic::Fix,
    math::Angle,
    scene::{error::error, value},
    schema::{Type, Value},
    source::Span,
    syntax::{
        shorten,
        tree::{self, Operator, Step, Unit, ValueKind},
    },
};

/// Left operand of an operator: its value, its span, and its tree. There is no tree if the operand
/// is itself the result of an operator.
type Left<'t, 's> = (Value, Span, Option<&'t tree::Value<'s>>);

impl<'s> Evaluator<'_, 's> {
    /// Returns the negative of a value. If values of its type, such as colours, have no negative,
    /// reports an error and returns `None`.
    pub(super) fn negation(&mut self, sign: Span, operand: &tree::Value<'s>) -> Option<Value> {
        let value = self.value(operand, None)?;
        let negative = value::negate(value);
        if negative.is_none() {
            let message = format!("{} has no negative", value.kind().noun());
            error("operand_types", message)
                .at(sign, "here")
                .at(operand.span, self.described(operand, value.kind()))
                .help("take the `-` away; only numbers, angles and vectors have a sign")
                .fixes([Fix::remove("take the `-` away", sign, self.sources).safe()])
                .report(self.problems);
        }
        negative
    }

    /// Returns the result of operators of one precedence, applied from left to right. If an operand
    /// or an operator has an error, reports it and returns `None`.
    pub(super) fn chain(
        &mut self,
        first: &tree::Value<'s>,
        rest: &[Step<'s>],
        wanted: Option<Type>,
    ) -> Option<Value> {
        // `wanted` is the type of the whole result. With several operators, an intermediate result
        // may have any type, so `wanted` is not used.
        let wanted = wanted.filter(|_| rest.len() == 1);
        let mut left = self.value(first, None);
        let mut span = first.span;
        for (index, step) in rest.iter().enumerate() {
            // Both operands of a sum have the same type, so the right operand should have the type
            // of the left one.
            let alike = left.filter(|_| !step.operator.is_of_product());
            let right = self.value(&step.operand, alike.map(|left| left.kind()));
            left = match (left, right) {
                (Some(a), Some(b)) => {
                    let named = (index == 0).then_some(first);
                    self.step(step, (a, span, named), b, wanted)
                }
                _ => None,
            };
            span = span.to(step.operand.span);
        }
        left
    }

    /// Returns the result of one operator. If it has no result, reports an error and returns
    /// `None`.
    fn step(
        &mut self,
        step: &Step<'s>,
        left: Left<'_, 's>,
        right: Value,
        wanted: Option<Type>,
    ) -> Option<Value> {
        let Some(result) = value::operate(step.operator, left.0, right) else {
            self.operand_types(step, left, right, wanted);
            return None;
        };
        if result.is_finite() {
            return Some(result);
        }
        let by_zero = step.operator == Operator::Divide
            && matches!(
                right,
                Value::Number(0.0)
                    | Value::Angle(Angle {
                        degrees: 0.0,
                        radians: 0.0
                    })
            );
        let (message, label, help) = match (by_zero, &step.operand.kind) {
            (false, _) => (
                "the result of this is too large",
                "too large from here on",
                LARGEST.to_owned(),
            ),
            (true, ValueKind::Number(_)) => (
                "this divides by zero",
                "the right side is 0",
                "divide by a number other than 0".to_owned(),
            ),
            (true, _) => {
                let written = shorten(self.sources.text(step.operand.span));
                let help = format!("make `{written}` other than 0; it is 0 here");
                ("this divides by zero", "the right side is 0", help)
            }
        };
        self.problems
            .push(error("not_finite", message).at(step.sign, label).help(help));
        None
    }

    /// Reports operands whose types the operator does not accept. A fix is offered only if its
    /// result has the wanted type.
    fn operand_types(
        &mut self,
        step: &Step<'s>,
        (left, left_span, left_tree): Left<'_, 's>,
        right: Value,
        wanted: Option<Type>,
    ) {
        use Type::{Angle, Color, Colors, FaceColors, Number, Vector};
        let right_span = step.operand.span;
        let [left_text, right_text] = [left_span, right_span].map(|span| self.sources.text(span));
        let [a, b] = [left_text, right_text].map(shorten);
        let sign = step.operator.sign();
        let is_sum = !step.operator.is_of_product();
        let values = (left, right);
        let (left, right) = (left.kind(), right.kind());
        let help = match (left, right, step.operator) {
            (Color | Colors | FaceColors, _, _) | (_, Color | Colors | FaceColors, _) => {
                "colours are not computed with; `rgb(r, g, b)` takes computed numbers".to_owned()
            }
            (Vector, Number, _) if is_sum => format!(
                "add a vector, such as `{a} {sign} ({b}, {b}, {b})`, or scale it: `{a} * {b}`"
            ),
            (Number, Vector, _) if is_sum => format!(
                "write a vector, such as `({a}, {a}, {a}) {sign} {b}`, or scale it: `{a} * {b}`"
            ),
            (Vector, Vector, Operator::Multiply) => {
                format!("write `dot({a}, {b})` for a number, or `cross({a}, {b})` for a vector")
            }
            (_, Vector, Operator::Divide) => {
                format!("divide by a number, such as `length({b})`")
            }
            (Angle, Number, _) | (Number, Angle, _) if is_sum => {
                "give the number a unit, such as `30deg`".to_owned()
            }
            (Angle | Number, Angle, _) => {
                format!("an angle divided by `1deg` is a number: `{a} {sign} ({b} / 1deg)`")
            }
            _ => "only numbers, angles and vectors of one kind go together".to_owned(),
        };
        let vector = |span, text: &str| vec![Fix::write(span, format!("({text}, {text}, {text})"))];
        // The operand without a unit was more likely meant in the unit of the other operand, so the
        // fix with this unit comes first.
        let with_unit = |tree: &tree::Value<'s>, value: Value, other: Value| match (value, other) {
            (Value::Number(number), Value::Angle(angle)) if self.set_in(tree).is_none() => {
                let mut units = self.units(tree, number);
                let is_first = match units[0].0 {
                    Unit::Degrees => angle.degrees != 0.0,
                    Unit::Radians => angle.radians != 0.0,
                };
                if !is_first {
                    units.reverse();
                }
                units.map(|(_, fix)| fix).into()
            }
            _ => Vec::new(),
        };
        let fits = |gives| is_sum && wanted.is_none_or(|wanted| wanted == gives);
        let fixes = match (left, right) {
            (Vector, Number) if fits(Vector) => vector(right_span, right_text),
            (Number, Vector) if fits(Vector) => vector(left_span, left_text),
            (Angle, Number) if fits(Angle) => with_unit(&step.operand, values.1, values.0),
            (Number, Angle) if fits(Angle) => left_tree
                .map(|tree| with_unit(tree, values.0, values.1))
                .unwrap_or_default(),
            _ => Vec::new(),
        };
        let left_label = match left_tree {
            Some(tree) => self.described(tree, left),
            None => left.noun().to_owned(),
        };
        error("operand_types", cannot(step.operator, left, right))
            .at(step.sign, "here")
            .at(left_span, left_label)
            .at(right_span, self.described(&step.operand, right))
            .help(help)
            .fixes(fixes)
            .report(self.problems);
    }
}

/// Returns the message that `operator` does not accept operands of the types `left` and `right`.
fn cannot(operator: Operator, left: Type, right: Type) -> String {
    let (a, b) = (left.noun(), right.noun());
    let both = if left == right {
        format!("two {}", left.plural())
    } else {
        format!("{a} and {b}")
    };
    match operator {
        Operator::Add => format!("{both} cannot be added"),
        Operator::Subtract => format!("{b} cannot be subtracted from {a}"),
        Operator::Multiply => format!("{both} cannot be multiplied"),
        Operator::Divide => format!("{a} cannot be divided by {b}"),
    }
}
