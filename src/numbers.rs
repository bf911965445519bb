//! Formats numbers for people.

use glam::DVec3;

/// Formats a number with six significant digits, without trailing zeros. Numbers from 10^6 to below
/// 10^9 keep all digits before the point. Numbers below 10^−4 or from 10^9 on have an exponent.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if !(1e-4..1e9).contains(&x.abs()) {
        let text = format!("{x:.5e}");
        let Some((digits, exponent)) = text.split_once('e') else {
            return text;
        };
        return format!("{}e{exponent}", trimmed(digits));
    }
    // Finds the number of decimals for six significant digits: 5 − ⌊log10 |x|⌋ for |x| < 10^6, and
    // 0 for larger numbers. The search begins at |x| from 1 to below 10, i.e. with 5 decimals.
    let mut decimals = 5;
    let mut bound = 10.0;
    while x.abs() >= bound && decimals > 0 {
        bound *= 10.0;
        decimals -= 1;
    }
    while x.abs() < bound / 10.0 && bound > 1e-3 {
        bound /= 10.0;
        decimals += 1;
    }
    trimmed(&format!("{x:.decimals$}")).to_owned()
}

/// Rounds a number to `digits` significant digits.
pub fn significant(x: f64, digits: usize) -> f64 {
    let after = digits.saturating_sub(1);
    format!("{x:.after$e}").parse().unwrap_or(x)
}

/// Formats an upper bound with two significant digits and an exponent, rounded up.
pub fn at_most(bound: f64) -> String {
    if bound == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{bound:.1e}");
    let is_less = text.parse().is_ok_and(|read: f64| read < bound);
    match text.split_once('e') {
        // If the rounded text is less than `bound`, its last digit is increased by 1. The text
        // before the exponent is a number with one decimal, so 0.1 is added to it, and the sum is
        // again formatted with one decimal.
        Some((digits, exponent)) if is_less => {
            let next = digits.parse().map_or(bound, |digits: f64| digits + 0.1);
            let carried: f64 = format!("{next:.1}e{exponent}").parse().unwrap_or(bound);
            format!("{carried:.1e}")
        }
        _ => text,
    }
}

/// Formats a number so that a reader can compare it with the numbers `others`. Uses the form of
/// [`short`] unless its rounding changes whether the number is less than, equal to or greater than
/// one of `others`. In this case, uses all digits.
pub fn comparable(x: f64, others: &[f64]) -> String {
    let text = short(x);
    let read = text.parse().unwrap_or(x);
    let decides = |other: &f64| f64::partial_cmp(&read, other) != x.partial_cmp(other);
    match others.iter().any(decides) {
        true if (1e-4..1e17).contains(&x.abs()) => format!("{x}"),
        true => format!("{x:e}"),
        false => text,
    }
}

/// Rounds a number to the decimals that are meaningful for a given error: up to the first
/// significant digit of the error, but at most 12 decimals. Returns `x` unchanged if the error is
/// not positive or not finite.
pub fn rounded(x: f64, error: f64) -> f64 {
    if !(error > 0.0 && error.is_finite()) {
        return x;
    }
    let decimals = (-libm::log10(error).floor()).clamp(0.0, 12.0) as usize;
    // Adding 0 turns −0 into 0.
    format!("{x:.decimals$}").parse().unwrap_or(x) + 0.0
}

/// Removes the trailing zeros of a number's decimals, and the point if no decimals remain.
fn trimmed(digits: &str) -> &str {
    if digits.contains('.') {
        digits.trim_end_matches('0').trim_end_matches('.')
    } else {
        digits
    }
}

/// Formats a vector or point in the language's notation, with [`short`] numbers.
pub fn short_vector(v: DVec3) -> String {
    format!("({}, {}, {})", short(v.x), short(v.y), short(v.z))
}

/// Formats a count with its digits in groups of three, as in `1_000_000`.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('_');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_the_digits_that_matter() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.75, "-2.75"),
            (39.966_123, "39.9661"),
            (1234.5678, "1234.57"),
            (123_456_789.0, "123456789"),
            (0.000_123_456_7, "0.000123457"),
            (0.1 + 0.2, "0.3"),
            (1e-7, "1e-7"),
            (1.234_567e12, "1.23457e12"),
            (9.999_999_9, "10"),
        ];
        for (x, text) in cases {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn a_bound_is_rounded_up_by_no_more_than_its_last_digit() {
        for (bound, text) in [
            (0.0, "0"),
            (2.5e-10, "2.5e-10"),
            (2.53e-10, "2.6e-10"),
            (2.57e-10, "2.6e-10"),
            (9.93e-13, "1.0e-12"),
            (1.01, "1.1e0"),
        ] {
            assert_eq!(at_most(bound), text);
        }
    }

    #[test]
    fn digits_that_decide_are_shown() {
        assert_eq!(comparable(5.000_000_1, &[5.0]), "5.0000001");
        assert_eq!(comparable(5.000_000_1, &[4.0, 6.0]), "5");
        assert_eq!(comparable(5.0, &[5.0]), "5");
        assert_eq!(comparable(1e-300, &[0.0]), "1e-300");
        assert_eq!(comparable(1.000_000_1e-300, &[1e-300]), "1.0000001e-300");
    }

    #[test]
    fn counts_are_grouped_as_the_language_reads_them() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1234), "1_234");
        assert_eq!(grouped(14_745_600), "14_745_600");
    }
}
