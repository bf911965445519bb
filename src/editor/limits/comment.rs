//! Parses the range of a slider from a comment: `// [1:5]`, `// [1:0.1:5]`, `// [0deg:5deg:90deg]`.

use super::literal::inward;
use crate::{numbers::significant, syntax::tree::Unit};

/// Range of a slider that a comment gives for a value, in the unit of that value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommentRange {
    /// The lower and the upper end of the range, in the unit of the value.
    pub ends: [f64; 2],
    /// Distance between neighbouring values of the slider, a positive number. `None` if the comment
    /// gives no step.
    pub step: Option<f64>,
    /// Whether a number of the range was converted between degrees and radians. A converted number
    /// has more digits than a slider should show.
    is_converted: bool,
}

impl CommentRange {
    /// Returns the step and the ends of the slider. If the comment gives no step, uses
    /// `default_step`. A range that was converted between degrees and radians gets short numbers:
    /// the step is rounded to two significant digits, and the ends are moved inwards to numbers
    /// with as many decimals as the step. Any other range stays as it was written.
    pub fn rounded(self, default_step: f64) -> (f64, [f64; 2]) {
        let step = self.step.unwrap_or(default_step);
        if !self.is_converted {
            return (step, self.ends);
        }
        let step = significant(step, 2);
        (step, inward(self.ends, step))
    }
}

/// Returns the range in the comment of a slider, such as `1:5` in `// [1:5]`. `behind` is the text
/// after the value. Returns `None` if no comment with brackets follows the value directly, or if
/// the brackets contain no colon or no number.
pub fn range_behind(behind: &str) -> Option<&str> {
    let comment = behind.trim_start().strip_prefix("//")?.trim_start();
    let (range, _) = comment.strip_prefix('[')?.split_once(']')?;
    let is_number = |part: &str| {
        let digits = part.trim_start().trim_start_matches(['+', '-', '.']);
        digits.starts_with(|it: char| it.is_ascii_digit())
    };
    (range.contains(':') && range.split(':').any(is_number)).then_some(range)
}

/// Parses the range of a slider, such as `1:5` or `1:0.1:5`. The first and the last number are the
/// ends of the range, in either order. If there are three numbers, the middle one is the step. The
/// numbers are converted to `unit`, the unit of the slider's value.
///
/// # Errors
///
/// Returns a sentence that says why the text is not a range.
pub fn parse(range: &str, unit: Option<Unit>) -> Result<CommentRange, String> {
    let numbers = range.split(':').map(|it| in_unit(it.trim(), unit));
    let numbers = numbers.collect::<Result<Vec<(f64, bool)>, _>>()?;
    let (one, step, other) = match numbers[..] {
        [(one, _), (other, _)] => (one, None, other),
        [(one, _), (step, _), (other, _)] => (one, Some(step.abs()), other),
        _ => return Err("a range has two ends, and at most a step between them".to_owned()),
    };
    let length = (one - other).abs();
    let mistake = if length == 0.0 {
        "both ends of the range are the same"
    } else if !length.is_finite() {
        "the ends of the range are too far apart"
    } else if step == Some(0.0) {
        "the step of the range is 0"
    } else if step.is_some_and(|step| step > length) {
        "the step of the range is longer than the range"
    } else {
        return Ok(CommentRange {
            ends: [one.min(other), one.max(other)],
            step,
            is_converted: numbers.iter().any(|(_, is_converted)| *is_converted),
        });
    };
    Err(mistake.to_owned())
}

/// Parses a number of a range, and converts it to `unit`, the unit of the slider's value. A number
/// without a unit is not converted. Returns the number, and whether it was converted. Returns a
/// message if `written` is not a number, or if it has a unit although the value has none.
fn in_unit(written: &str, unit: Option<Unit>) -> Result<(f64, bool), String> {
    let mut units = [Unit::Degrees, Unit::Radians].into_iter();
    let own = units.find(|unit| written.ends_with(unit.name()));
    let digits = written.strip_suffix(own.map_or("", Unit::name));
    let number = digits
        .unwrap_or(written)
        .trim_end()
        .replace('_', "")
        .parse()
        .ok();
    let number: f64 = number
        .filter(|it: &f64| it.is_finite())
        .ok_or_else(|| format!("`{written}` in the range is no number"))?;
    match (own, unit) {
        (Some(own), None) => Err(format!(
            "the range is in {}, and the number has no unit",
            own.name()
        )),
        (Some(Unit::Degrees), Some(Unit::Radians)) => {
            Ok((Unit::Degrees.of(number).in_radians(), true))
        }
        (Some(Unit::Radians), Some(Unit::Degrees)) => {
            Ok((Unit::Radians.of(number).in_degrees(), true))
        }
        _ => Ok((number, false)),
    }
}
