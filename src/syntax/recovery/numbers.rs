//! Numbers, with what people write behind them.

use super::Recovery;
use crate::{
    diagnostic::Fix,
    schema::Type,
    source::Span,
    syntax::{
        problem::{problem, replace, shorten},
        tokens::{TokenKind, numeric_part},
        tree::{Unit, Value, ValueKind, bad, number},
    },
};

/// What people write for a unit, how much of the right one it is, and that one: nothing for a length, which is in metres.
const UNITS: &[(&[&str], f64, &str)] = &[
    (&["°", "deg", "degs", "degree", "degrees"], 1.0, "deg"),
    (&["rad", "rads", "radian", "radians"], 1.0, "rad"),
    (&["grad", "grads", "gon"], 0.9, "deg"),
    (&["m", "metre", "metres", "meter", "meters"], 1.0, ""),
    (&["px", "pixel", "pixels"], 1.0, ""),
    (&["cm"], 0.01, ""),
    (&["mm"], 0.001, ""),
    (&["km"], 1000.0, ""),
    (&["ft", "feet", "foot"], 0.3048, ""),
    (&["in", "inch", "inches"], 0.0254, ""),
];

fn unit_of(written: &str) -> Option<(f64, &'static str)> {
    let written = written.to_ascii_lowercase();
    let row = UNITS
        .iter()
        .find(|(words, ..)| words.contains(&written.as_str()));
    row.map(|&(_, factor, unit)| (factor, unit))
}

/// A number times a factor, without the last digits, which are those of rounding.
fn scaled(number: &str, factor: f64) -> Option<String> {
    if factor == 1.0 {
        return Some(number.to_owned());
    }
    let value = number.replace('_', "").parse::<f64>().ok()? * factor;
    let rounded: f64 = format!("{value:.11e}").parse().ok()?;
    Some(format!("{rounded}"))
}

impl<'s> Recovery<'_, 's> {
    /// A number, with its unit if it has one.
    pub(super) fn number(&mut self) -> Value<'s> {
        let written = self.word(0);
        let span = self.bump();
        let digits = numeric_part(written);
        let unit = written.get(digits.len()..).unwrap_or_default();
        if unit.is_empty() {
            let next = self.word(0);
            let is_apart = next == "°"
                || (self.kind(0) == TokenKind::Name
                    && !self.is_on_new_line(0)
                    && !self.is_field_name(next)
                    && !self.words.is_let(next));
            if is_apart && let Some(right) = unit_of(next) {
                let behind = self.bump();
                return self.with_unit(digits, next, right, span.to(behind), behind);
            }
        }
        if matches!(unit, "" | "deg" | "rad") {
            return Value {
                kind: number(written),
                span,
            };
        }
        let behind = Span::new(self.id, span.start + digits.len(), span.end);
        match unit_of(unit).filter(|_| !self.words.is_let(unit)) {
            Some(right) => self.with_unit(digits, unit, right, span, behind),
            None => self.odd_number(written, digits, span, behind),
        }
    }

    /// A number with a unit that is none, or stands apart from it.
    fn with_unit(
        &mut self,
        digits: &'s str,
        unit: &str,
        (factor, right): (f64, &str),
        whole: Span,
        behind: Span,
    ) -> Value<'s> {
        let takes = self.within.takes;
        let fits = match right {
            "" => matches!(takes, None | Some(Type::Number)),
            _ => matches!(takes, None | Some(Type::Angle)),
        };
        let text = scaled(digits, factor).map(|number| format!("{number}{right}"));
        let fix = text.filter(|_| fits).map(|text| replace(whole, text));
        let is_spaced =
            !right.is_empty() && unit != "°" && whole.end - whole.start > digits.len() + unit.len();
        let found = if is_spaced {
            let place = if unit == right { whole } else { behind };
            let message = "a unit stands right behind its number";
            problem("spaced_unit", message, place, "no space between the two")
        } else {
            let message = format!("`{}{}` is no number", shorten(digits), shorten(unit));
            let label = match right {
                "" => format!("`{unit}` is no unit; only angles have one"),
                _ => format!("`{unit}` is no unit"),
            };
            problem("bad_number", message, behind, label)
        };
        let help = match right {
            "" if fits => format!("{}; all lengths are in metres", title(fix.as_ref())),
            "" => "only angles have a unit, such as `30deg`".to_owned(),
            _ if fits => title(fix.as_ref()),
            _ => format!("write an angle as `30{right}`"),
        };
        let found = found.with_help(help);
        self.problems.push(match fix {
            Some(fix) => found.with_fix(fix),
            None => found,
        });
        let kind = match right {
            _ if !fits || factor != 1.0 => ValueKind::Bad,
            "" => ValueKind::Number(digits),
            _ => ValueKind::Angle {
                number: digits,
                unit: if right == "deg" {
                    Unit::Degrees
                } else {
                    Unit::Radians
                },
            },
        };
        Value { kind, span: whole }
    }

    /// What starts as a number does and is none.
    fn odd_number(
        &mut self,
        written: &'s str,
        digits: &str,
        span: Span,
        behind: Span,
    ) -> Value<'s> {
        let unit = self.written(behind);
        let hex = written.strip_prefix("0x").unwrap_or(written);
        let is_hex = hex.len() == 6 && hex.bytes().all(|digit| digit.is_ascii_hexdigit());
        let takes = self.within.takes;
        let takes_number = matches!(takes, None | Some(Type::Number));
        let tight = written.replace('_', "");
        let is_tight = numeric_part(&tight) == tight;
        let (label, fix, place) = if self.words.is_factor(unit) {
            let product = format!("{digits} * {unit}");
            let fix = takes_number.then(|| replace(span, product));
            ("an operator is missing before this", fix, behind)
        } else if is_hex && takes == Some(Type::Color) {
            let fix = replace(span, format!("#{hex}"));
            ("the digits of a colour stand behind a `#`", Some(fix), span)
        } else if let Some(sizes) = self.sizes(written) {
            ("`x` is no operator", Some(replace(span, sizes)), span)
        } else if is_tight {
            let fix = replace(span, tight);
            ("a `_` stands between two digits only", Some(fix), span)
        } else {
            let place = if unit.starts_with('.') { span } else { behind };
            ("not a part of a number", None, place)
        };
        let message = format!("`{}` is no number", shorten(written));
        let help = "write a number such as `2`, `0.5` or `1e-3`";
        self.problems
            .push(problem("bad_number", message, place, label).with_fix_or(fix, help));
        bad(span)
    }

    /// `0.5x1.5x2` and `4x4`
    fn sizes(&self, written: &str) -> Option<String> {
        let parts: Vec<&str> = written.split(['x', 'X']).collect();
        let is_number = |part: &&str| !part.is_empty() && numeric_part(part) == *part;
        if !parts.iter().all(is_number) {
            return None;
        }
        match (parts.as_slice(), self.within.takes) {
            ([_, _, _], None | Some(Type::Vector)) => Some(format!("({})", parts.join(", "))),
            ([a, b], Some(Type::Number)) => {
                Some((a.parse::<f64>().ok()? * b.parse::<f64>().ok()?).to_string())
            }
            _ => None,
        }
    }
}

fn title(fix: Option<&Fix>) -> String {
    fix.map_or_else(|| "write it without".to_owned(), |fix| fix.title.clone())
}
