//! What can be done about problems of syntax.

use super::{Problem, error::Meant};
use crate::{
    diagnostic::{Edit, Fix, Fixable},
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

    fn fixes(&self, sources: &Sources) -> Vec<Fix> {
        match self {
            Self::OddSpace { places, span, .. } => odd_spaces(places, sources.text(*span)),
            Self::UnclosedComment { span } => unclosed_comment(*span, sources),
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
            } => {
                vec![match meant {
                    Meant::Product => product(left, right, *span, sources),
                    Meant::Call => call(left, right, *span, sources),
                }]
            }
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
            Self::UnknownOperator { sign, span, .. } => match sign.as_str() {
                "×" | "·" => vec![Fix::write(*span, "*")],
                "÷" => vec![Fix::write(*span, "/")],
                "−" => vec![Fix::write(*span, "-")],
                _ => Vec::new(),
            },
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
            Self::BadNumber { span, .. } if sources.text(*span) == "°" => {
                vec![Fix::write(*span, "deg")]
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
                let text = format!("{}{line_end}{indent}", sources.text(*definitions));
                vec![Fix::new(
                    "move it before the block",
                    [
                        Edit::insert(block.source, block.start, text),
                        Edit::remove(*definitions, sources),
                    ],
                )]
            }
            Self::UnopenedBlock { head, span, .. } => {
                let after = sources.get(span.source).text().get(span.end..);
                // A `(` would have to go for it, and its `)` for a `}`.
                match after.is_some_and(|after| after.trim_start().starts_with('(')) {
                    true => Vec::new(),
                    false => vec![Fix::new(
                        format!("write `{head} {{`"),
                        [Edit::insert(span.source, span.end, " {")],
                    )],
                }
            }
            Self::MissingLet {
                name, place, span, ..
            } => {
                let before = Span::new(span.source, span.start, place.start);
                vec![Fix::new(
                    format!("write `let {name}`"),
                    [Edit::new(before, "let ")],
                )]
            }
            // What is missing or meant is for the author to say.
            Self::InvalidUtf8 { .. }
            | Self::Utf16 { .. }
            | Self::TooDeep { .. }
            | Self::UnclosedParenthesis { .. }
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

/// A comment of one line may have been meant by what has no end. Of several lines it took the rest of the text, which may
/// stay so, or become what it was.
fn unclosed_comment(span: Span, sources: &Sources) -> Vec<Fix> {
    let text = sources.get(span.source).text();
    let taken = text.get(span.start..).unwrap_or_default().trim_end();
    let line = Fix::new("begin it with `//`", [Edit::new(span, "//")]);
    if !taken.contains('\n') {
        return vec![line];
    }
    let close = Edit::insert(span.source, span.start + taken.len(), " */");
    vec![Fix::new("close it at the end of the text", [close]), line]
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
