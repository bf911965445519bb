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
            // What is added to something is of its type.
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
            let (help, fixes) = self.ways(step, (left, left_span, left_tree), right, wanted);
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
                .with(fixes),
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

    /// What to do about operands that do not go together: in words, and as edits of those that give what is wanted.
    fn ways(
        &self,
        step: &Step<'s>,
        (left, left_span, left_tree): (Value, Span, Option<&tree::Value<'s>>),
        right: Value,
        wanted: Option<Type>,
    ) -> (String, Vec<Fix>) {
        use Type::{Angle, Color, Colors, Number, Vector};
        let (left_text, right_text) = (
            self.sources.text(left_span),
            self.sources.text(step.operand.span),
        );
        let (a, b) = (shorten(left_text), shorten(right_text));
        let (operator, sign) = (step.operator, step.operator.sign());
        let is_sum = matches!(operator, Operator::Add | Operator::Subtract);
        let units = |number: &tree::Value<'s>| {
            let units = self.units(number);
            units
                .map(|unit| Fix::write(number.span, unit.text))
                .to_vec()
        };
        // The factor takes what stands right before the sign: of several summands the last one.
        let scaled = left_tree.map(|_| {
            let title = format!("scale it: `{a} * {b}`");
            Fix::new(title, [Edit::new(step.sign, "*")])
        });
        let vector = |span, text: &str| Fix::write(span, format!("({text}, {text}, {text})"));
        let on_right = |text: String| vec![Fix::write(step.operand.span, text)];
        let as_number = || on_right(format!("({right_text} / 1deg)"));
        let is_zero =
            value::operate(Operator::Divide, right, right).is_none_or(|one| !one.is_finite());
        let (help, gives, fixes) = match (left.kind(), right.kind(), operator) {
            (Color | Colors, _, _) | (_, Color | Colors, _) => {
                let help = "colours are not computed with; `rgb(r, g, b)` takes computed numbers";
                return (help.to_owned(), Vec::new());
            }
            (Vector, Number, _) if is_sum => (
                format!(
                    "add a vector, such as `{a} {sign} ({b}, {b}, {b})`, or scale it: `{a} * {b}`"
                ),
                Vector,
                [vector(step.operand.span, right_text)]
                    .into_iter()
                    .chain(scaled)
                    .collect(),
            ),
            (Number, Vector, _) if is_sum => (
                format!(
                    "write a vector, such as `({a}, {a}, {a}) {sign} {b}`, or scale it: `{a} * {b}`"
                ),
                Vector,
                [vector(left_span, left_text)]
                    .into_iter()
                    .chain(scaled)
                    .collect(),
            ),
            (Vector, Vector, Operator::Multiply) => {
                let whole = left_span.to(step.operand.span);
                // A comment between the two is not to be lost.
                let between = Span::new(whole.source, left_span.end, step.operand.span.start);
                let is_bare = self.sources.text(between).trim() == "*";
                let ways = [("dot", Number), ("cross", Vector)].into_iter();
                let ways = ways
                    .filter(|(_, gives)| is_bare && wanted.is_none_or(|wanted| wanted == *gives));
                let fixes = ways.map(|(name, _)| {
                    Fix::write(whole, format!("{name}({left_text}, {right_text})"))
                });
                (
                    format!(
                        "write `dot({a}, {b})` for a number, or `cross({a}, {b})` for a vector"
                    ),
                    wanted.unwrap_or(Vector),
                    fixes.collect(),
                )
            }
            (given, Vector, Operator::Divide) => {
                let is_zero = right == Value::Vector(glam::DVec3::ZERO);
                let length = on_right(format!("length({right_text})"));
                (
                    format!("divide by a number, such as `length({b})`"),
                    given,
                    if is_zero { Vec::new() } else { length },
                )
            }
            (Angle, Number, _) if is_sum => {
                let [first, second] = self.units(&step.operand).map(|unit| unit.shown);
                (
                    format!("give it a unit: `{a} {sign} {first}` (or `{second}`)"),
                    Angle,
                    units(&step.operand),
                )
            }
            (Number, Angle, _) if is_sum => (
                format!("give {a} a unit: `{a}deg {sign} {b}` (or `{a}rad`)"),
                Angle,
                left_tree.map(units).unwrap_or_default(),
            ),
            (Angle, Angle, _) => (
                format!("an angle divided by `1deg` is a number: `{a} * ({b} / 1deg)`"),
                Angle,
                as_number(),
            ),
            (Number, Angle, _) => (
                format!("an angle divided by `1deg` is a number: `{a} / ({b} / 1deg)`"),
                Number,
                if is_zero { Vec::new() } else { as_number() },
            ),
            _ => {
                let help = "only numbers, angles and vectors of one kind go together";
                return (help.to_owned(), Vec::new());
            }
        };
        let is_written_once = |text: &str| !text.contains(['\n', '\r']) && !text.contains("//");
        let fits = wanted.is_none_or(|wanted| wanted == gives)
            && is_written_once(left_text)
            && is_written_once(right_text);
        (help, if fits { fixes } else { Vec::new() })
    }
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
