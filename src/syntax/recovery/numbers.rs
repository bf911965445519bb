//! Reads numbers, including a unit or other text that follows the digits.

use super::Recovery;
use crate::{
    schema::Type,
    source::Span,
    syntax::{
        messages as say,
        problem::{replace, shorten},
        tokens::{has_name, is_color_code, numeric_part},
        tree::{Unit, Value, ValueKind, bad, number},
    },
};

/// Units that people write. A row holds the spellings of a unit, the factor that converts a number
/// to the matching unit of the language, and that unit. The unit is empty for lengths, which the
/// language measures in metres.
const UNITS: &[(&str, f64, &str)] = &[
    ("° deg degs degree degrees", 1.0, "deg"),
    ("rad rads radian radians", 1.0, "rad"),
    ("grad grads gon", 0.9, "deg"),
    ("m metre metres meter meters px pixel pixels f", 1.0, ""),
    ("cm", 0.01, ""),
    ("mm", 0.001, ""),
    ("km", 1000.0, ""),
    ("ft feet foot", 0.3048, ""),
    ("in inch inches", 0.0254, ""),
];

pub(super) fn unit_of(written: &str) -> Option<(f64, &'static str)> {
    let is_it = |word: &str| word.eq_ignore_ascii_case(written);
    let row = UNITS.iter().find(|(words, ..)| words.split(' ').any(is_it));
    row.map(|&(_, factor, unit)| (factor, unit))
}

/// Returns a number times a factor, rounded to 12 significant digits so that no rounding error
/// shows. Returns `None` if `number` is not a number.
fn scaled(number: &str, factor: f64) -> Option<String> {
    if factor == 1.0 {
        return Some(number.to_owned());
    }
    let value = number.replace('_', "").parse::<f64>().ok()? * factor;
    let rounded: f64 = format!("{value:.11e}").parse().ok()?;
    Some(format!("{rounded}"))
}

/// Returns the value of a number in another base, such as `0x10`, `0b11` or `0o17`. Returns `None`
/// for any other text, or if the value exceeds `u32`.
fn in_other_base(written: &str) -> Option<u32> {
    let (base, digits) = written.strip_prefix('0')?.split_at_checked(1)?;
    let base = match base {
        "x" | "X" => 16,
        "b" | "B" => 2,
        "o" | "O" => 8,
        _ => return None,
    };
    u32::from_str_radix(digits, base).ok()
}

impl<'s> Recovery<'_, 's> {
    /// Reads a number with its unit, if it has one, and reports a wrong unit or other text after
    /// the digits.
    pub(super) fn number(&mut self) -> Value<'s> {
        let written = self.word(0);
        let span = self.bump();
        let digits = numeric_part(written);
        let unit = written.get(digits.len()..).unwrap_or_default();
        let next = self.word(0);
        let is_apart = unit.is_empty()
            && (next == "°" || (self.is_name(0) && !self.is_on_new_line(0)))
            && !self.is_field_name(next)
            && !self.words.is_let(next);
        if is_apart && let Some(right) = unit_of(next) {
            let behind = self.bump();
            return self.with_unit(digits, right, span.to(behind), behind);
        }
        if matches!(unit, "" | "deg" | "rad") {
            let kind = number(written);
            return Value { kind, span };
        }
        let behind = Span::new(self.id, span.start + digits.len(), span.end);
        match unit_of(unit).filter(|_| !self.words.is_let(unit)) {
            Some(right) => self.with_unit(digits, right, span, behind),
            None => self.bad_number(written, digits, span, behind),
        }
    }

    /// Reports a number whose unit is wrong or separated by a space. Multiplying the number by
    /// `factor` converts it to `right`, a unit of the language. `whole` is the span of the number
    /// and its unit, and `behind` the span of the unit.
    fn with_unit(
        &mut self,
        number: &'s str,
        (factor, right): (f64, &str),
        whole: Span,
        behind: Span,
    ) -> Value<'s> {
        let unit = self.written(behind);
        let wanted = match right {
            "" => Type::Number,
            _ => Type::Angle,
        };
        let fits = self.context.takes.is_none_or(|takes| takes == wanted);
        let label = match wanted {
            _ if !fits => "only angles have a unit, such as `30deg`",
            Type::Number if unit.to_ascii_lowercase().starts_with(['p', 'f']) => {
                "no unit stands behind a plain number"
            }
            Type::Number => "all lengths are in metres",
            _ => "the units are `deg` and `rad`",
        };
        let text = scaled(number, factor).filter(|_| fits);
        let angle = |unit| ValueKind::Angle { number, unit };
        // If the number needs no conversion, its value is returned rather than a value marked as
        // bad, so that further mistakes, such as a value that is too large, are reported as well.
        let meant = match (fits && factor == 1.0, right) {
            (false, _) => ValueKind::Bad,
            (true, "deg") => angle(Unit::Degrees),
            (true, "rad") => angle(Unit::Radians),
            (true, _) => ValueKind::Number(number),
        };
        let fix = text.map(|text| replace(whole, text + right));
        let is_apart = behind.start > whole.start + number.len() && unit != "°";
        if is_apart && wanted == Type::Angle {
            self.report(&say::SPACED_UNIT, whole, &[label], fix);
        } else {
            let written = shorten(&format!("{number}{unit}"));
            self.report(&say::BAD_NUMBER, whole, &[&written, label], fix);
        }
        Value::new(meant, whole)
    }

    /// Reports a word that starts with a digit and is not a number. `digits` is its numeric part,
    /// and `behind` the span of the rest.
    fn bad_number(&mut self, written: &str, digits: &str, span: Span, behind: Span) -> Value<'s> {
        let unit = self.written(behind);
        let hex = written.strip_prefix("0x").unwrap_or(written);
        let takes = self.context.takes;
        let is_scaled = takes == Some(Type::Vector) && self.words.is_let(unit);
        let (label, right, place) = if is_scaled || self.words.is_factor(unit) {
            let takes_number = is_scaled || matches!(takes, None | Some(Type::Number));
            let product = takes_number.then(|| format!("{digits} * {unit}"));
            ("an operator is missing before this", product, behind)
        } else if is_color_code(hex) && takes == Some(Type::Color) {
            let label = "the digits of a colour stand behind a `#`";
            (label, Some(format!("#{hex}")), span)
        } else if let Some(value) = in_other_base(written) {
            let right = (takes != Some(Type::Color)).then(|| value.to_string());
            ("a number has decimal digits", right, span)
        } else if let Some(sizes) = self.sizes(written, span) {
            ("`x` is no operator", Some(sizes), span)
        } else {
            let place = if unit.starts_with('.') { span } else { behind };
            ("not a part of a number", None, place)
        };
        // A fix that is shorter than the written text loses a part of it, so the fix is not safe.
        // For example, the fix of `4x4` is the product 16.
        let is_longer = |right: &String| right.len() >= written.len();
        let said = say::BAD_NUMBER.safe_if(right.as_ref().is_none_or(is_longer));
        let fix = right.map(|right| replace(span, right));
        self.report(&said, place, &[&shorten(written), label], fix);
        bad(span)
    }

    /// Returns the correction of sizes written with `x`, such as `0.5x1.5x2` or `4x4`. Returns
    /// `None` if the meaning is uncertain.
    fn sizes(&self, written: &str, span: Span) -> Option<String> {
        let parts: Vec<&str> = written.split(['x', 'X']).collect();
        let is_number = |part: &&str| !part.is_empty() && numeric_part(part) == *part;
        if !parts.iter().all(is_number) {
            return None;
        }
        match (parts.as_slice(), self.context.takes) {
            ([_, _, _], None | Some(Type::Vector)) => Some(format!("({})", parts.join(", "))),
            // For `width 640x480`, the second number becomes the field `height`, unless the block
            // has that field.
            ([a, b], Some(Type::Number)) if self.context.field == "width" => {
                let before = self.text.get(..span.start)?.rsplit('{').next()?;
                let behind = self.text.get(span.end..)?.split('}').next()?;
                let is_free = !has_name(before, "height") && !has_name(behind, "height");
                is_free.then(|| format!("{a}  height {b}"))
            }
            ([a, b], Some(Type::Number)) => {
                Some((a.parse::<f64>().ok()? * b.parse::<f64>().ok()?).to_string())
            }
            _ => None,
        }
    }
}
