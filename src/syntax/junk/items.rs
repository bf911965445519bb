//! What is wrong outside of blocks, and with their heads.

use super::{
    missing_operator, shorten, stray_parenthesis,
    tokens::{Kind, Token, tokens},
    unexpected,
};
use crate::{
    source::Span,
    suggest,
    syntax::{Problem, tree::Name},
};

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
        let problem = Problem::BadHead {
            help: format!("write `{} {} {{`", kind.text, name.text),
            span: name.span(odd).to(equals.span(odd)),
            instead: Some((
                name.span(odd).to(kind.span(odd)),
                format!("{} {}", kind.text, name.text),
            )),
        };
        let (kind, name) = (kind.name(text, odd), name.name(text, odd));
        return (Some(kind), Some(name), problem);
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
        let joined = joined.replace(['-', '.'], "_");
        let problem = Problem::BadHead {
            help: format!("write `{} {} {{`", kind.text, shorten(&joined)),
            span,
            instead: Some((span, joined)),
        };
        return (Some(kind), name, problem);
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
    let instead =
        (!right.is_empty()).then(|| (first.span(odd).to(to), right.trim_end().to_owned()));
    let problem = Problem::BadHead {
        help,
        span: from.to(to),
        instead,
    };
    (kind, name, problem)
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
