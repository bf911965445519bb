//! The range of a slider that a comment gives: `// [1:5]`, `// [1:0.1:5]`, `// [0deg:5deg:90deg]`.

use super::literal::inward;
use crate::{numbers::significant, syntax::tree::Unit};

/// A range by a comment, in the unit of the value before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The lesser and the greater end.
    pub ends: [f64; 2],
    /// The step, which is more than 0.
    pub step: Option<f64>,
    /// Whether a part was written in another unit, so that the numbers have more digits than one
    /// wants to see.
    is_converted: bool,
}

impl Range {
    /// Its step, or else another one, and its ends, none of which has more decimals than the step
    /// where they were converted.
    pub fn rounded(self, step: f64) -> (f64, [f64; 2]) {
        let step = self.step.unwrap_or(step);
        if !self.is_converted {
            return (step, self.ends);
        }
        let step = significant(step, 2);
        (step, inward(self.ends, step))
    }
}

/// What stands in the brackets of a comment that is all that stands behind a value, if one of its
/// parts begins as a number does: others are remarks.
pub fn range_behind(behind: &str) -> Option<&str> {
    let comment = behind.trim_start().strip_prefix("//")?.trim_start();
    let (range, _) = comment.strip_prefix('[')?.split_once(']')?;
    let is_number = |part: &str| {
        part.trim_start()
            .trim_start_matches(['+', '-', '.'])
            .starts_with(|it: char| it.is_ascii_digit())
    };
    (range.contains(':') && range.split(':').any(is_number)).then_some(range)
}

/// Parses a range into numbers in the unit of a value; its ends may come in either order.
///
/// # Errors
///
/// Why it is no range, in a sentence.
pub fn parse(range: &str, unit: Option<Unit>) -> Result<Range, String> {
    let numbers: Result<Vec<(f64, bool)>, _> = range
        .split(':')
        .map(|it| in_unit(it.trim(), unit))
        .collect();
    let numbers = numbers?;
    let is_converted = numbers.iter().any(|(_, is_converted)| *is_converted);
    let (one, step, other) = match numbers[..] {
        [(one, _), (other, _)] => (one, None, other),
        [(one, _), (step, _), (other, _)] => (one, Some(step.abs()), other),
        _ => return Err("a range has two ends, and at most a step between them".to_owned()),
    };
    let length = (one - other).abs();
    if length == 0.0 {
        return Err("both ends of the range are the same".to_owned());
    }
    if !length.is_finite() {
        return Err("the ends of the range are too far apart".to_owned());
    }
    if step == Some(0.0) {
        return Err("the step of the range is 0".to_owned());
    }
    if step.is_some_and(|step| step > length) {
        return Err("the step of the range is longer than the range".to_owned());
    }
    Ok(Range {
        ends: [one.min(other), one.max(other)],
        step,
        is_converted,
    })
}

/// A number of a range, and whether its unit is another one than that of the value; one without a
/// unit is in that of the value.
fn in_unit(written: &str, unit: Option<Unit>) -> Result<(f64, bool), String> {
    let units = [Unit::Degrees, Unit::Radians].into_iter();
    let mut own = units.filter_map(|unit| Some((written.strip_suffix(unit.name())?, unit)));
    let (number, own) = own
        .next()
        .map_or((written, None), |(it, unit)| (it, Some(unit)));
    let number = number.trim_end().replace('_', "").parse().ok();
    let number: f64 = number
        .filter(|it: &f64| it.is_finite())
        .ok_or_else(|| format!("`{written}` in the range is no number"))?;
    match (own, unit) {
        (Some(own), None) => {
            let name = own.name();
            Err(format!(
                "the range is in {name}, and the number has no unit"
            ))
        }
        (Some(Unit::Degrees), Some(Unit::Radians)) => {
            Ok((Unit::Degrees.of(number).in_radians(), true))
        }
        (Some(Unit::Radians), Some(Unit::Degrees)) => {
            Ok((Unit::Radians.of(number).in_degrees(), true))
        }
        _ => Ok((number, false)),
    }
}
