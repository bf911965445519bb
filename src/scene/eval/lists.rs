//! Vectors and pairs of colours.

use glam::DVec3;

use super::Evaluator;
use crate::{
    scene::{error::error, schema::Type, value::Value},
    source::Span,
    syntax::{
        shorten,
        tree::{self, Element},
    },
};

impl<'s> Evaluator<'_, 's> {
    pub(super) fn tuple(
        &mut self,
        elements: &[Element<'s>],
        span: Span,
        wanted: Option<Type>,
    ) -> Option<Value> {
        let part = match wanted {
            Some(Type::Colors) => Some(Type::Color),
            Some(Type::Vector) => Some(Type::Number),
            _ if elements.len() == 3 => Some(Type::Number),
            _ => None,
        };
        let mut values = Vec::with_capacity(elements.len());
        for element in elements {
            values.push(self.value(&element.value, part));
        }
        if let &[
            Some(Value::Number(x)),
            Some(Value::Number(y)),
            Some(Value::Number(z)),
        ] = values.as_slice()
        {
            return Some(Value::Vector(DVec3::new(x, y, z)));
        }
        if let &[Some(Value::Color(first)), Some(Value::Color(second))] = values.as_slice() {
            return Some(Value::Colors([first, second]));
        }
        let is_color = |value: &Value| value.kind() == Type::Color;
        let is_pair = wanted == Some(Type::Colors)
            || (elements.len() == 2 && values.iter().flatten().any(is_color));
        let takes = if is_pair { Type::Color } else { Type::Number };
        let mut wrong = values.iter().zip(elements);
        let wrong = wrong.find_map(|(value, element)| {
            let value = value.filter(|value| value.kind() != takes)?;
            Some((&element.value, value.kind()))
        });
        if let Some((part, found)) = wrong {
            self.wrong_part(part, found, is_pair);
        } else if values.iter().all(Option::is_some) {
            self.part_count(elements, span, wanted, is_pair);
        }
        None
    }

    /// Reports a part of a vector that is no number, or of a pair that is no colour.
    fn wrong_part(&mut self, part: &tree::Value<'s>, found: Type, is_pair: bool) {
        let (parts, help) = match (is_pair, found) {
            (true, _) => (
                "a pair of colours are colours",
                "write two colours, such as `(gray, white)`",
            ),
            (false, Type::Angle) => (
                "a vector are numbers",
                "an angle divided by `1deg` is a number",
            ),
            (false, _) => (
                "a vector are numbers",
                "write three numbers, such as `(0, 1, 0)`",
            ),
        };
        let written = self.quoted(part.span);
        let message = format!("the parts of {parts}, and {written} is {}", found.noun());
        self.problems.push(
            error("part_type", message)
                .at(part.span, self.described(part, found))
                .help(help),
        );
    }

    fn part_count(
        &mut self,
        elements: &[Element<'s>],
        span: Span,
        wanted: Option<Type>,
        is_pair: bool,
    ) {
        let texts = elements.iter();
        let texts: Vec<&str> = texts.map(|it| self.sources.text(it.value.span)).collect();
        let (whole, parts, example) = match is_pair {
            true => (
                "a pair of colours has 2 parts",
                "colours",
                "two colours, such as `(gray, white)`",
            ),
            false => (
                "a vector has 3 parts",
                "numbers",
                "three numbers, such as `(0, 1, 0)`",
            ),
        };
        let meant = match texts.as_slice() {
            _ if is_pair => None,
            &[x, y] if wanted == Some(Type::Vector) => {
                third(x, y).map(|z| format!("({x}, {y}, {z})"))
            }
            [_, _, _, _] => with_decimal_comma(elements, &texts),
            _ => None,
        };
        let count = elements.len();
        self.problems.push(
            error("part_count", format!("{whole}, and this has {count}"))
                .at(span, format!("{count} {parts}"))
                .help(match &meant {
                    Some(meant) if elements.len() == 4 => {
                        format!("write `{}`: a decimal point is a point", shorten(meant))
                    }
                    Some(meant) => format!("write a third number, such as `{}`", shorten(meant)),
                    None => format!("write {example}"),
                })
                .writing(span, meant),
        );
    }
}

/// A third number behind two that are written out: the greater one of them, with which sides form a triangle, but not 0, with which there
/// might be no direction.
fn third<'t>(x: &'t str, y: &'t str) -> Option<&'t str> {
    let (a, b): (f64, f64) = (x.parse().ok()?, y.parse().ok()?);
    Some(match (a > b, a == 0.0 && b == 0.0) {
        (_, true) => "1",
        (true, _) => x,
        (false, _) => y,
    })
}

/// The vector of four numbers, if one of the commas stands for a decimal point: the only one without a blank behind it.
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
