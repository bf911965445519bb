//! What is wrong with a value.

use super::{
    known::is_function,
    shorten,
    tokens::{Kind, Token, tokens},
};
use crate::{
    source::Span,
    syntax::{
        Problem,
        error::Meant,
        tree::{Value, ValueKind},
    },
};

/// A value of a `--set` argument that could not be understood.
pub fn value(text: &str, span: Span) -> Problem {
    wrong_value(text, span, &tokens(text, span)).unwrap_or_else(|| unexpected_value(text, span))
}

/// What is wrong with a value.
pub(super) fn wrong_value(text: &str, span: Span, tokens: &[Token<'_>]) -> Option<Problem> {
    parentheses(span, tokens)
        .or_else(|| separated(text, span, tokens))
        .or_else(|| side_by_side(text, span, tokens))
        .or_else(|| operators(text, span, tokens))
}

/// A parenthesis that is never closed, or that closes nothing.
fn parentheses(span: Span, tokens: &[Token<'_>]) -> Option<Problem> {
    let mut open: Vec<&Token<'_>> = Vec::new();
    for token in tokens {
        if token.is("(") || token.is("[") {
            open.push(token);
        } else if (token.is(")") || token.is("]")) && open.pop().is_none() {
            return Some(stray_parenthesis(token, span));
        }
    }
    open.last().map(|token| Problem::UnclosedParenthesis {
        span: token.span(span),
    })
}

pub(super) fn stray_parenthesis(token: &Token<'_>, span: Span) -> Problem {
    Problem::StrayClosing {
        sign: token.text.to_owned(),
        span: token.span(span),
        all: token.span(span),
        help: "take it away, or write the `(` that it is to close".to_owned(),
    }
}

/// Values with commas between and no parentheses around: `1,5` or `0, 1, 0`.
fn separated(text: &str, span: Span, tokens: &[Token<'_>]) -> Option<Problem> {
    let mut depth = 0_usize;
    let mut commas = Vec::new();
    for token in tokens {
        match token.text {
            "(" | "[" => depth += 1,
            ")" | "]" => depth = depth.saturating_sub(1),
            "," if depth == 0 => commas.push(token),
            _ => {}
        }
    }
    let (first, last) = (tokens.first()?, tokens.last()?);
    let comma = commas.first()?;
    if last.is(",") || first.is(",") {
        return Some(Problem::NeedlessSeparator {
            sign: ",".to_owned(),
            between: "fields",
            span: if last.is(",") { last } else { first }.span(span),
        });
    }
    let whole = first.span(span).to(last.span(span));
    let digits = |token: &Token<'_>| token.text.bytes().all(|byte| byte.is_ascii_digit());
    if let [.., left, middle, right] = tokens
        && commas.len() == 1
        && middle.is(",")
        && digits(left)
        && digits(right)
        && left.end == middle.start
        && middle.end == right.start
    {
        return Some(Problem::DecimalComma {
            number: format!("{}.{}", left.text, right.text),
            span: comma.span(span),
        });
    }
    let values = text.get(whole.range()).unwrap_or_default();
    Some(Problem::MissingParentheses {
        values: shorten(values),
        span: whole,
        together: format!("({values})"),
    })
}

/// Three numbers with nothing between and no parentheses around: `0 1 0`.
fn side_by_side(text: &str, span: Span, tokens: &[Token<'_>]) -> Option<Problem> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    let whole = first.span(span).to(last.span(span));
    let mut values: Vec<String> = Vec::new();
    let mut sign: Option<&Token<'_>> = None;
    for token in tokens {
        match token.kind {
            Kind::Sign if token.is("-") && sign.is_none() => sign = Some(token),
            Kind::Number => {
                // `0 -2 8` has three numbers, `0 - 2 8` two.
                if sign.is_some_and(|sign| sign.end < token.start) {
                    return None;
                }
                let from = sign.take().map_or(token.start, |sign| sign.start);
                let range = span.start + from..span.start + token.end;
                values.push(text.get(range).unwrap_or_default().to_owned());
            }
            _ => return None,
        }
        if values.len() > 3 {
            return None;
        }
    }
    (values.len() == 3 && sign.is_none()).then(|| Problem::MissingParentheses {
        values: shorten(&values.join(", ")),
        span: whole,
        together: format!("({})", values.join(", ")),
    })
}

/// An operator without its operand, or a sign that is none.
fn operators(text: &str, span: Span, tokens: &[Token<'_>]) -> Option<Problem> {
    let mut before: Option<&Token<'_>> = None;
    for (index, token) in tokens.iter().enumerate() {
        let after_value = before.is_some_and(Token::ends_value);
        if token.kind == Kind::Odd {
            return Some(match token.text {
                "°" => degree_sign(before, token, span),
                "^" | "**" | "%" | "×" | "·" | "÷" | "−" | "&" | "|" | "!" | "<" | ">" | "~" => {
                    unknown_operator(token.text, token.span(span))
                }
                _ => unexpected_value(token.text, token.span(span)),
            });
        }
        if token.is_operator() && !after_value && !token.is("-") && !token.is("+") {
            return Some(missing_operand(
                before.filter(|b| b.is_operator()),
                token,
                span,
            ));
        }
        if (token.is(")") || token.is(",")) && before.is_some_and(Token::is_operator) {
            return before.map(|operator| missing_operand(Some(operator), operator, span));
        }
        let called = token.is("(") && before.is_some_and(|before| before.kind == Kind::Word);
        if token.starts_value() && after_value && !called {
            let (start, end) = group_around(tokens, index);
            let written = |from: usize, to: usize| {
                text.get(span.start + from..span.start + to)
                    .unwrap_or_default()
            };
            let left = before.map_or("", |before| written(start, before.end));
            let right = written(token.start, end);
            return Some(missing_operator(left, right, token.span(span)));
        }
        before = Some(token);
    }
    let last = before.filter(|token| token.is_operator())?;
    Some(missing_operand(Some(last), last, span))
}

/// Where the value before a token starts, and where the one that starts with it ends: parentheses are taken whole.
fn group_around(tokens: &[Token<'_>], index: usize) -> (usize, usize) {
    let (before, after) = tokens.split_at(index.min(tokens.len()));
    let mut depth = 0_usize;
    let first = before.iter().rev().find(|token| {
        depth += usize::from(token.is(")"));
        depth = depth.saturating_sub(usize::from(token.is("(")));
        depth == 0
    });
    let last = after.iter().find(|token| {
        depth += usize::from(token.is("("));
        depth = depth.saturating_sub(usize::from(token.is(")")));
        depth == 0
    });
    (first.map_or(0, |t| t.start), last.map_or(0, |t| t.end))
}

/// A function with nothing around its argument.
fn call_without_parentheses(function: &str, argument: &str, span: Span) -> Problem {
    let (left, right) = (shorten(function), shorten(argument));
    Problem::MissingOperator {
        help: format!("write `{left}({right})`"),
        left,
        right,
        span,
        meant: Meant::Call,
    }
}

/// Two values with nothing between; a function before its argument lacks the parentheses.
pub fn missing_operator(left: &str, right: &str, span: Span) -> Problem {
    let is_number = left.ends_with(|c: char| c.is_ascii_digit() || c == '.')
        && left.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-'));
    if is_number && is_unit(right) {
        return spaced_unit(left, right, span);
    }
    if is_function(left) {
        return call_without_parentheses(left, right, span);
    }
    let colors = [left, right].map(|value| value.starts_with('#'));
    if is_vector(left) | colors[0] && is_vector(right) | colors[1] {
        let help = match colors {
            [false, false] => "write `+` or `-` between them, or take one of them away",
            _ => "take one of them away",
        };
        return Problem::MissingOperator {
            help: help.to_owned(),
            left: shorten(left),
            right: shorten(right),
            span,
            meant: Meant::Unclear,
        };
    }
    let (left, right) = (shorten(left), shorten(right));
    Problem::MissingOperator {
        help: format!("write `{left} * {right}` to multiply them"),
        left,
        right,
        span,
        meant: Meant::Product,
    }
}

/// A value behind that of a field, where the two have no product.
pub fn missing_field(left: &str, right: &str, span: Span) -> Problem {
    let right = shorten(right);
    Problem::MissingOperator {
        help: format!("write the name of the field that `{right}` is for before it"),
        left: shorten(left),
        right,
        span,
        meant: Meant::Field,
    }
}

/// Whether a value is written as a vector: commas stand in the parentheses around it, and in no inner ones.
fn is_vector(value: &str) -> bool {
    let mut depth = 0_usize;
    let parts = value.strip_prefix('(').map(|parts| {
        parts.chars().any(|c| {
            depth += usize::from(c == '(');
            depth = depth.saturating_sub(usize::from(c == ')'));
            c == ',' && depth == 0
        })
    });
    parts.unwrap_or(false)
}

/// A number and a word that is a unit elsewhere.
fn spaced_unit(number: &str, unit: &str, span: Span) -> Problem {
    let joined = match unit {
        "degs" | "degree" | "degrees" => "deg",
        "rads" | "radian" | "radians" => "rad",
        _ => {
            let start = span.start.saturating_sub(number.len());
            let whole = Span::new(span.source, start, span.end);
            return odd_number(&format!("{number}{unit}"), whole);
        }
    };
    let joined = format!("{}{joined}", shorten(number));
    Problem::SpacedUnit { joined, span }
}

/// Whether a word behind a number is taken for a unit, one of the language's or not.
pub fn is_unit(word: &str) -> bool {
    const UNITS: &[&str] = &[
        "degs", "degree", "degrees", "rads", "radian", "radians", "m", "cm", "mm", "km", "px",
        "in", "ft", "s",
    ];
    UNITS.contains(&word)
}

/// The first of two operators has nothing after it; one alone has nothing before it.
fn missing_operand(first: Option<&Token<'_>>, token: &Token<'_>, span: Span) -> Problem {
    let (operator, side) = match first {
        Some(first) => (first, "after"),
        None => (token, "before"),
    };
    Problem::MissingOperand {
        operator: operator.text.to_owned(),
        side,
        span: operator.span(span),
    }
}

/// Something in a value that fits nowhere.
pub fn unexpected_value(written: &str, span: Span) -> Problem {
    let written = match written.get(span.range()) {
        Some(under) if written.len() > 3 => under,
        _ => written,
    };
    Problem::Unexpected {
        written: shorten(written),
        help: "write a value, such as `2`, `30deg`, `(0, 1, 0)` or `olive`".to_owned(),
        span,
    }
}

/// An operator that other languages have.
pub fn unknown_operator(sign: &str, span: Span) -> Problem {
    let help = match sign {
        "^" | "**" => "multiply instead: `x * x` is the square of x".to_owned(),
        "×" | "·" => "write `*` to multiply".to_owned(),
        "÷" => "write `/` to divide".to_owned(),
        "−" => "write a plain `-`; this is the minus sign of a typesetter".to_owned(),
        _ => "the operators are `+`, `-`, `*` and `/`".to_owned(),
    };
    let known = match sign {
        "×" | "·" => Some("*"),
        "÷" => Some("/"),
        "−" => Some("-"),
        _ => None,
    };
    Problem::UnknownOperator {
        sign: shorten(sign),
        help,
        span,
        instead: known.map(|known| (span, known.to_owned())),
    }
}

/// A power: a square and a cube can be written as products.
pub fn power(
    text: &str,
    (base, sign, exponent): (&Value<'_>, Span, &Value<'_>),
    is_divisor: bool,
) -> Problem {
    let written = |span: Span| text.get(span.range()).unwrap_or_default();
    let mut problem = unknown_operator(written(sign), sign);
    let times = match exponent.kind {
        ValueKind::Number("2") => 2,
        ValueKind::Number("3") => 3,
        _ => return problem,
    };
    // `-x^2` is the negative of the square.
    let mut factor = base;
    while let ValueKind::Negation { operand, .. } = &factor.kind {
        factor = operand;
    }
    let signs = written(Span::new(
        base.span.source,
        base.span.start,
        factor.span.start,
    ));
    let factor_text = written(factor.span);
    let can_stand_twice = matches!(
        factor.kind,
        ValueKind::Number(_) | ValueKind::Name(_) | ValueKind::Call(_) | ValueKind::Parentheses(_)
    ) && shorten(factor_text) == factor_text
        && !factor_text.contains("//");
    // A comment between the two is not to be lost.
    let between = Span::new(sign.source, base.span.end, exponent.span.start);
    let can_stand_twice = can_stand_twice && written(between).trim() == written(sign);
    if let (true, Problem::UnknownOperator { help, instead, .. }) = (can_stand_twice, &mut problem)
    {
        let mut product = format!("{signs}{}", vec![factor_text; times].join(" * "));
        if is_divisor {
            product = format!("({product})");
        }
        *help = format!("multiply instead: `{product}`");
        *instead = Some((base.span.to(exponent.span), product));
    }
    problem
}

fn degree_sign(before: Option<&Token<'_>>, sign: &Token<'_>, span: Span) -> Problem {
    let number = before.map_or("", |before| before.text);
    Problem::BadNumber {
        written: shorten(&format!("{number}{}", sign.text)),
        help: format!("write `{}deg`", shorten(number)),
        span: sign.span(span),
        label: "the unit is written `deg`".to_owned(),
        // The sign itself says it.
        instead: None,
    }
}

/// What starts like a number and is none.
pub fn odd_number(written: &str, span: Span) -> Problem {
    let is_digit = |c: char| c.is_ascii_digit() || c == '.' || c == '_';
    let digits = written.find(|c| !is_digit(c)).unwrap_or(written.len());
    let (number, word) = written.split_at_checked(digits).unwrap_or((written, ""));
    let lower = word.to_ascii_lowercase();
    let at = number.len();
    // With a unit that the number was to have, what is meant can be written.
    let (help, label, unit) = match lower.as_str() {
        "" if number.matches('.').count() > 1 => (
            "write one decimal point".to_owned(),
            "more than one point".to_owned(),
            None,
        ),
        "" => (
            format!(
                "write `{}`, or `_` between two digits only",
                number.replace('_', "")
            ),
            "`_` stands between two digits".to_owned(),
            Some(""),
        ),
        "px" | "s" => (
            format!("write `{number}`; only angles have a unit"),
            format!("`{word}` is no unit"),
            Some(""),
        ),
        "m" | "cm" | "mm" | "km" | "in" | "ft" => (
            format!("write `{number}`; all lengths are in metres"),
            format!("`{word}` is no unit; only angles have one"),
            Some(""),
        ),
        "d" | "de" | "degs" | "degree" | "degrees" | "grad" | "dge" | "deg" => (
            format!("write `{number}deg`"),
            format!("`{word}` is no unit"),
            Some("deg"),
        ),
        "r" | "ra" | "rads" | "radian" | "radians" | "rda" | "rad" => (
            format!("write `{number}rad`"),
            format!("`{word}` is no unit"),
            Some("rad"),
        ),
        "e" => (
            format!("write the exponent, such as `{number}e3`"),
            "the digits of the exponent are missing".to_owned(),
            None,
        ),
        _ if lower
            .strip_prefix('e')
            .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) =>
        {
            (
                format!("write a whole exponent, such as `{number}e3`"),
                "the exponent is no whole number".to_owned(),
                None,
            )
        }
        _ if number == "0" && lower.starts_with(['x', 'b', 'o']) => (
            "write it in decimal digits; a colour is written `#ffaa00`".to_owned(),
            "numbers are decimal".to_owned(),
            None,
        ),
        _ if !number.contains("__") && !number.ends_with('_') => (
            format!("write `{number} * {word}` to multiply; the units are `deg` and `rad`"),
            format!("`{word}` is no unit"),
            Some(" * "),
        ),
        _ => (
            "write digits, with one `.` among them if need be".to_owned(),
            "not a number".to_owned(),
            None,
        ),
    };
    let start = if word.is_empty() {
        span.start
    } else {
        span.start + at
    };
    let digits = number.replace('_', "");
    let instead = unit.map(|unit| match word {
        "" => [digits.clone(), digits],
        _ if unit == " * " => [format!("{number} * {word}"), format!(" * {word}")],
        _ => [format!("{number}{unit}"), unit.to_owned()],
    });
    Problem::BadNumber {
        written: shorten(written),
        help,
        span: Span::new(span.source, start, span.end),
        label,
        instead,
    }
}
