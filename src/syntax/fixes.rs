//! What can be done about problems of syntax.

use super::{
    Problem,
    error::Meant,
    junk::{shorten, written_length},
};
use crate::{
    diagnostic::{Edit, Fix, Fixable, with_comments},
    source::{Sources, Span},
};

impl Fixable for Problem {
    fn is_needless(&self) -> bool {
        matches!(
            self,
            Self::NeedlessEquals { .. }
                | Self::NeedlessSeparator { .. }
                | Self::NeedlessComma { .. }
                | Self::PlusSign { .. }
        )
    }

    fn is_of_syntax(&self) -> bool {
        true
    }

    fn is_fix_doubtful(&self) -> bool {
        match self {
            Self::UnclosedComment { .. }
            | Self::UnclosedParenthesis { .. }
            | Self::BadHead { .. }
            | Self::UnopenedBlock { .. } => true,
            // What is multiplied may be no number, or the product no angle.
            Self::BadNumber { instead, .. } => {
                let instead = instead.as_ref();
                instead.is_some_and(|[_, part]| part.starts_with(" * "))
            }
            _ => false,
        }
    }

    fn fixes(&self, sources: &Sources) -> Vec<Fix> {
        match self {
            Self::OddSpace { places, span, .. } => odd_spaces(places, sources.text(*span)),
            Self::LoneReturn { span } => {
                let text = sources.get(span.source).text();
                let returns = text.match_indices('\r');
                let lone = returns.filter(|(at, _)| text.as_bytes().get(at + 1) != Some(&b'\n'));
                let edits = lone.map(|(at, _)| {
                    Edit::new(
                        Span::new(span.source, at, at + 1),
                        sources.get(span.source).line_end(),
                    )
                });
                vec![Fix::new("end these lines as text files do", edits)]
            }
            Self::ForeignComment { right, places, .. } => vec![Fix::new(
                format!("write `{right}`"),
                places.iter().map(|place| Edit::new(*place, "//")),
            )],
            Self::UnclosedComment { span } => unclosed_comment(*span, sources),
            Self::UnclosedParenthesis { span } => unclosed_parenthesis(*span, sources),
            Self::UnclosedBlock {
                kind, open, end, ..
            } => {
                let written = sources.text(open.to(*end));
                let apart = match written.contains('\n') {
                    true => sources.get(open.source).line_end(),
                    false => " ",
                };
                vec![Fix::new(
                    format!("close the block of `{kind}`"),
                    [Edit::new(*end, format!("{apart}}}"))],
                )]
            }
            Self::StrayClosing {
                sign, all: span, ..
            }
            | Self::MissingOperand {
                operator: sign,
                span,
                ..
            }
            | Self::NeedlessSeparator { sign, span, .. } => {
                vec![Fix::remove(format!("remove this `{sign}`"), *span, sources)]
            }
            Self::NeedlessEquals {
                name, value, span, ..
            } => vec![Fix::remove(
                format!("write `{name} {value}`"),
                *span,
                sources,
            )],
            Self::NeedlessComma { span, .. } => {
                vec![Fix::remove("remove this comma", *span, sources)]
            }
            // The blank before the sign stands before the value then.
            Self::PlusSign { value, span } => {
                vec![Fix::new(format!("write `{value}`"), [Edit::new(*span, "")])]
            }
            Self::MissingEquals { name, value, span } => {
                let edit = match sources.text(*span) {
                    ":" => Edit::new(gap_before(*span, sources).to(*span), " ="),
                    _ => Edit::insert(span.source, span.start, "= "),
                };
                vec![Fix::new(format!("write `let {name} = {value}`"), [edit])]
            }
            Self::MissingOperator {
                left,
                right,
                span,
                meant,
                ..
            } => match meant {
                Meant::Product => vec![product(left, right, *span, sources)],
                Meant::Call => vec![call(left, right, *span, sources)],
                Meant::Field | Meant::Unclear => Vec::new(),
            },
            Self::MissingComma { whole, places, .. } => vec![Fix::new(
                format!("write `{whole}`"),
                places.iter().map(|place| Edit::new(*place, ",")),
            )],
            Self::DecimalComma { number, span } => vec![Fix::new(
                format!("write `{number}`"),
                [Edit::new(*span, ".")],
            )],
            Self::MissingParentheses {
                values,
                span,
                together,
            } => vec![Fix::new(
                format!("write `({values})`"),
                [Edit::new(*span, together)],
            )],
            Self::Brackets { inner, span } => {
                let Span { source, start, end } = *span;
                let ends = [(start, "("), (end.saturating_sub(1), ")")];
                vec![Fix::new(
                    format!("write `({inner})`"),
                    ends.map(|(at, sign)| Edit::new(Span::new(source, at, at + 1), sign)),
                )]
            }
            Self::UnknownOperator { instead, .. } => {
                let fix = instead.as_ref();
                let fix = fix.map(|(place, text)| Fix::write(*place, text));
                fix.into_iter().collect()
            }
            Self::Quoted { what, span, .. } => {
                let inner = sources.text(*span).trim_matches(['"', '\'']).trim();
                let inner = match *what {
                    "a name" => inner.replace(' ', "_"),
                    _ => inner.to_owned(),
                };
                match inner.is_empty() {
                    true => Vec::new(),
                    false => vec![Fix::new(
                        "take the quotation marks away",
                        [Edit::new(*span, inner)],
                    )],
                }
            }
            Self::BadNumber { span, help, .. } if sources.text(*span) == "°" => {
                vec![Fix::new(help, [Edit::new(*span, "deg")])]
            }
            Self::BadNumber {
                instead: Some([whole, part]),
                span,
                ..
            } => {
                let place = match whole == part {
                    true => *span,
                    // The number stands before it, perhaps apart.
                    false => gap_before(*span, sources).to(*span),
                };
                let title = format!("write `{whole}`");
                vec![Fix::new(title, [Edit::new(place, part)])]
            }
            Self::BadHead { help, instead, .. } => {
                let fix = instead.as_ref();
                let fix = fix.map(|(span, text)| Fix::new(help, [Edit::new(*span, text)]));
                fix.into_iter().collect()
            }
            Self::SpacedUnit { joined, span } => spaced_unit(joined, *span, sources),
            Self::BadColorCode { span, .. } => {
                let written = sources.text(*span);
                match written.contains([' ', '\t']) {
                    true => vec![Fix::write(*span, written.replace([' ', '\t'], ""))],
                    false => Vec::new(),
                }
            }
            Self::MisplacedLet {
                definitions, block, ..
            } => {
                let before = sources.get(block.source).text().get(..block.start);
                let before = before.unwrap_or_default();
                let line = before.rsplit_once('\n').map_or(before, |(_, line)| line);
                let indent = if line.trim().is_empty() { line } else { "" };
                let line_end = sources.get(block.source).line_end();
                let definitions = with_comments(*definitions, sources);
                let text = format!("{}{line_end}{indent}", sources.text(definitions));
                vec![Fix::new(
                    "move it before the block",
                    [
                        Edit::insert(block.source, block.start, text),
                        Edit::remove(definitions, sources),
                    ],
                )]
            }
            Self::UnopenedBlock { head, span, .. } => {
                let title = format!("write `{head} {{`");
                match in_parentheses(*span, sources) {
                    Some(ends) => {
                        let braces = ends.into_iter().zip(["{", "}"]);
                        let edits = braces.map(|(end, brace)| Edit::new(end, brace));
                        vec![Fix::new(title, edits)]
                    }
                    None => vec![Fix::new(title, [Edit::insert(span.source, span.end, " {")])],
                }
            }
            Self::MissingLet {
                name,
                value,
                place,
                span,
            } => {
                let before = Span::new(span.source, span.start, place.start);
                vec![Fix::new(
                    format!("write `let {name} = {value}`"),
                    [Edit::new(before, "let ")],
                )]
            }
            // What is missing or meant is for the author to say.
            Self::InvalidUtf8 { .. }
            | Self::Utf16 { .. }
            | Self::TooDeep { .. }
            | Self::MissingValue { .. }
            | Self::FieldWithoutValue { .. }
            | Self::SetWithoutValue { .. }
            | Self::MissingName { .. }
            | Self::BadName { .. }
            | Self::BadNumber { .. }
            | Self::MissingKind { .. }
            | Self::NestedBraces { .. }
            | Self::OutsideBlock { .. }
            | Self::Unexpected { .. } => Vec::new(),
        }
    }
}

/// A comment of one line is meant, as a rule. What closes what was opened before it on the line stands behind its end.
fn unclosed_comment(span: Span, sources: &Sources) -> Vec<Fix> {
    let text = sources.get(span.source).text();
    let before = text.get(..span.start).unwrap_or_default();
    let before = before.rsplit('\n').next().unwrap_or_default();
    let taken = text.get(span.start..).unwrap_or_default();
    let line = taken.lines().next().unwrap_or_default();
    let mut open = 0_usize;
    for sign in before.chars() {
        match sign {
            '{' | '(' => open += 1,
            '}' | ')' => open = open.saturating_sub(1),
            _ => {}
        }
    }
    let mut comment = line.trim_end();
    let closing = |comment: &str| comment.strip_suffix(['}', ')']).map(|c| c.trim_end().len());
    while open > 0
        && let Some(end) = closing(comment)
    {
        comment = comment.get(..end).unwrap_or_default();
        open -= 1;
    }
    let at = span.start + comment.len();
    let mut fixes = vec![
        Fix::new(
            "close it in its line",
            [Edit::insert(span.source, at, " */")],
        ),
        Fix::new("begin it with `//`", [Edit::new(span, "//")]),
    ];
    let written = taken.trim_end();
    if written.contains('\n') {
        let end = span.start + written.len();
        let edit = Edit::insert(span.source, end, " */");
        fixes.push(Fix::new("close it at the end", [edit]));
    }
    fixes
}

/// A value ends before the name of the next field, or before the brace, or with the text.
fn unclosed_parenthesis(span: Span, sources: &Sources) -> Vec<Fix> {
    /// More words than these are no vector with a parenthesis missing.
    const MOST: usize = 4;
    let text = sources.get(span.source).text();
    let value = text.get(span.end..).unwrap_or_default();
    let brace = value.find(['{', '}']);
    let value = value
        .get(..brace.unwrap_or(value.len()))
        .unwrap_or_default();
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let starts = value.match_indices(|c: char| c.is_ascii_alphabetic());
    let starts = starts.map(|(at, _)| at).filter(|&at| {
        let before = value.get(..at).unwrap_or_default();
        before.ends_with(char::is_whitespace)
    });
    let words = starts.map(|at| {
        let word = value.get(at..).unwrap_or_default();
        let word = word.split(|c| !is_of_word(c)).next().unwrap_or_default();
        (at, word)
    });
    let mut ends: Vec<(usize, &str)> = words.take(MOST).collect();
    ends.extend(brace.map(|brace| (brace, "}")));
    if brace.is_none() {
        ends.push((value.len(), ""));
    }
    let fixes = ends.into_iter().map(|(end, next)| {
        let before = value.get(..end).unwrap_or_default();
        let (at, title) = match next {
            "" => (written_length(before), "write `)` at the end".to_owned()),
            _ => {
                let title = format!("write `)` before `{}`", shorten(next));
                (before.trim_end().len(), title)
            }
        };
        Fix::new(title, [Edit::insert(span.source, span.end + at, ")")])
    });
    fixes.collect()
}

/// The parentheses right behind a block's head, if that has them in place of braces.
fn in_parentheses(head: Span, sources: &Sources) -> Option<[Span; 2]> {
    let text = sources.get(head.source).text();
    let after = text.get(head.end..)?;
    let inner = after.trim_start().strip_prefix('(')?;
    let at = |rest: usize| Span::new(head.source, text.len() - rest - 1, text.len() - rest);
    let mut open = 1_usize;
    let close = inner.char_indices().find(|(_, sign)| {
        open += usize::from(*sign == '(');
        open -= usize::from(*sign == ')');
        open == 0
    });
    let rest = inner.len() - close?.0 - 1;
    Some([at(inner.len()), at(rest)])
}

/// What has no width, as a rule, is not meant to keep words apart.
fn odd_spaces(places: &[Span], sort: &str) -> Vec<Fix> {
    let all = |text| -> Vec<Edit> {
        let edits = places.iter().map(|place| Edit::new(*place, text));
        edits.collect()
    };
    let spaces = Fix::new("write plain spaces", all(" "));
    match sort.chars().all(char::is_whitespace) {
        true => vec![spaces],
        false => vec![Fix::new("take it away", all("")), spaces],
    }
}

fn product(left: &str, right: &str, span: Span, sources: &Sources) -> Fix {
    let gap = gap_before(span, sources);
    let edit = match sources.text(gap).contains('\n') {
        true => Edit::insert(span.source, span.start, "* "),
        false => Edit::new(gap, " * "),
    };
    Fix::new(format!("write `{left} * {right}`"), [edit])
}

fn call(left: &str, right: &str, span: Span, sources: &Sources) -> Fix {
    let gap = gap_before(span, sources);
    Fix::new(
        format!("write `{left}({right})`"),
        [
            Edit::new(gap, "("),
            Edit::insert(span.source, span.end, ")"),
        ],
    )
}

/// The number with its unit is under the span, or the unit alone.
fn spaced_unit(joined: &str, span: Span, sources: &Sources) -> Vec<Fix> {
    let written = sources.text(span);
    let title = format!("write `{joined}`");
    let is_unit = written.starts_with(|c: char| c.is_ascii_alphabetic());
    let edit = match joined.len().checked_sub("deg".len()) {
        Some(at) if is_unit => {
            let place = gap_before(span, sources).to(span);
            Edit::new(place, joined.get(at..).unwrap_or_default())
        }
        _ => Edit::new(span, joined),
    };
    vec![Fix::new(title, [edit])]
}

/// The white space before a place.
fn gap_before(span: Span, sources: &Sources) -> Span {
    let text = sources.get(span.source).text();
    let before = text.get(..span.start).unwrap_or_default();
    Span::new(span.source, before.trim_end().len(), span.start)
}
