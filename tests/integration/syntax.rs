//! Texts and their trees, as `tests/syntax` says, and what holds of every tree.
//!
//! Beside each `.scn` stands its tree in `.txt`; `UPDATE_EXPECT=1 cargo test` writes the trees anew.

use std::{fmt::Write, fs, path::Path};

use pinhole::{
    source::{Source, SourceId, Span},
    syntax::{
        self, Parsed,
        tokens::{Lexer, TokenKind, numeric_part},
        tree::{Item, Tree, Value, ValueKind},
    },
};

use crate::scenes::scenes;
use crate::table::rows;

fn source(path: &Path) -> Source {
    Source::from_bytes("test.scn", fs::read(path).expect("the file can be read"))
}

/// Prints a tree: a node a line, with the text of its tokens.
struct Printer<'s> {
    text: &'s str,
    out: String,
}

impl Printer<'_> {
    fn line(&mut self, depth: usize, words: &str) {
        let _ = writeln!(self.out, "{}{words}", "  ".repeat(depth));
    }

    fn under(&self, span: Span) -> String {
        let text = self
            .text
            .get(span.range())
            .expect("a span lies between characters");
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn bad(&mut self, depth: usize, span: Span) {
        self.line(depth, &format!("bad {}", self.under(span)));
    }

    fn item(&mut self, item: &Item<'_>) {
        match item {
            Item::Definition(definition) => {
                let name = definition.name.map_or("?", |name| name.text);
                let equals = definition.equals.map_or("", |_| " =");
                self.line(0, &format!("let {name}{equals}"));
                self.value(1, &definition.value);
            }
            Item::Block(block) => {
                let kind = block.kind.map_or("?", |kind| kind.text);
                let name = block
                    .name
                    .map_or(String::new(), |name| format!(" {}", name.text));
                let open = block.open.map_or("", |_| " {");
                let close = block.close.map_or("", |_| " }");
                self.line(0, &format!("block {kind}{name}{open}{close}"));
                for field in &block.fields {
                    self.line(1, field.name.text);
                    self.value(2, &field.value);
                }
                block.bad.iter().for_each(|span| self.bad(1, *span));
            }
            Item::Bad(span) => self.bad(0, *span),
        }
    }

    fn value(&mut self, depth: usize, value: &Value<'_>) {
        let mut signs = Vec::new();
        let words = match &value.kind {
            ValueKind::Number(text) => format!("number {text}"),
            ValueKind::Angle { number, unit } => format!("angle {number} {unit:?}"),
            ValueKind::ColorCode(text) => format!("color {text}"),
            ValueKind::Name(text) => format!("name {text}"),
            ValueKind::Call(call) => format!("call {}", call.function.text),
            ValueKind::Parentheses(_) => "parentheses".to_owned(),
            ValueKind::Tuple(_) => "tuple".to_owned(),
            ValueKind::Negation { .. } => "negation".to_owned(),
            ValueKind::Chain { rest, .. } => {
                signs.extend(rest.iter().map(|step| step.operator.sign().to_string()));
                "chain".to_owned()
            }
            ValueKind::Missing => "missing".to_owned(),
            ValueKind::Bad => format!("bad {}", self.under(value.span)),
        };
        self.line(depth, &words);
        for (index, part) in value.parts().into_iter().enumerate() {
            if let Some(sign) = index.checked_sub(1).and_then(|before| signs.get(before)) {
                self.line(depth + 1, sign);
            }
            self.value(depth + 1, part);
        }
    }
}

fn printed(source: &Source, parsed: &Parsed<'_>) -> String {
    let mut printer = Printer {
        text: source.text(),
        out: String::new(),
    };
    for item in &parsed.tree.items {
        printer.item(item);
    }
    for comment in &parsed.comments {
        printer.line(0, &format!("comment {}", printer.under(*comment)));
    }
    for diagnostic in &parsed.problems {
        let place = source.place(diagnostic.labels[0].span.start);
        let said = format!("{}: {}", diagnostic.code, diagnostic.message);
        printer.line(0, &format!("{}:{} {said}", place.line, place.column));
    }
    printer.out
}

#[test]
fn trees() {
    for (folder, right) in [("tests/syntax/ok", true), ("tests/syntax/bad", false)] {
        for path in scenes(folder) {
            let source = source(&path);
            let parsed = syntax::parse(&source, SourceId::File);
            assert_eq!(parsed.problems.is_empty(), right, "{}", path.display());
            let printed = printed(&source, &parsed);
            let beside = path.with_extension("txt");
            if std::env::var_os("UPDATE_EXPECT").is_some() {
                fs::write(&beside, printed).expect("the tree can be written");
                continue;
            }
            let expected = fs::read_to_string(&beside).unwrap_or_default();
            assert_eq!(printed, expected, "{}", beside.display());
        }
    }
}

/// The places of all tokens of a tree without mistakes.
pub fn token_spans(tree: &Tree<'_>) -> Vec<Span> {
    let mut spans = Vec::new();
    for item in &tree.items {
        match item {
            Item::Definition(definition) => {
                let name = definition.name.expect("a name").span;
                spans.extend([
                    definition.keyword,
                    name,
                    definition.equals.expect("an equals sign"),
                ]);
                spans_of_value(&definition.value, &mut spans);
            }
            Item::Block(block) => {
                spans.extend([
                    block.kind.expect("a kind").span,
                    block.open.expect("a brace"),
                ]);
                spans.extend(block.name.map(|name| name.span));
                spans.push(block.close.expect("a brace"));
                for field in &block.fields {
                    spans.push(field.name.span);
                    spans_of_value(&field.value, &mut spans);
                }
            }
            Item::Bad(span) => panic!("bad item at {span:?}"),
        }
    }
    spans.sort();
    spans
}

fn spans_of_value(value: &Value<'_>, spans: &mut Vec<Span>) {
    let parentheses = match &value.kind {
        ValueKind::Call(call) => {
            spans.push(call.function.span);
            Some((call.parentheses, &call.arguments[..]))
        }
        ValueKind::Tuple(elements) => Some((value.span, &elements[..])),
        ValueKind::Parentheses(_) => Some((value.span, &[][..])),
        ValueKind::Negation { sign, .. } => {
            spans.push(*sign);
            None
        }
        ValueKind::Chain { rest, .. } => {
            spans.extend(rest.iter().map(|step| step.sign));
            None
        }
        ValueKind::Missing | ValueKind::Bad => panic!("{value:?}"),
        _ => {
            spans.push(value.span);
            None
        }
    };
    if let Some((Span { source, start, end }, elements)) = parentheses {
        spans.extend([
            Span::new(source, start, start + 1),
            Span::new(source, end - 1, end),
        ]);
        spans.extend(elements.iter().filter_map(|element| element.comma));
    }
    for part in value.parts() {
        spans_of_value(part, spans);
    }
}

#[test]
fn tree_and_comments_cover_a_right_file() {
    let folders = ["tests/syntax/ok", "examples", "tests/diagnostics"];
    let mut right = 0;
    for path in folders.into_iter().flat_map(scenes) {
        let source = source(&path);
        let parsed = syntax::parse(&source, SourceId::File);
        if !parsed.problems.is_empty() || !source.invalid_utf8().is_empty() {
            continue;
        }
        let missing = format!("{:?}", parsed.tree).contains("Missing");
        if missing {
            continue;
        }
        right += 1;
        let text = source.text();
        let mut covered = vec![false; text.len()];
        for span in token_spans(&parsed.tree).iter().chain(&parsed.comments) {
            for byte in span.range() {
                assert!(!covered[byte], "two tokens share byte {byte}");
                covered[byte] = true;
            }
        }
        for (byte, covered) in text.bytes().zip(covered).skip(source.bom_len()) {
            assert!(covered || byte.is_ascii_whitespace(), "{}", path.display());
        }
    }
    assert!(right > 30, "{right} right files");
}

#[test]
fn spans_of_nodes_hold_their_parts() {
    let source = Source::from_text(
        "test.scn",
        "let a = 1 + 2 // c\n  sphere B { radius -a * (2) }  ",
    );
    let parsed = syntax::parse(&source, SourceId::File);
    let under: Vec<&str> = parsed
        .tree
        .items
        .iter()
        .map(|item| source.slice(item.span().range()))
        .collect();
    assert_eq!(under, ["let a = 1 + 2", "sphere B { radius -a * (2) }"]);
    let Item::Block(block) = &parsed.tree.items[1] else {
        panic!("{parsed:?}");
    };
    assert_eq!(
        source.slice(block.fields[0].span.range()),
        "radius -a * (2)"
    );
    assert_eq!(source.slice(block.fields[0].value.span.range()), "-a * (2)");
}

#[test]
fn tokens_of_any_text() {
    let text = "a1 .5 1e-3-2 30deg #fa0 “red” größe /* x */ ** '2 // e\r\n/* o";
    let mut lexer = Lexer::new(text, 0);
    let tokens = std::iter::from_fn(|| {
        let token = lexer.token();
        (token.kind != TokenKind::End).then(|| &text[token.start..token.end])
    });
    let tokens: Vec<&str> = tokens.collect();
    let expected = "a1|.5|1e-3|-|2|30deg|#fa0|“red”|größe|/* x */|**|'2|// e|/* o";
    assert_eq!(tokens.join("|"), expected);
}

#[test]
fn numbers_end_before_their_units() {
    let table = "
        2 -> 2
        .5 -> .5
        5. -> 5.
        1e-3deg -> 1e-3
        2e -> 2
        1_000 -> 1_000
        1__0 -> 1
        0x10 -> 0
    ";
    for [written, number] in rows(table) {
        assert_eq!(numeric_part(written), number, "{written}");
    }
}
