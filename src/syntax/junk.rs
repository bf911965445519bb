//! What is wrong with what could not be understood.
//!
//! In: a piece of text that the grammar's junk rules ate. Out: one problem, at the place where it stops making sense, in
//! the author's words. It is read again here token by token, and strictly.

use super::{Problem, comments::is_odd_space, tree::Name};
use crate::{source::Span, suggest};

/// What stands at some place, in a message: on one line, and not too long.
pub fn shorten(written: &str) -> String {
    const LONGEST: usize = 40;
    let mut short = String::new();
    for (index, word) in written.split_whitespace().enumerate() {
        if index > 0 {
            short.push(' ');
        }
        short.extend(word.chars().take(LONGEST + 1));
        if short.chars().count() > LONGEST {
            let mut cut: String = short.chars().take(LONGEST).collect();
            cut.push('…');
            return cut;
        }
    }
    short
}

/// The length of a text without the white space and the comments at its end.
pub fn written_length(text: &str) -> usize {
    Tokens::new(text, 0).last().map_or(0, |token| token.end)
}

/// A field that could not be understood: its name, if it has one, and what is wrong with it. A field without anything
/// after its name has no problem here, nor has one that is right in itself.
pub fn field<'s>(text: &'s str, span: Span) -> (Option<Name<'s>>, Option<Problem>) {
    let mut tokens = tokens(text, span);
    let name = match tokens.first() {
        Some(token) if token.kind == Kind::Word => {
            let name = token.name(text, span);
            tokens.remove(0);
            Some(name)
        }
        _ => None,
    };
    let equals = tokens.first().copied().filter(|t| t.is("=") || t.is(":"));
    if equals.is_some() {
        tokens.remove(0);
    }
    let problem = match (&name, tokens.is_empty()) {
        (Some(_), true) => None,
        (None, true) => Some(unexpected("", span)),
        (Some(_), false) => wrong_value(text, span, &tokens),
        (None, false) => Some(no_field(text, span, &tokens)),
    };
    (name, problem)
}

fn no_field(text: &str, span: Span, tokens: &[Token<'_>]) -> Problem {
    let first = tokens.first().map_or(span, |token| token.span(span));
    let all_separators = tokens.iter().all(|token| token.is(",") || token.is(";"));
    match tokens.first() {
        Some(token) if all_separators => Problem::NeedlessSeparator {
            sign: token.text.to_owned(),
            between: "fields",
            span: first,
        },
        Some(token) if token.is("{") => Problem::NestedBraces { span: first },
        Some(token) if token.is(")") || token.is("]") => stray_parenthesis(token, span),
        _ => {
            let help = "write a field's name and its value, such as `radius 2`".to_owned();
            Problem::Unexpected {
                written: shorten(text.get(span.range()).unwrap_or_default()),
                help,
                span,
            }
        }
    }
}

/// A definition that could not be understood: its name, if it has one, and what is wrong with it.
pub fn definition<'s>(text: &'s str, span: Span) -> (Option<Name<'s>>, Problem) {
    let tokens = tokens(text, span);
    let mut rest = tokens.get(1..).unwrap_or_default();
    let keyword = tokens.first().map_or(span, |token| token.span(span));
    let Some((first, after)) = rest.split_first() else {
        return (None, Problem::MissingName { span: keyword });
    };
    if first.is("=") || first.is(":") {
        let span = first.span(span);
        return (None, Problem::MissingName { span });
    }
    // A name goes on up to the `=`: what is no name in it is the mistake.
    let equals = rest.iter().position(|token| token.is("=") || token.is(":"));
    if let Some(count) = equals
        && (count > 1 || first.kind != Kind::Word)
        && let Some(last) = rest.get(count - 1)
    {
        let span = first.span(span).to(last.span(span));
        let written = shorten(text.get(span.range()).unwrap_or_default());
        return (None, Problem::BadName { written, span });
    }
    if first.kind != Kind::Word {
        let written = shorten(first.text);
        let span = first.span(span);
        return (None, Problem::BadName { written, span });
    }
    let name = first.name(text, span);
    rest = after;
    let Some((equals, value)) = rest.split_first() else {
        let problem = Problem::MissingValue {
            name: name.text.to_owned(),
            span: name.span,
        };
        return (Some(name), problem);
    };
    if !equals.is("=") && !equals.is(":") {
        let value = Span::new(span.source, equals.span(span).start, span.end);
        let problem = Problem::MissingEquals {
            name: name.text.to_owned(),
            value: shorten(text.get(value.range()).unwrap_or_default()),
            span: equals.span(span),
        };
        return (Some(name), problem);
    }
    let problem = if value.is_empty() {
        Problem::MissingValue {
            name: name.text.to_owned(),
            span: name.span.to(equals.span(span)),
        }
    } else {
        wrong_value(text, span, value).unwrap_or_else(|| unexpected_value(text, span))
    };
    (Some(name), problem)
}

/// A value of a `--set` argument that could not be understood.
pub fn value(text: &str, span: Span) -> Problem {
    wrong_value(text, span, &tokens(text, span)).unwrap_or_else(|| unexpected_value(text, span))
}

/// What is wrong with a value.
fn wrong_value(text: &str, span: Span, tokens: &[Token<'_>]) -> Option<Problem> {
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

fn stray_parenthesis(token: &Token<'_>, span: Span) -> Problem {
    Problem::StrayClosing {
        sign: token.text.to_owned(),
        span: token.span(span),
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
pub fn call_without_parentheses(function: &str, argument: &str, span: Span) -> Problem {
    let (left, right) = (shorten(function), shorten(argument));
    Problem::MissingOperator {
        help: format!("write `{left}({right})`"),
        left,
        right,
        span,
    }
}

/// Two values with nothing between.
pub fn missing_operator(left: &str, right: &str, span: Span) -> Problem {
    let is_number = left.ends_with(|c: char| c.is_ascii_digit() || c == '.')
        && left.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-'));
    if is_number && is_unit(right) {
        return spaced_unit(left, right, span);
    }
    let (left, right) = (shorten(left), shorten(right));
    let word = left.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let number = right.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let help = match word && number {
        true => format!(
            "write `{left} * {right}` to multiply them, or `{left}({right})` if `{left}` is a function"
        ),
        false => format!("write `{left} * {right}` to multiply them"),
    };
    Problem::MissingOperator {
        left,
        right,
        help,
        span,
    }
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

/// What stands before a `{` and is more than a kind and a name.
pub fn head<'s>(
    text: &'s str,
    odd: Span,
    open: Span,
) -> (Option<Name<'s>>, Option<Name<'s>>, Problem) {
    let tokens = tokens(text, odd);
    let Some((first, rest)) = tokens.split_first() else {
        return (None, None, Problem::MissingKind { span: open });
    };
    let kind = (first.kind == Kind::Word).then(|| first.name(text, odd));
    let second = rest.first().filter(|token| token.kind == Kind::Word);
    let name = second.map(|token| token.name(text, odd));
    let mut right = String::new();
    for name in [kind, name].into_iter().flatten() {
        right.push_str(name.text);
        right.push(' ');
    }
    if let (Some(kind), Some(token)) = (kind, rest.first())
        && token.kind == Kind::Quoted
    {
        let inner = token.text.trim_matches(['"', '\'']);
        let inner = inner.replace(' ', "_");
        let problem = Problem::Quoted {
            what: "a name",
            inner: format!("{} {} {{", kind.text, shorten(&inner)),
            span: token.span(odd),
        };
        return (Some(kind), None, problem);
    }
    if let [name, equals, kind] = tokens.as_slice()
        && equals.is("=")
        && name.kind == Kind::Word
        && kind.kind == Kind::Word
    {
        let help = format!("write `{} {} {{`", kind.text, name.text);
        let span = name.span(odd).to(equals.span(odd));
        let (kind, name) = (kind.name(text, odd), name.name(text, odd));
        return (Some(kind), Some(name), Problem::BadHead { help, span });
    }
    if let (Some(kind), Some(first), Some(last)) = (kind, rest.first(), rest.last())
        && rest.len() > 1
        && rest
            .windows(2)
            .all(|two| matches!(two, [a, b] if a.end == b.start))
        && rest
            .iter()
            .all(|t| t.is("-") || t.is(".") || matches!(t.kind, Kind::Word | Kind::Number))
        && first.kind == Kind::Word
    {
        let span = first.span(odd).to(last.span(odd));
        let joined = text.get(span.range()).unwrap_or_default();
        let help = format!(
            "write `{} {} {{`",
            kind.text,
            shorten(&joined.replace(['-', '.'], "_"))
        );
        return (Some(kind), name, Problem::BadHead { help, span });
    }
    let wrong = match (kind, name) {
        (None, _) => Some(first),
        (Some(_), None) => rest.first(),
        (Some(_), Some(_)) => rest.get(1),
    };
    let from = wrong.map_or(odd, |token| token.span(odd));
    let to = tokens.last().map_or(odd, |token| token.span(odd));
    let help = match right.as_str() {
        "" => "write the block's kind before it, such as `sphere {`".to_owned(),
        right => format!("write `{right}{{`"),
    };
    let span = from.to(to);
    (kind, name, Problem::BadHead { help, span })
}

/// Lines outside of blocks that are no items.
pub fn lines(text: &str, odd: Span, close: Option<Span>, previous: Option<Span>) -> Problem {
    let tokens = tokens(text, odd);
    let Some((first, rest)) = tokens.split_first() else {
        return unexpected(text, close.unwrap_or(odd));
    };
    let place = first.span(odd);
    let same_line = |from: usize, to: usize| !text.get(from..to).unwrap_or_default().contains('\n');
    if let Some(value) = previous
        && same_line(value.end, place.start)
        && first.starts_value()
    {
        let left = text.get(value.range()).unwrap_or_default();
        return missing_operator(left, first.text, place);
    }
    if tokens.iter().all(|token| token.is(",") || token.is(";")) {
        return Problem::NeedlessSeparator {
            sign: first.text.to_owned(),
            between: "items",
            span: place,
        };
    }
    if first.is(")") || first.is("]") {
        return stray_parenthesis(first, odd);
    }
    if first.kind != Kind::Word {
        return unexpected(first.text, place);
    }
    if let Some(problem) = missing_let(text, odd, &tokens) {
        return problem;
    }
    let name = first.text.to_owned();
    let second = rest.first();
    // `sphere Ball`, and then fields: the `{` is missing. `radius 2`: a field that stands outside.
    let alone = second.is_none_or(|token| !same_line(place.end, token.span(odd).start));
    // `sphere center (0, 1, 0)`, `sphere color red`: the second word is a field.
    let field = rest.len() == 2 || rest.get(1).is_some_and(|third| third.kind != Kind::Word);
    let in_parentheses = matches!(rest, [name, open, ..] if name.kind == Kind::Word && open.is("("))
        && matches!(rest.get(2..4), Some([a, b]) if a.kind == Kind::Word && b.starts_value());
    let opened = close.is_some() || (alone && rest.len() > 1) || in_parentheses;
    let head_only = !field || in_parentheses;
    let named = second.filter(|token| token.kind == Kind::Word && !alone);
    if opened && (alone || named.is_some()) {
        let named = named.filter(|_| head_only);
        let head = match named {
            Some(token) => format!("{name} {}", token.text),
            None => name,
        };
        let span = named.map_or(place, |token| place.to(token.span(odd)));
        return Problem::UnopenedBlock {
            block: format!("the block `{}`", shorten(&head)),
            head: shorten(&head),
            span,
        };
    }
    Problem::OutsideBlock {
        name: shorten(&name),
        span: place,
    }
}

/// What other languages write for `let`.
const OTHER_LETS: &[&str] = &[
    "var", "const", "def", "define", "set", "val", "auto", "local", "int", "float", "double",
    "number", "vec3", "vector",
];

/// `x = 3`, and what may have been `let x = 3`.
fn missing_let(text: &str, odd: Span, tokens: &[Token<'_>]) -> Option<Problem> {
    let (name, label, equals) = match tokens {
        [name, equals, ..] if equals.is("=") => {
            let place = name.span(odd);
            match name.text.strip_prefix("let") {
                Some(rest) if !rest.is_empty() => {
                    let start = place.start + "let".len();
                    (Span::new(odd.source, start, place.end), place, equals)
                }
                _ => (place, place, equals),
            }
        }
        [word, name, equals, ..]
            if equals.is("=")
                && name.kind == Kind::Word
                && (OTHER_LETS.contains(&word.text)
                    || suggest::nearest(word.text, ["let"]).is_some()) =>
        {
            (name.span(odd), word.span(odd), equals)
        }
        _ => return None,
    };
    let from = equals.span(odd).end;
    let value = text.get(from..line_end(text, from)).unwrap_or_default();
    Some(Problem::MissingLet {
        name: text.get(name.range()).unwrap_or_default().to_owned(),
        value: shorten(value),
        place: name,
        span: label,
    })
}

fn line_end(text: &str, from: usize) -> usize {
    let rest = text.get(from..).unwrap_or_default();
    from + rest.find('\n').unwrap_or(rest.len())
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

/// What a character that cannot be seen is called.
pub fn name_of_space(text: &str) -> String {
    let character = text.chars().next().unwrap_or_default();
    let name = match character {
        '\0' => "a NUL",
        '\u{A0}' => "a no-break space",
        '\u{202F}' => "a narrow no-break space",
        '\u{200B}' => "a zero-width space",
        '\u{200C}' => "a zero-width non-joiner",
        '\u{200D}' => "a zero-width joiner",
        '\u{FEFF}' => "a byte order mark",
        '\u{3000}' => "an ideographic space",
        c if c.is_whitespace() => "a space",
        _ => "a control character",
    };
    format!("U+{:04X}, {name},", u32::from(character))
}

/// Something that fits nowhere.
pub fn unexpected(written: &str, span: Span) -> Problem {
    let written = match written.get(span.range()) {
        Some(under) if written.len() > 3 => under,
        _ => written,
    };
    Problem::Unexpected {
        written: shorten(written),
        help: "a file holds `let NAME = VALUE` and blocks such as `sphere { radius 2 }`".to_owned(),
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
    Problem::UnknownOperator {
        sign: shorten(sign),
        help,
        span,
    }
}

fn degree_sign(before: Option<&Token<'_>>, sign: &Token<'_>, span: Span) -> Problem {
    let number = before.map_or("", |before| before.text);
    Problem::BadNumber {
        written: shorten(&format!("{number}{}", sign.text)),
        help: format!("write `{}deg`", shorten(number)),
        span: sign.span(span),
        label: "the unit is written `deg`".to_owned(),
    }
}

/// What starts like a number and is none.
pub fn odd_number(written: &str, span: Span) -> Problem {
    let is_digit = |c: char| c.is_ascii_digit() || c == '.' || c == '_';
    let digits = written.find(|c| !is_digit(c)).unwrap_or(written.len());
    let (number, word) = written.split_at_checked(digits).unwrap_or((written, ""));
    let lower = word.to_ascii_lowercase();
    let at = number.len();
    let (help, label) = match lower.as_str() {
        "" if number.matches('.').count() > 1 => (
            "write one decimal point".to_owned(),
            "more than one point".to_owned(),
        ),
        "" => (
            format!(
                "write `{}`, or `_` between two digits only",
                number.replace('_', "")
            ),
            "`_` stands between two digits".to_owned(),
        ),
        "px" | "s" => (
            format!("write `{number}`; only angles have a unit"),
            format!("`{word}` is no unit"),
        ),
        "m" | "cm" | "mm" | "km" | "in" | "ft" => (
            format!("write `{number}`; all lengths are in metres"),
            format!("`{word}` is no unit; only angles have one"),
        ),
        "d" | "de" | "degs" | "degree" | "degrees" | "grad" | "dge" | "deg" => (
            format!("write `{number}deg`"),
            format!("`{word}` is no unit"),
        ),
        "r" | "ra" | "rads" | "radian" | "radians" | "rda" | "rad" => (
            format!("write `{number}rad`"),
            format!("`{word}` is no unit"),
        ),
        "e" => (
            format!("write the exponent, such as `{number}e3`"),
            "the digits of the exponent are missing".to_owned(),
        ),
        _ if lower
            .strip_prefix('e')
            .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) =>
        {
            (
                format!("write a whole exponent, such as `{number}e3`"),
                "the exponent is no whole number".to_owned(),
            )
        }
        _ if number == "0" && lower.starts_with(['x', 'b', 'o']) => (
            "write it in decimal digits; a colour is written `#ffaa00`".to_owned(),
            "numbers are decimal".to_owned(),
        ),
        _ if !number.contains("__") && !number.ends_with('_') => (
            format!("write `{number} * {word}` to multiply; the units are `deg` and `rad`"),
            format!("`{word}` is no unit"),
        ),
        _ => (
            "write digits, with one `.` among them if need be".to_owned(),
            "not a number".to_owned(),
        ),
    };
    let start = if word.is_empty() {
        span.start
    } else {
        span.start + at
    };
    Problem::BadNumber {
        written: shorten(written),
        help,
        span: Span::new(span.source, start, span.end),
        label,
    }
}

fn tokens<'s>(text: &'s str, span: Span) -> Vec<Token<'s>> {
    // A piece of junk can be a megabyte; what is wrong with it shows at its beginning.
    const ENOUGH: usize = 10_000;
    let written = text.get(span.range()).unwrap_or_default();
    Tokens::new(written, 0).take(ENOUGH).collect()
}

/// A token of junk.
#[derive(Clone, Copy, Debug)]
struct Token<'s> {
    kind: Kind,
    text: &'s str,
    start: usize,
    end: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Word,
    Number,
    Color,
    Quoted,
    /// A sign that the language has.
    Sign,
    /// A sign that it has not, or not within a value.
    Odd,
}

impl<'s> Token<'s> {
    fn is(&self, text: &str) -> bool {
        self.text == text
    }

    fn is_operator(&self) -> bool {
        matches!(self.text, "+" | "-" | "*" | "/")
    }

    fn starts_value(&self) -> bool {
        !matches!(self.kind, Kind::Sign | Kind::Odd) || self.is("(")
    }

    fn ends_value(&self) -> bool {
        !matches!(self.kind, Kind::Sign | Kind::Odd) || self.is(")")
    }

    fn span(&self, within: Span) -> Span {
        Span::new(
            within.source,
            within.start + self.start,
            within.start + self.end,
        )
    }

    fn name(&self, text: &'s str, within: Span) -> Name<'s> {
        let span = self.span(within);
        Name {
            text: text.get(span.range()).unwrap_or_default(),
            span,
        }
    }
}

/// The tokens of a text; comments and white space are passed over.
struct Tokens<'s> {
    text: &'s str,
    at: usize,
}

impl<'s> Tokens<'s> {
    fn new(text: &'s str, at: usize) -> Self {
        Self { text, at }
    }

    fn rest(&self) -> &'s str {
        self.text.get(self.at..).unwrap_or_default()
    }

    fn skip_gap(&mut self) {
        loop {
            let rest = self.rest();
            let gap = |c: char| matches!(c, ' ' | '\t' | '\r' | '\n') || is_odd_space(c);
            let trimmed = rest.trim_start_matches(gap);
            self.at += rest.len() - trimmed.len();
            let length = if trimmed.starts_with("//") {
                trimmed.find('\n')
            } else if trimmed.starts_with("/*") {
                trimmed.find("*/").map(|end| end + 2)
            } else {
                return;
            };
            self.at += length.unwrap_or(trimmed.len());
        }
    }
}

impl<'s> Iterator for Tokens<'s> {
    type Item = Token<'s>;

    fn next(&mut self) -> Option<Token<'s>> {
        self.skip_gap();
        let rest = self.rest();
        let first = rest.chars().next()?;
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let run = |is: &dyn Fn(char) -> bool| rest.find(|c| !is(c)).unwrap_or(rest.len());
        let point = rest.strip_prefix('.');
        let (kind, length) = match first {
            '0'..='9' => (Kind::Number, run(&|c| is_word(c) || c == '.')),
            '.' if point.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) => {
                (Kind::Number, run(&|c| is_word(c) || c == '.'))
            }
            '#' => (Kind::Color, 1 + run_after(rest, is_word)),
            '"' | '\'' => {
                let inner = rest.get(1..).unwrap_or_default();
                let end = inner.find([first, '\n']);
                let closed = end.is_some_and(|end| inner.as_bytes().get(end) != Some(&b'\n'));
                let length = end.map_or(rest.len(), |end| 1 + end + usize::from(closed));
                (Kind::Quoted, length)
            }
            _ if is_word(first) => (Kind::Word, run(&is_word)),
            '+' | '-' | '*' | '/' | '(' | ')' | ',' | '[' | ']' if !rest.starts_with("**") => {
                (Kind::Sign, 1)
            }
            '*' => (Kind::Odd, 2),
            _ => (Kind::Odd, first.len_utf8()),
        };
        let start = self.at;
        self.at += length;
        Some(Token {
            kind,
            text: self.text.get(start..self.at).unwrap_or_default(),
            start,
            end: self.at,
        })
    }
}

fn run_after(rest: &str, is: impl Fn(char) -> bool) -> usize {
    let inner = rest.get(1..).unwrap_or_default();
    inner.find(|c| !is(c)).unwrap_or(inner.len())
}
