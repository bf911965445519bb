//! Formats errors, times, numbers of samples and slopes for people.

use super::{estimate::Estimate, results::EndSlope};
use crate::numbers;

/// Mark in a table for a number that could not be determined: an en dash.
pub const UNKNOWN: &str = "–";

/// Formats an error that the user asked for, with all its digits. If a fraction such as 1/256 is
/// shorter, writes the fraction.
pub fn asked_error(error: f64) -> String {
    let decimal = if error < 1e-4 {
        format!("{error:e}")
    } else {
        format!("{error}")
    };
    let inverse = (1.0 / error).round();
    if 1.0 / inverse == error && inverse < 1e6 && decimal.len() > 6 {
        format!("1/{inverse}")
    } else {
        decimal
    }
}

/// Formats a measured error with two significant digits.
pub fn error(error: f64) -> String {
    significant(error, 2)
}

/// Formats a time in seconds or milliseconds, with `digits` significant digits. NaN becomes
/// [`UNKNOWN`].
pub fn seconds(seconds: f64, digits: usize) -> String {
    match seconds {
        _ if seconds.is_nan() => UNKNOWN.to_owned(),
        _ if seconds < 0.9995 => format!("{} ms", significant(seconds * 1e3, digits)),
        _ => format!("{} s", significant(seconds, digits)),
    }
}

/// Formats an estimated time with three significant digits. An extrapolated time is marked with `~`
/// and has only two digits, because it is not accurate enough for more.
pub fn time(estimate: &Estimate, time: f64) -> String {
    if estimate.is_extrapolated {
        format!("~{}", seconds(time, 2))
    } else {
        seconds(time, 3)
    }
}

/// Formats an estimated number of samples per pixel. Returns an empty text for the exact method,
/// which uses no samples.
pub fn samples(estimate: &Estimate) -> String {
    match estimate.per_pixel {
        None => String::new(),
        Some(count) if estimate.is_extrapolated => format!("~{}", significant(count, 2)),
        Some(count) => format!("{count}"),
    }
}

/// Word that a table shows instead of the slope if a line bends.
pub const BENDS: &str = "bends";

/// Formats the slope of a line, with its standard error if it is known. If the line bends, the
/// result is the word [`BENDS`]. `None` becomes [`UNKNOWN`].
pub fn slope(slope: Option<EndSlope>) -> String {
    let signed = |number: f64| format!("{number:.2}").replace('-', "−");
    match slope {
        None => UNKNOWN.to_owned(),
        Some(EndSlope { bends: true, .. }) => BENDS.to_owned(),
        Some(EndSlope { slope, error, .. }) => match error {
            None => signed(slope),
            Some(error) => format!("{} ± {error:.2}", signed(slope)),
        },
    }
}

/// Formats a factor with two significant digits. `None` and factors above 10⁶ become [`UNKNOWN`],
/// since measured slopes are not accurate enough for such large factors.
pub fn factor(factor: Option<f64>) -> String {
    let known = factor.filter(|factor| *factor <= 1e6);
    known.map_or(UNKNOWN.to_owned(), |factor| significant(factor, 2))
}

/// Formats a fraction from 0 to 1 as a percentage with two significant digits.
pub fn percent(share: f64) -> String {
    match share {
        0.0 => "none".to_owned(),
        _ => format!("{} %", significant(100.0 * share, 2)),
    }
}

/// Formats a count with the noun `what`, for example `1 run` or `3 runs`.
pub fn plural(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// Formats a number with `digits` significant digits, including trailing zeros. A very large or
/// small number has two digits and an exponent.
fn significant(number: f64, digits: usize) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e7).contains(&number) {
        return format!("{number:.1e}");
    }
    let rounded = numbers::significant(number, digits);
    let before = libm::log10(rounded).floor() as i32 + 1;
    let after = (digits as i32 - before).max(0) as usize;
    format!("{rounded:.after$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_are_worth_reading() {
        for (number, text) in [
            (1.0 / 256.0, "1/256"),
            (1.0 / 3.0, "1/3"),
            (0.0101, "0.0101"),
            (0.0104, "0.0104"),
            (0.5, "0.5"),
            (1e-6, "1e-6"),
        ] {
            assert_eq!(asked_error(number), text);
        }
        for (number, text) in [(0.012_84, "0.013"), (0.5, "0.50"), (0.0, "0")] {
            assert_eq!(error(number), text);
        }
        for (time, digits, text) in [
            (0.012_345, 3, "12.3 ms"),
            (1.234_5, 3, "1.23 s"),
            (0.434, 2, "430 ms"),
            (0.000_12, 2, "0.12 ms"),
            (f64::NAN, 3, "–"),
        ] {
            assert_eq!(seconds(time, digits), text);
        }
    }
}
