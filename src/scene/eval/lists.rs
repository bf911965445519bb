//! Vectors and pairs of colours.

use glam::DVec3;

use super::{Evaluator, calls::is_whole};
use crate::{
    scene::{error::Problem, fix, schema::Type, value::Value},
    source::Span,
    syntax::{shorten, tree::Element},
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
        let colors = values.iter().flatten().any(|v| v.kind() == Type::Color);
        let pair = match elements.len() {
            2 => colors || wanted == Some(Type::Colors),
            _ => wanted == Some(Type::Colors),
        };
        self.wrong_part(elements, &values, pair);
        let fits = elements.len() == if pair { 2 } else { 3 };
        if !fits && values.iter().all(Option::is_some) {
            let kinds = if pair { Type::Color } else { Type::Number };
            if values.iter().flatten().all(|value| value.kind() == kinds) {
                self.tuple_size(elements, span, wanted, pair);
            }
        }
        None
    }

    /// Reports the first part of a vector that is no number, or of a pair that is no colour.
    fn wrong_part(&mut self, elements: &[Element<'s>], values: &[Option<Value>], pair: bool) {
        let (whole, parts, takes) = match pair {
            true => ("a pair of colours", "colours", Type::Color),
            false => ("a vector", "numbers", Type::Number),
        };
        let wrong = |value: &Option<Value>| value.is_some_and(|v| v.kind() != takes);
        let found = values.iter().zip(elements).find(|(value, _)| wrong(value));
        let Some((&Some(value), element)) = found else {
            return;
        };
        let help = match (pair, value.kind()) {
            (true, _) => "write two colours, such as `(gray, white)`",
            (false, Type::Vector) => "write `v + w` to add vectors; a vector has no parts to name",
            (false, Type::Angle) => "an angle divided by `1deg` is a number",
            _ => "write three numbers, such as `(0, 1, 0)`",
        };
        let label = self.described(&element.value, value.kind());
        let written = self.quoted(element.value.span);
        self.problems.push(Problem::PartType {
            whole,
            parts,
            written,
            found: value.kind().noun(),
            help: help.to_owned(),
            span: element.value.span,
            label,
        });
    }

    /// The vector of four numbers, if one of the commas stands for a decimal point: the only one without a blank behind it.
    fn with_decimal_comma(&self, elements: &[Element<'s>]) -> Option<String> {
        let text = |element: &Element<'s>| self.sources.text(element.value.span);
        let is_tight = |pair: &[Element<'s>]| match pair {
            [one, other] => one.value.span.end + 1 == other.value.span.start,
            _ => false,
        };
        let mut tight = elements
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| is_tight(pair));
        let (Some((at, _)), None) = (tight.next(), tight.next()) else {
            return None;
        };
        let mut parts: Vec<String> = elements
            .iter()
            .map(|element| text(element).to_owned())
            .collect();
        let fraction = parts.remove(at + 1);
        let whole = parts.get_mut(at)?;
        let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
        if !is_digits(whole.trim_start_matches('-')) || !is_digits(&fraction) {
            return None;
        }
        *whole += &format!(".{fraction}");
        Some(format!("({})", parts.join(", ")))
    }

    fn tuple_size(
        &mut self,
        elements: &[Element<'s>],
        span: Span,
        takes: Option<Type>,
        pair: bool,
    ) {
        let parts = |count: usize| match count {
            0 => "none".to_owned(),
            1 => "one".to_owned(),
            2 => "two".to_owned(),
            3 => "three".to_owned(),
            4 => "four".to_owned(),
            5 => "five".to_owned(),
            count => count.to_string(),
        };
        let texts: Vec<String> = elements
            .iter()
            .map(|element| shorten(self.sources.text(element.value.span)))
            .collect();
        let wanted = if pair { 2 } else { 3 };
        let joined = match texts.len() {
            4 if !pair => self.with_decimal_comma(elements),
            _ => None,
        };
        let instead = match (texts.get(..wanted), texts.as_slice()) {
            _ if !texts.iter().all(|text| is_whole(text)) => Vec::new(),
            _ if joined.is_some() => joined.iter().cloned().collect(),
            // Whether it is to be a vector at all is not known.
            _ if !pair && takes != Some(Type::Vector) => Vec::new(),
            (Some(kept), _) => vec![format!("({})", kept.join(", "))],
            (None, []) if pair => vec!["(gray, white)".to_owned()],
            (None, []) => vec!["(0, 1, 0)".to_owned()],
            (None, [x, y]) => vec![format!("({x}, {y}, 1)")],
            (None, _) => Vec::new(),
        };
        if pair {
            self.problems.push(
                Problem::PartCount {
                    whole: "a pair of colours has two parts",
                    count: parts(elements.len()),
                    help: match texts.as_slice() {
                        [first, second, ..] => format!("write `({first}, {second})`"),
                        _ => "write two colours, such as `(gray, white)`".to_owned(),
                    },
                    span,
                    label: format!("{} colours", parts(elements.len())),
                }
                .with(fix::instead(span, instead)),
            );
            return;
        }
        let help = match texts.as_slice() {
            [] => "write three numbers, such as `(0, 1, 0)`".to_owned(),
            [x, y] => format!("write a third number, such as `({x}, {y}, 1)`"),
            [x, y, z, ..] => match &joined {
                Some(vector) => format!("write `{vector}`: a decimal point is a point"),
                None => format!("write `({x}, {y}, {z})`"),
            },
            [x] => format!("write `({x}, {x}, {x})`"),
        };
        self.problems.push(
            Problem::PartCount {
                whole: "a vector has three parts",
                count: parts(elements.len()),
                help,
                span,
                label: match elements.len() {
                    0 => "nothing".to_owned(),
                    count => format!("{} numbers", parts(count)),
                },
            }
            .with(fix::instead(span, instead)),
        );
    }
}
