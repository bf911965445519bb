//! Evaluates lists: vectors, and pairs and triples of colours.

use glam::DVec3;

use super::evaluator::Evaluator;
use crate::{
    diagnostic::Applicability,
    scene::error::error,
    schema::{Type, Value},
    source::Span,
    syntax::{
        shorten,
        tree::{self, Element},
    },
};

impl<'s> Evaluator<'_, 's> {
    /// Returns the value of a list. If the list has errors, reports them and returns `None`.
    pub(super) fn tuple(
        &mut self,
        elements: &[Element<'s>],
        span: Span,
        wanted: Option<Type>,
    ) -> Option<Value> {
        let part = match wanted.and_then(Type::parts) {
            Some((part, _)) => Some(part),
            None if elements.len() == 3 => Some(Type::Number),
            None => None,
        };
        let values = elements.iter().map(|it| self.value(&it.value, part));
        let values: Vec<Option<Value>> = values.collect();
        match values[..] {
            [
                Some(Value::Number(x)),
                Some(Value::Number(y)),
                Some(Value::Number(z)),
            ] => {
                return Some(Value::Vector(DVec3::new(x, y, z)));
            }
            [Some(Value::Color(first)), Some(Value::Color(second))] => {
                return Some(Value::Colors([first, second]));
            }
            [
                Some(Value::Color(x)),
                Some(Value::Color(y)),
                Some(Value::Color(z)),
            ] if wanted != Some(Type::Colors) => return Some(Value::FaceColors([x, y, z])),
            _ => {}
        }
        let is_color = |value: &Value| value.kind() == Type::Color;
        let is_pair = elements.len() == 2 && values.iter().flatten().any(is_color);
        let list = match wanted {
            _ if is_pair => Type::Colors,
            Some(list @ (Type::Colors | Type::FaceColors)) => list,
            _ => Type::Vector,
        };
        let (part, _) = list.parts()?;
        let mut found = values.iter().zip(elements);
        let wrong = found.find_map(|(value, element)| {
            let value = value.filter(|value| value.kind() != part)?;
            Some((&element.value, value.kind()))
        });
        if let Some((written, found)) = wrong {
            self.wrong_part(list, written, found);
        } else if values.iter().all(Option::is_some) {
            self.part_count(list, elements, span, wanted);
        }
        None
    }

    /// Reports that the element `part` of a list has the wrong type `found`.
    fn wrong_part(&mut self, list: Type, part: &tree::Value<'s>, found: Type) {
        let parts = list
            .parts()
            .map(|(part, _)| part.plural())
            .unwrap_or_default();
        let (written, noun) = (self.quoted(part.span), found.noun());
        let message = format!(
            "the parts of {} are {parts}, and {written} is {noun}",
            list.noun()
        );
        error("part_type", message)
            .at(part.span, self.described(part, found))
            .help(match (list, found) {
                (Type::Vector, Type::Angle) => "an angle divided by `1deg` is a number",
                _ => list.such_as(),
            })
            .report(self.problems);
    }

    /// Reports a list with a wrong number of elements.
    fn part_count(
        &mut self,
        list: Type,
        elements: &[Element<'s>],
        span: Span,
        wanted: Option<Type>,
    ) {
        let texts = elements.iter().map(|it| self.sources.text(it.value.span));
        let texts: Vec<&str> = texts.collect();
        let (meant, applicability) = match texts[..] {
            [x, y] if list == Type::Vector && wanted == Some(list) => {
                let meant = third(x, y).map(|z| format!("({x}, {y}, {z})"));
                (meant, Applicability::Placeholder)
            }
            [_, _, _, _] if list == Type::Vector => {
                (with_decimal_comma(elements, &texts), Applicability::Unsafe)
            }
            _ => (None, Applicability::Unsafe),
        };
        let Some((part, most)) = list.parts() else {
            return;
        };
        let (noun, count) = (list.noun(), elements.len());
        let message = format!("{noun} has {most} parts, and this has {count}");
        let help = match &meant {
            Some(meant) if count == 4 => {
                format!("write `{}`: a decimal point is a point", shorten(meant))
            }
            Some(meant) => format!("write a third number, such as `{}`", shorten(meant)),
            None if count > 4 => format!(
                "{}; the language has no other lists: a block stands for each value, or `for` in its head computes them",
                list.such_as()
            ),
            None => list.such_as().to_owned(),
        };
        error("part_count", message)
            .at(span, format!("{count} {}", part.plural()))
            .help(help)
            .writing(span, applicability, meant)
            .report(self.problems);
    }
}

/// Returns an example for the missing third coordinate of a vector whose other coordinates are `x`
/// and `y`: the greater of `x` and `y`, or 1 if both are 0, because a zero vector has no direction.
/// If the vector is the `sides` of a triangle, this choice makes a triangle of any two positive
/// lengths. Returns `None` if `x` or `y` is not a number.
fn third<'t>(x: &'t str, y: &'t str) -> Option<&'t str> {
    let (a, b): (f64, f64) = (x.parse().ok()?, y.parse().ok()?);
    Some(match (a > b, a == 0.0 && b == 0.0) {
        (_, true) => "1",
        (true, _) => x,
        (false, _) => y,
    })
}

/// Interprets four numbers as a vector in which one number was written with a decimal comma, as in
/// `(1,5, 2, 3)`. The decimal comma is the only comma without a space after it. Returns `None` if
/// there is no such comma, or more than one.
fn with_decimal_comma(elements: &[Element<'_>], texts: &[&str]) -> Option<String> {
    let is_tight = |pair: &[Element<'_>]| match pair {
        [one, other] => one.value.span.end + 1 == other.value.span.start,
        _ => false,
    };
    let pairs = elements.windows(2).enumerate();
    let mut tight = pairs.filter(|(_, pair)| is_tight(pair));
    let (Some((at, _)), None) = (tight.next(), tight.next()) else {
        return None;
    };
    let mut parts: Vec<String> = texts.iter().map(|text| (*text).to_owned()).collect();
    let fraction = parts.remove(at + 1);
    let whole = parts.get_mut(at)?;
    let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if !is_digits(whole.trim_start_matches('-')) || !is_digits(&fraction) {
        return None;
    }
    *whole += &format!(".{fraction}");
    Some(format!("({})", parts.join(", ")))
}
