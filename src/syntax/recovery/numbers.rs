//! Numbers, with what people write behind them.

use super::Recovery;
use crate::{
    schema::Type,
    source::Span,
    syntax::{
        Problem,
        fix::Way,
        messages::{angle_unit, metres, scaled, shorten},
        tokens::{TokenKind, numeric_part},
        tree::{Unit, Value, ValueKind, bad, number},
    },
};

impl<'s> Recovery<'_, 's> {
    /// A number, with its unit if it has one.
    pub(super) fn number(&mut self) -> Value<'s> {
        let written = self.word(0);
        let span = self.bump();
        let digits = numeric_part(written);
        let unit = written.get(digits.len()..).unwrap_or_default();
        match unit {
            "deg" | "rad" => {}
            "" => {
                if let Some(value) = self.apart_unit(digits, span) {
                    return value;
                }
            }
            _ => return self.odd_number(written, digits, span),
        }
        Value {
            kind: number(written),
            span,
        }
    }

    /// A unit that stands apart from its number, or a sign for one.
    fn apart_unit(&mut self, digits: &'s str, number: Span) -> Option<Value<'s>> {
        let unit = self.word(0);
        let is_apart = self.kind(0) == TokenKind::Name && !self.is_on_new_line(0);
        let is_taken = self.is_field_name(unit) || self.words.is_let(unit);
        if unit == "°" || (is_apart && !is_taken && angle_unit(unit).is_some() && unit.len() > 2) {
            let (factor, right) = angle_unit(unit)?;
            let span = self.bump();
            let whole = number.to(span);
            let way = match self.takes_angle() {
                true => Way::replace(whole, format!("{}{right}", scaled(digits, factor)?)),
                false => Way::told(format!("write an angle as `{digits}{right}`")),
            };
            let unit = if right == "deg" {
                Unit::Degrees
            } else {
                Unit::Radians
            };
            let is_right = matches!(self.written(span), "deg" | "rad");
            self.problems.push(match self.written(span) {
                "°" => Problem::BadNumber {
                    written: format!("{digits}°"),
                    span,
                    label: "`°` is no unit".to_owned(),
                    way,
                },
                _ => Problem::SpacedUnit {
                    span: if is_right { whole } else { span },
                    way,
                },
            });
            let kind = match factor == 1.0 {
                true => ValueKind::Angle {
                    number: digits,
                    unit,
                },
                false => ValueKind::Bad,
            };
            return Some(Value { kind, span: whole });
        }
        if is_apart && !is_taken && metres(unit).is_some() {
            let span = self.bump();
            let written = format!("{digits}{unit}");
            return Some(self.length(&written, digits, unit, number.to(span), span));
        }
        None
    }

    fn takes_angle(&self) -> bool {
        matches!(self.within.takes, None | Some(Type::Angle))
    }

    /// A number with a unit of length: all lengths are in metres.
    fn length(
        &mut self,
        written: &str,
        digits: &str,
        unit: &str,
        whole: Span,
        span: Span,
    ) -> Value<'s> {
        let way = match (metres(unit), self.within.takes) {
            (Some(factor), None | Some(Type::Number)) => match scaled(digits, factor) {
                Some(right) => {
                    let mut way = Way::replace(whole, &right);
                    if !matches!(unit, "px" | "pixel" | "pixels") {
                        way.note = "; all lengths are in metres";
                    }
                    way
                }
                None => Way::told("all lengths are in metres, and written without a unit"),
            },
            _ => Way::told("only angles have a unit, such as `30deg`"),
        };
        self.problems.push(Problem::BadNumber {
            written: shorten(written),
            span,
            label: format!("`{unit}` is no unit; only angles have one"),
            way,
        });
        bad(whole)
    }

    /// What starts as a number does and is none.
    fn odd_number(&mut self, written: &'s str, digits: &'s str, span: Span) -> Value<'s> {
        let unit = written.get(digits.len()..).unwrap_or_default();
        let unit_span = Span::new(span.source, span.start + digits.len(), span.end);
        if metres(unit).is_some() && !self.words.is_let(unit) {
            return self.length(written, digits, unit, span, unit_span);
        }
        let takes = self.within.takes;
        let hex = written.strip_prefix("0x").unwrap_or(written);
        let is_hex = hex.len() == 6 && hex.bytes().all(|digit| digit.is_ascii_hexdigit());
        let (label, way, place) = if let Some((factor, right)) = angle_unit(unit) {
            let way = match scaled(digits, factor).filter(|_| self.takes_angle()) {
                Some(number) => Way::replace(span, format!("{number}{right}")),
                None => Way::told(format!("write an angle as `30{right}`")),
            };
            (format!("`{unit}` is no unit"), way, unit_span)
        } else if self.words.is_factor(unit) {
            let way = match takes {
                None | Some(Type::Number) => Way::replace(span, format!("{digits} * {unit}")),
                _ => Way::told(format!("write an operator, such as `{digits} * {unit}`")),
            };
            (
                "an operator is missing before this".to_owned(),
                way,
                unit_span,
            )
        } else if is_hex && takes == Some(Type::Color) {
            let way = Way::replace(span, format!("#{hex}"));
            (
                "the digits of a colour stand behind a `#`".to_owned(),
                way,
                span,
            )
        } else if let Some(way) = self.sizes(written, span) {
            ("`x` is no operator".to_owned(), way, span)
        } else if unit.eq_ignore_ascii_case("e") {
            let way = Way::told(format!("write the exponent, such as `{digits}e3`"));
            (
                "the digits of the exponent are missing".to_owned(),
                way,
                unit_span,
            )
        } else if unit.starts_with('_') || unit.ends_with('_') {
            let tight = written.replace('_', "");
            let way = match numeric_part(&tight) == tight {
                true => Way::replace(span, tight),
                false => Way::told("write each `_` between two digits, such as `1_000`"),
            };
            ("a `_` stands between two digits only".to_owned(), way, span)
        } else {
            let way = Way::told("write a number such as `2`, `0.5` or `1e-3`");
            let place = if unit.starts_with('.') {
                span
            } else {
                unit_span
            };
            ("not a part of a number".to_owned(), way, place)
        };
        self.problems.push(Problem::BadNumber {
            written: shorten(written),
            span: place,
            label,
            way,
        });
        bad(span)
    }

    /// `0.5x1.5x2` and `4x4`.
    fn sizes(&self, written: &str, span: Span) -> Option<Way> {
        let parts: Vec<&str> = written.split(['x', 'X']).collect();
        let are_numbers = parts
            .iter()
            .all(|part| !part.is_empty() && numeric_part(part) == *part);
        match (parts.as_slice(), self.within.takes) {
            ([_, _, _], None | Some(Type::Vector)) if are_numbers => {
                Some(Way::replace(span, format!("({})", parts.join(", "))))
            }
            ([a, b], Some(Type::Number)) if are_numbers => {
                let product = a.parse::<f64>().ok()? * b.parse::<f64>().ok()?;
                Some(Way::replace(span, format!("{product}")))
            }
            _ => None,
        }
    }
}
