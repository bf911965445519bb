//! Number literals whose value a slider can change.

use crate::{
    source::{Source, Span},
    syntax::tree::{Unit, Value, ValueKind},
};

/// Minimum decimal exponent of a slider's step, and of the number that the slider changes. The
/// maximum exponent is 300. These powers of ten are far from the ends of `f64`'s range, so
/// computations with them neither overflow nor become 0.
const LEAST_EXPONENT: i32 = -300;

/// Maximum number of significant digits of a number that a slider changes. The slider's step is at
/// least one unit in the last of these digits. An `f64` distinguishes all decimal numbers with 15
/// digits; with more digits, a step could leave the number unchanged.
const DIGITS: i32 = 15;

/// A number literal with the sign directly before it.
#[derive(Clone, Copy, Debug)]
pub struct Literal {
    /// Span of the sign and the digits, without a unit.
    pub span: Span,
    /// The number as it is written: in degrees for `90deg`, in radians for `1rad`.
    pub value: f64,
    /// Decimal exponent of the last written digit: −2 for `1.25`, 0 for `12`.
    pub last_digit: i32,
    /// The written unit of an angle; `None` for a plain number.
    pub unit: Option<Unit>,
}

impl Literal {
    /// Returns the number literal that a value consists of, with or without parentheses around it.
    /// Returns `None` for any other value.
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
        let exponent = exponent.parse().unwrap_or(LEAST_EXPONENT);
        let exponent = exponent.clamp(LEAST_EXPONENT, -LEAST_EXPONENT);
        let Span { source, start, .. } = value.span;
        Some(Self {
            span: Span::new(source, start, start + written.len()),
            value: digits.parse().ok().filter(|it: &f64| it.is_finite())?,
            last_digit: exponent.saturating_sub_unsigned(decimals.try_into().ok()?),
            unit,
        })
    }

    /// Returns the literal together with the minus sign at `sign`. Returns `None` if text stands
    /// between the minus sign and the digits, or if the literal is negative already.
    fn negative(self, sign: Span) -> Option<Self> {
        (sign.end == self.span.start && self.value.is_sign_positive()).then_some(Self {
            span: sign.to(self.span),
            value: -self.value,
            ..self
        })
    }

    /// Returns whether the literal is a whole number, is written without decimals, and has no unit.
    pub fn is_whole(&self) -> bool {
        self.unit.is_none() && self.value.fract() == 0.0 && self.last_digit >= 0
    }

    /// Returns the step of the literal's slider, a power of ten. Usually it is between a hundredth
    /// and a tenth of the number, and at least 0.01. If the number is written with finer decimals,
    /// the step is one unit in its last decimal.
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

    /// Returns the text of `source` with `value` in place of the literal.
    pub fn replaced(&self, source: &Source, value: f64) -> String {
        let text = source.text();
        let Span { start, end, .. } = self.span;
        format!("{}{value}{}", &text[..start], &text[end..])
    }
}

fn power_of_ten(exponent: i32) -> f64 {
    let written = format!("1e{}", exponent.clamp(LEAST_EXPONENT, -LEAST_EXPONENT));
    written.parse().unwrap_or(1.0)
}

/// Returns the number of decimals in the shortest decimal form of `x`, limited to 100.
pub fn decimals(x: f64) -> usize {
    let written = x.to_string();
    let decimals = written.split_once('.').map_or(0, |(_, it)| it.len());
    decimals.min(100)
}

/// Shrinks the range `[least, most]` until its ends have no more decimals than `step`. An end that
/// already satisfies this is not changed.
pub fn inward([least, most]: [f64; 2], step: f64) -> [f64; 2] {
    let decimals_of_step = decimals(step);
    let scale = power_of_ten(decimals_of_step as i32);
    let rounded = |x: f64, round: fn(f64) -> f64| {
        if decimals(x) > decimals_of_step {
            round(x * scale) / scale
        } else {
            x
        }
    };
    [rounded(least, f64::ceil), rounded(most, f64::floor)]
}

/// Rounds a number to as many decimals as `step` has.
pub fn rounded(x: f64, step: f64) -> f64 {
    let decimals = decimals(step);
    // Adding 0 turns −0 into 0.
    format!("{x:.decimals$}").parse().unwrap_or(x) + 0.0
}
