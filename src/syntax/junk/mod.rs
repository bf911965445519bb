//! What is wrong with what could not be understood.
//!
//! In: a piece of text that the grammar's junk rules ate. Out: one problem, at the place where it stops making sense, in
//! the author's words. It is read again here token by token, and strictly.

mod items;
mod known;
mod tokens;
mod values;

pub use items::{head, lines};
pub use known::is_kind;
pub use values::{
    is_unit, missing_field, missing_operator, odd_number, power, unexpected_value,
    unknown_operator, value,
};

use self::{
    tokens::{Kind, Token, Tokens, tokens},
    values::{stray_parenthesis, wrong_value},
};
use super::{Problem, error::Meant, tree::Name};
use crate::source::Span;

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
        (Some(_), false) => {
            wrong_value(text, span, &tokens).map(|problem| of_field(problem, &tokens, span))
        }
        (None, false) => Some(no_field(text, span, &tokens)),
    };
    (name, problem)
}

/// What stands behind a field's vector may be another field's, unless it stands in parentheses with it.
fn of_field(problem: Problem, tokens: &[Token<'_>], within: Span) -> Problem {
    let Problem::MissingOperator {
        left,
        right,
        span,
        meant: Meant::Unclear,
        ..
    } = &problem
    else {
        return problem;
    };
    let before = tokens
        .iter()
        .filter(|token| token.span(within).end <= span.start);
    let open = before.fold(0_i64, |open, token| {
        open + i64::from(token.is("(")) - i64::from(token.is(")"))
    });
    match open {
        0 => missing_field(left, right, *span),
        _ => problem,
    }
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
