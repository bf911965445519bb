//! The value of an expression.
//!
//! In: a value's tree and the names that are defined. Out: what it is, or problems. A value that failed is unknown (`None`),
//! and what uses it stays silent. What a value is for is not known here, beyond the type that is wanted.
//!
//! Here are literals, and what messages call a value; what is made of parts has a file each.

mod calls;
mod lists;
mod names;
mod operators;

pub use calls::example as example_call;
pub use names::{Names, predefined};

use super::{error::Problem, schema::Type, value::Value};
use crate::{
    color::Color,
    math::Angle,
    source::{Sources, Span},
    syntax::{
        shorten,
        tree::{self, Unit, ValueKind},
    },
};

/// Evaluates values, and collects what is wrong with them.
#[derive(Debug)]
pub struct Evaluator<'a, 's> {
    /// The texts.
    pub sources: &'s Sources,
    /// The names that can be used.
    pub names: &'a Names<'s>,
    /// What is wrong.
    pub problems: &'a mut Vec<Problem>,
}

impl<'s> Evaluator<'_, 's> {
    /// The value of an expression; `wanted` is the type that would fit, if one is known.
    pub fn value(&mut self, value: &tree::Value<'s>, wanted: Option<Type>) -> Option<Value> {
        match &value.kind {
            ValueKind::Number(written) => Some(Value::Number(self.number(written, value.span)?)),
            ValueKind::Angle { number, unit } => {
                let number = self.number(number, value.span)?;
                Some(Value::Angle(match unit {
                    Unit::Degrees => Angle::from_degrees(number),
                    Unit::Radians => Angle::from_radians(number),
                }))
            }
            ValueKind::ColorCode(written) => color_code(written).map(Value::Color),
            ValueKind::Name(name) => self.name(name, value.span, wanted),
            ValueKind::Call(call) => self.call(call, wanted),
            ValueKind::Parentheses(inner) => self.value(inner, wanted),
            ValueKind::Tuple(elements) => self.tuple(elements, value.span, wanted),
            ValueKind::Negation { sign, operand } => self.negation(*sign, operand),
            ValueKind::Chain { first, rest } => self.chain(first, rest, wanted),
            ValueKind::Missing | ValueKind::Bad => None,
        }
    }

    fn number(&mut self, written: &str, span: Span) -> Option<f64> {
        let number: f64 = if written.contains('_') {
            written.replace('_', "").parse().ok()?
        } else {
            written.parse().ok()?
        };
        if number.is_infinite() {
            let written = shorten(written);
            self.problems
                .push(Problem::NumberTooLarge { written, span });
            return None;
        }
        let mantissa = written.split(['e', 'E']).next().unwrap_or_default();
        if number == 0.0 && mantissa.contains(|digit| matches!(digit, '1'..='9')) {
            let written = shorten(written);
            self.problems
                .push(Problem::NumberUnderflow { written, span });
        }
        Some(number)
    }

    /// A number's spelling as an angle, in degrees and in radians, for a message.
    pub fn with_units(&self, value: &tree::Value<'s>) -> [String; 2] {
        self.units_behind(value, &shorten(self.sources.text(value.span)))
    }

    /// The same for an edit, which keeps all that is written.
    pub fn as_angle(&self, value: &tree::Value<'s>) -> [String; 2] {
        self.units_behind(value, self.sources.text(value.span))
    }

    fn units_behind(&self, value: &tree::Value<'s>, written: &str) -> [String; 2] {
        let literal = match &value.kind {
            ValueKind::Negation { operand, .. } => matches!(operand.kind, ValueKind::Number(_)),
            kind => matches!(kind, ValueKind::Number(_)),
        };
        ["deg", "rad"].map(|unit| match (literal, &value.kind) {
            (true, _) => format!("{written}{unit}"),
            (false, ValueKind::Chain { .. }) => format!("({written}) * 1{unit}"),
            (false, _) => format!("{written} * 1{unit}"),
        })
    }

    /// What stands under a span, for a message: a literal as it is, anything else in backquotes.
    pub fn quoted(&self, span: Span) -> String {
        let written = shorten(self.sources.text(span));
        let literal = written
            .starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '(' | '.'))
            && !written.contains(['`', '*', '/']);
        match literal {
            true => written,
            false => format!("`{written}`"),
        }
    }
}

/// A colour from its code; the parser checked the number of digits.
fn color_code(written: &str) -> Option<Color> {
    let digits = written.strip_prefix('#')?;
    let code = u32::from_str_radix(digits, 16).ok()?;
    Some(Color::from_bytes(if digits.len() == 3 {
        let digit = |shift: u32| ((code >> shift) & 0xf) as u8 * 0x11;
        [digit(8), digit(4), digit(0)]
    } else {
        let byte = |shift: u32| ((code >> shift) & 0xff) as u8;
        [byte(16), byte(8), byte(0)]
    }))
}
