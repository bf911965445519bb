//! A number of the text that can be turned: where its digits stand, and what they say.

use crate::{
    source::{Source, Span},
    syntax::tree::{Unit, Value, ValueKind},
};

/// Least exponent of a step, so that it is never 0.
const FINEST: i32 = -300;

/// Number of significant digits of a number that is turned, at most.
const DIGITS: i32 = 15;

/// A number literal with the sign that belongs to it.
#[derive(Clone, Copy, Debug)]
pub struct Literal {
    /// Where its sign and its digits stand, without a unit.
    pub span: Span,
    /// Its value in its own unit.
    pub value: f64,
    /// The exponent of its last digit: −2 of `1.25`, 0 of `12`.
    pub last_digit: i32,
    /// The unit that it is written in.
    pub unit: Option<Unit>,
}

impl Literal {
    /// The literal that a value is by itself, perhaps in parentheses.
    pub fn of(value: &Value<'_>) -> Option<Self> {
        let (written, unit) = match &value.kind {
            ValueKind::Number(written) => (written, None),
            ValueKind::Angle { number, unit } => (number, Some(*unit)),
            ValueKind::Parentheses(inner) => return Self::of(inner),
            ValueKind::Negation { sign, operand } => return Self::of(operand)?.negative(*sign),
            _ => return None,
        };
        let digits = written.replace('_', "");
        let (mantissa, exponent) = digits.split_once(['e', 'E']).unwrap_or((&digits, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, it)| it.len());
        let exponent: i32 = exponent.parse().unwrap_or(FINEST).clamp(FINEST, -FINEST);
        let Span { source, start, .. } = value.span;
        Some(Self {
            span: Span::new(source, start, start + written.len()),
            value: digits.parse().ok().filter(|it: &f64| it.is_finite())?,
            last_digit: exponent.saturating_sub_unsigned(decimals.try_into().ok()?),
            unit,
        })
    }

    /// The same behind a sign; `None` unless it stands directly before the digits.
    fn negative(self, sign: Span) -> Option<Self> {
        (sign.end == self.span.start && self.value.is_sign_positive()).then_some(Self {
            span: sign.to(self.span),
            value: -self.value,
            ..self
        })
    }

    /// Whether it may be a count.
    pub fn is_whole(&self) -> bool {
        self.unit.is_none() && self.value.fract() == 0.0 && self.last_digit >= 0
    }

    /// The step by which it is turned: a hundredth to a tenth of the number, but no less than a
    /// hundredth, so that a way to zero ends; and no coarser than how it is written.
    pub fn step(&self) -> f64 {
        let size = match self.value.abs() {
            0.0 => 0,
            size => libm::log10(size).floor() as i32,
        };
        let exponent = (size - 1).max(-2);
        let last = self.last_digit.max(size - DIGITS);
        power_of_ten(if last < 0 {
            exponent.min(last)
        } else {
            exponent
        })
    }

    /// The text with another number in the place of this one.
    pub fn replaced(&self, source: &Source, value: f64) -> String {
        let text = source.text();
        let Span { start, end, .. } = self.span;
        format!("{}{value}{}", &text[..start], &text[end..])
    }
}

fn power_of_ten(exponent: i32) -> f64 {
    let written = format!("1e{}", exponent.clamp(FINEST, -FINEST));
    written.parse().unwrap_or(1.0)
}

/// Number of digits after the point of a number as it is written, at most a hundred.
pub fn decimals(x: f64) -> usize {
    let written = x.to_string();
    written
        .split_once('.')
        .map_or(0, |(_, it)| it.len().min(100))
}

/// The greatest range within a range whose ends have no more decimals than a step.
pub fn inward([least, most]: [f64; 2], step: f64) -> [f64; 2] {
    let decimals_of_step = decimals(step);
    let scale = power_of_ten(decimals_of_step as i32);
    let rounded = |x: f64, round: fn(f64) -> f64| match decimals(x) > decimals_of_step {
        true => round(x * scale) / scale,
        false => x,
    };
    [rounded(least, f64::ceil), rounded(most, f64::floor)]
}

/// A number with as many decimals as a step has.
pub fn rounded(x: f64, step: f64) -> f64 {
    let decimals = decimals(step);
    // Without −0.
    format!("{x:.decimals$}").parse().unwrap_or(x) + 0.0
}
