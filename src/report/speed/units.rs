//! How errors, times, numbers of samples and slopes are written.

use super::{needed::Needed, statistics::PowerLaw};

/// What stands for a number that is not known.
pub const UNKNOWN: &str = "–";

/// An error: whole fractions of light that somebody asks for as such, others with two digits.
pub fn error(error: f64) -> String {
    let inverse = 1.0 / error;
    let is_step = (64.0..=65536.0).contains(&inverse) && inverse % 64.0 == 0.0;
    match is_step {
        true => format!("1/{inverse}"),
        false => significant(error, 2),
    }
}

/// A time in seconds or milliseconds, with so many digits.
pub fn seconds(seconds: f64, digits: i32) -> String {
    match seconds {
        _ if seconds.is_nan() => UNKNOWN.to_owned(),
        _ if seconds < 0.9995 => format!("{} ms", significant(seconds * 1e3, digits)),
        _ => format!("{} s", significant(seconds, digits)),
    }
}

/// How long an error takes: of what is extrapolated no more than two digits are worth reading.
pub fn time(needed: &Needed, time: f64) -> String {
    match needed.is_extrapolated {
        true => format!("~{}", seconds(time, 2)),
        false => seconds(time, 3),
    }
}

/// The samples per pixel that an error takes; nothing of the exact method.
pub fn samples(needed: &Needed) -> String {
    match needed.per_pixel {
        None => String::new(),
        Some(count) if needed.is_extrapolated => format!("~{}", significant(count, 2)),
        Some(count) => format!("{count}"),
    }
}

/// A slope with its standard error.
pub fn slope(fit: Option<PowerLaw>) -> String {
    let signed = |number: f64| format!("{number:.2}").replace('-', "−");
    match fit {
        None => UNKNOWN.to_owned(),
        Some(fit) => match fit.slope_error {
            None => signed(fit.slope),
            Some(error) => format!("{} ± {error:.2}", signed(fit.slope)),
        },
    }
}

/// A number of things.
pub fn plural(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// So many digits, not counting zeros in front; what is very large or small has an exponent.
fn significant(number: f64, digits: i32) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e7).contains(&number) {
        return format!("{number:.1e}");
    }
    let before = libm::log10(number).floor() as i32 + 1;
    let unit = libm::exp10(f64::from((before - digits).max(0)));
    let after = (digits - before).max(0) as usize;
    format!("{:.after$}", (number / unit).round() * unit)
}
