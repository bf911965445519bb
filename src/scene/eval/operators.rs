//! Signs and operators.

use super::Evaluator;
use crate::{
    diagnostic::{Edit, Fix},
    math::Angle,
    scene::{
        error::Problem,
        schema::Type,
        value::{self, Value},
    },
    source::Span,
    syntax::{
        shorten,
        tree::{self, Operator, Step, ValueKind},
    },
};

impl<'s> Evaluator<'_, 's> {
    pub(super) fn negation(&mut self, sign: Span, operand: &tree::Value<'s>) -> Option<Value> {
        let value = self.value(operand, None)?;
        let negative = value::negate(value);
        if negative.is_none() {
            let right_label = self.described(operand, value.kind());
            self.problems.push(
                Problem::OperandTypes {
                    message: format!("{} has no negative", value.kind().noun()),
                    help: "take the `-` away; only numbers, angles and vectors have a sign"
                        .to_owned(),
                    operator: sign,
                    left: None,
                    left_label: String::new(),
                    right: operand.span,
                    right_label,
                }
                .with([Fix::remove("take the `-` away", sign, self.sources)]),
            );
        }
        negative
    }

    pub(super) fn chain(
        &mut self,
        first: &tree::Value<'s>,
        rest: &[Step<'s>],
        wanted: Option<Type>,
    ) -> Option<Value> {
        // What an operation among others should give is not known.
        let wanted = wanted.filter(|_| rest.len() == 1);
        let mut left = self.value(first, None);
        let mut span = first.span;
        for (index, step) in rest.iter().enumerate() {
            let right = self.value(&step.operand, None);
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

    /// One operation; of the left operand its value, its place, and its tree if it is not a result itself.
    fn step(
        &mut self,
        step: &Step<'s>,
        (left, left_span, left_tree): (Value, Span, Option<&tree::Value<'s>>),
        right: Value,
        wanted: Option<Type>,
    ) -> Option<Value> {
        let Some(result) = value::operate(step.operator, left, right) else {
            let left_label = match left_tree {
                Some(tree) => self.described(tree, left.kind()),
                None => left.kind().noun().to_owned(),
            };
            let right_label = self.described(&step.operand, right.kind());
            let help = self.operand_help(step, (left, left_span), right);
            self.problems.push(
                Problem::OperandTypes {
                    message: cannot(step.operator, left.kind(), right.kind()),
                    help,
                    operator: step.sign,
                    left: Some(left_span),
                    left_label,
                    right: step.operand.span,
                    right_label,
                }
                .with(self.operand_fixes(
                    step,
                    (left, left_span, left_tree),
                    right,
                    wanted,
                )),
            );
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
        let problem = if by_zero {
            let written = shorten(self.sources.text(step.operand.span));
            let zero = matches!(&step.operand.kind, ValueKind::Number(_));
            Problem::NotFinite {
                message: "this divides by zero".to_owned(),
                help: match zero {
                    true => "divide by a number other than 0".to_owned(),
                    false => format!("make `{written}` other than 0; it is 0 here"),
                },
                span: step.sign,
                label: "the right side is 0".to_owned(),
            }
        } else {
            Problem::NotFinite {
                message: "the result of this is too large".to_owned(),
                help: "numbers go up to 1.7976931348623157e308".to_owned(),
                span: step.sign,
                label: "too large from here on".to_owned(),
            }
        };
        self.problems.push(problem);
        None
    }

    fn operand_help(&self, step: &Step<'s>, left: (Value, Span), right: Value) -> String {
        use Type::{Angle, Color, Colors, Number, Vector};
        let text = |span| shorten(self.sources.text(span));
        let (a, b) = (text(left.1), text(step.operand.span));
        let sign = step.operator.sign();
        let sum = matches!(step.operator, Operator::Add | Operator::Subtract);
        match (left.0.kind(), right.kind()) {
            (Color | Colors, _) | (_, Color | Colors) => {
                "colours are not computed with; `rgb(r, g, b)` takes computed numbers".to_owned()
            }
            (Vector, Number) if sum => format!(
                "add a vector, such as `{a} {sign} ({b}, {b}, {b})`, or scale it: `{a} * {b}`"
            ),
            (Number, Vector) if sum => format!(
                "write a vector, such as `({a}, {a}, {a}) {sign} {b}`, or scale it: `{a} * {b}`"
            ),
            (Vector, Vector) if step.operator == Operator::Multiply => {
                format!("write `dot({a}, {b})` for a number, or `cross({a}, {b})` for a vector")
            }
            (_, Vector) if step.operator == Operator::Divide => {
                format!("divide by a number, such as `length({b})`")
            }
            (Angle, Number) if sum => {
                let [first, second] = self.units(&step.operand);
                format!(
                    "give it a unit: `{a} {sign} {}` (or `{}`)",
                    first.shown, second.shown
                )
            }
            (Number, Angle) if sum => {
                format!("give {a} a unit: `{a}deg {sign} {b}` (or `{a}rad`)")
            }
            (Angle, Angle) => {
                format!("an angle divided by `1deg` is a number: `{a} * ({b} / 1deg)`")
            }
            (Number, Angle) => {
                format!("an angle divided by `1deg` is a number: `{a} / ({b} / 1deg)`")
            }
            _ => "only numbers, angles and vectors of one kind go together".to_owned(),
        }
    }

    /// What the help says, as edits: those that give what is wanted.
    fn operand_fixes(
        &self,
        step: &Step<'s>,
        (left, left_span, left_tree): (Value, Span, Option<&tree::Value<'s>>),
        right: Value,
        wanted: Option<Type>,
    ) -> Vec<Fix> {
        use Type::{Angle, Number, Vector};
        let sum = matches!(step.operator, Operator::Add | Operator::Subtract);
        let right_span = step.operand.span;
        let (a, b) = (self.sources.text(left_span), self.sources.text(right_span));
        let with_units = |number: &tree::Value<'s>| {
            let units = self.units(number);
            units
                .map(|unit| Fix::write(number.span, unit.text))
                .to_vec()
        };
        let three = |span, text: &str| Fix::write(span, format!("({text}, {text}, {text})"));
        // The factor takes what stands right before the sign: of several summands the last one.
        let scaled = left_tree.map(|_| {
            let title = format!("scale it: `{} * {}`", shorten(a), shorten(b));
            Fix::new(title, [Edit::new(step.sign, "*")])
        });
        let as_number = || Fix::write(right_span, format!("({b} / 1deg)"));
        let is_zero =
            value::operate(Operator::Divide, right, right).is_none_or(|one| !one.is_finite());
        let (gives, fixes) = match (left.kind(), right.kind(), step.operator) {
            (Angle, Number, _) if sum => (Angle, with_units(&step.operand)),
            (Number, Angle, _) if sum => (Angle, left_tree.map(with_units).unwrap_or_default()),
            (Vector, Number, _) if sum => {
                let fixes = [Some(three(right_span, b)), scaled];
                (Vector, fixes.into_iter().flatten().collect())
            }
            (Number, Vector, _) if sum => {
                let fixes = [Some(three(left_span, a)), scaled];
                (Vector, fixes.into_iter().flatten().collect())
            }
            (Vector, Vector, Operator::Multiply) => {
                let ways = [("dot", Number), ("cross", Vector)].into_iter();
                let ways = ways.filter(|(_, gives)| wanted.is_none_or(|wanted| wanted == *gives));
                let whole = left_span.to(right_span);
                // A comment between the two is not to be lost.
                let between = Span::new(whole.source, left_span.end, right_span.start);
                let ways = ways.filter(|_| self.sources.text(between).trim() == "*");
                let fixes = ways.map(|(name, _)| Fix::write(whole, format!("{name}({a}, {b})")));
                (wanted.unwrap_or(Vector), fixes.collect())
            }
            (given @ (Number | Angle | Vector), Vector, Operator::Divide)
                if !is_zero_vector(right) =>
            {
                (given, vec![Fix::write(right_span, format!("length({b})"))])
            }
            (Angle, Angle, Operator::Multiply) => (Angle, vec![as_number()]),
            (Number, Angle, Operator::Divide) if !is_zero => (Number, vec![as_number()]),
            _ => return Vec::new(),
        };
        let is_written_once = |text: &str| !text.contains(['\n', '\r']) && !text.contains("//");
        match wanted.is_none_or(|wanted| wanted == gives)
            && is_written_once(a)
            && is_written_once(b)
        {
            true => fixes,
            false => Vec::new(),
        }
    }
}

fn is_zero_vector(value: Value) -> bool {
    matches!(value, Value::Vector(v) if v == glam::DVec3::ZERO)
}

fn cannot(operator: Operator, left: Type, right: Type) -> String {
    let (a, b) = (left.noun(), right.noun());
    let both = match left == right {
        true => left.two().to_owned(),
        false => format!("{a} and {b}"),
    };
    match operator {
        Operator::Add => format!("{both} cannot be added"),
        Operator::Subtract => format!("{b} cannot be subtracted from {a}"),
        Operator::Multiply => format!("{both} cannot be multiplied"),
        Operator::Divide => format!("{a} cannot be divided by {b}"),
    }
}
