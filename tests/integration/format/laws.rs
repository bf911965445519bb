//! What holds of every layout: the same tokens, comments and tree; twice is once; lists with comments are open.

use std::fs;

use pinhole::{
    format::format,
    source::{Source, SourceId, Span},
    syntax::{
        self,
        tree::{Element, Item, Value, ValueKind},
    },
};

use super::{all_scenes, formatted};

/// Tokens and comments in their order, without the white space at the ends of the lines of comments.
fn words(text: &str) -> Vec<String> {
    let source = Source::from_text("a.scn", text);
    let parsed = syntax::parse(&source, SourceId::File);
    assert_eq!(parsed.problems, []);
    let mut spans = parsed.comments.clone();
    for item in &parsed.tree.items {
        match item {
            Item::Definition(definition) => {
                let name = definition.name.unwrap().span;
                spans.extend([definition.keyword, name, definition.equals.unwrap()]);
                tokens(&definition.value, &mut spans);
            }
            Item::Block(block) => {
                spans.extend([block.kind.unwrap().span, block.open.unwrap()]);
                spans.extend(block.name.map(|name| name.span));
                spans.push(block.close.unwrap());
                for field in &block.fields {
                    spans.push(field.name.span);
                    tokens(&field.value, &mut spans);
                }
            }
            Item::Bad(span) => panic!("{span:?}"),
        }
    }
    spans.sort();
    let tidy = |span: &Span| {
        let lines = source.slice(span.range()).lines();
        let lines: Vec<&str> = lines
            .map(|l| l.trim_end_matches([' ', '\t', '\r']))
            .collect();
        lines.join("\n")
    };
    spans.iter().map(tidy).collect()
}

fn tokens(value: &Value<'_>, spans: &mut Vec<Span>) {
    match &value.kind {
        ValueKind::Call(call) => {
            spans.push(call.function.span);
            list(call.parentheses, &call.arguments, spans);
        }
        ValueKind::Parentheses(inner) => {
            list(value.span, &[], spans);
            tokens(inner, spans);
        }
        ValueKind::Tuple(elements) => list(value.span, elements, spans),
        ValueKind::Negation { sign, operand } => {
            spans.push(*sign);
            tokens(operand, spans);
        }
        ValueKind::Chain { first, rest } => {
            tokens(first, spans);
            for step in rest {
                spans.push(step.sign);
                tokens(&step.operand, spans);
            }
        }
        _ => spans.push(value.span),
    }
}

fn list(parentheses: Span, elements: &[Element<'_>], spans: &mut Vec<Span>) {
    let Span { source, start, end } = parentheses;
    spans.push(Span::new(source, start, start + 1));
    spans.push(Span::new(source, end - 1, end));
    for element in elements {
        tokens(&element.value, spans);
        spans.extend(element.comma);
    }
}

/// The tree without its places.
fn tree(text: &str) -> String {
    let source = Source::from_text("a.scn", text);
    let parsed = syntax::parse(&source, SourceId::File);
    let printed = format!("{:?}", parsed.tree);
    let mut parts = printed.split("Span {");
    let mut shape = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        shape += part.split_once('}').unwrap().1;
    }
    shape
}

pub fn the_laws_hold(text: &str, formatted_text: &str) {
    assert_eq!(formatted(formatted_text).as_deref(), Ok(formatted_text));
    assert_eq!(tree(text), tree(formatted_text));
    assert_eq!(words(text), words(formatted_text));
    let line_ends = formatted_text.matches('\n').count();
    let crlf = formatted_text.matches("\r\n").count();
    assert!(crlf == 0 || crlf == line_ends, "{formatted_text:?}");
    for line in formatted_text.lines() {
        assert_eq!(line.trim_end_matches([' ', '\t']), line);
    }
    assert!(!formatted_text.contains("\n\n\n") && !formatted_text.ends_with("\n\n"));
    lists_are_open(formatted_text);
}

/// The lists of a value with their elements, from the outside in.
fn lists<'v>(value: &'v Value<'v>, found: &mut Vec<(Span, Vec<&'v Value<'v>>)>) {
    match &value.kind {
        ValueKind::Call(call) => {
            let values: Vec<_> = call.arguments.iter().map(|e| &e.value).collect();
            found.push((call.parentheses, values.clone()));
            values.into_iter().for_each(|value| lists(value, found));
        }
        ValueKind::Parentheses(inner) => {
            found.push((value.span, vec![&**inner]));
            lists(inner, found);
        }
        ValueKind::Tuple(elements) => {
            let values: Vec<_> = elements.iter().map(|e| &e.value).collect();
            found.push((value.span, values.clone()));
            values.into_iter().for_each(|value| lists(value, found));
        }
        ValueKind::Negation { operand, .. } => lists(operand, found),
        ValueKind::Chain { first, rest } => {
            lists(first, found);
            rest.iter().for_each(|step| lists(&step.operand, found));
        }
        _ => {}
    }
}

/// In a list with a comment that ends or starts a line, every element starts one too, further to the right by two than the
/// line of the `(`; and the `)` stands below that line's start. Answers how many such lists there are.
pub fn lists_are_open(text: &str) -> usize {
    let source = Source::from_text("a.scn", text);
    let parsed = syntax::parse(&source, SourceId::File);
    // A comment of several lines hides where a line began.
    if parsed
        .comments
        .iter()
        .any(|c| text[c.range()].contains('\n'))
    {
        return 0;
    }
    let mut found = Vec::new();
    for item in &parsed.tree.items {
        match item {
            Item::Definition(definition) => lists(&definition.value, &mut found),
            Item::Block(block) => block
                .fields
                .iter()
                .for_each(|f| lists(&f.value, &mut found)),
            Item::Bad(_) => {}
        }
    }
    let mut bare = text.to_owned();
    for comment in &parsed.comments {
        bare.replace_range(comment.range(), &" ".repeat(comment.range().len()));
    }
    let start_of_line = |at: usize| text[..at].rfind('\n').map_or(0, |end| end + 1);
    let indent = |at: usize| {
        let line = text[start_of_line(at)..].trim_start_matches('\u{feff}');
        line.len() - line.trim_start_matches(' ').len()
    };
    let before = |at: usize| bare[start_of_line(at)..at].trim();
    let breaks = |comment: &&Span| {
        let gap = text[..comment.start].trim_end().len();
        text[comment.range()].starts_with("//") || text[gap..comment.start].contains('\n')
    };
    let mut open = 0;
    for (span, elements) in found {
        let close = span.end - 1;
        let mut inside = parsed
            .comments
            .iter()
            .filter(|c| c.start > span.start && c.end <= close);
        if !inside.any(|comment| breaks(&comment)) {
            continue;
        }
        open += 1;
        assert_eq!(
            (before(close), indent(close)),
            ("", indent(span.start)),
            "{text}"
        );
        for element in elements {
            let start = element.span.start;
            assert!(["", ","].contains(&before(start)), "{text}");
            assert_eq!(indent(start), indent(span.start) + 2, "{text}");
        }
    }
    open
}

#[test]
fn the_laws_hold_of_every_scene() {
    let (mut right, mut wrong) = (0, 0);
    for path in all_scenes() {
        let source = Source::from_bytes("a.scn", fs::read(&path).unwrap());
        match format(&source) {
            Ok(formatted) => {
                the_laws_hold(source.text(), &formatted);
                right += 1;
            }
            Err(mistakes) => {
                assert!(mistakes.iter().any(|d| d.is_error()), "{}", path.display());
                wrong += 1;
            }
        }
    }
    assert!(right > 60 && wrong > 30, "{right} right, {wrong} wrong");
}
