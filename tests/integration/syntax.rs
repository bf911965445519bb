//! Compares syntax trees with `tests/syntax`, where `NAME.txt` is the tree of `NAME.scn`.

use std::{sync::mpsc, thread, time::Duration};

use pinhole::{
    source::{Source, SourceId, Span},
    syntax::{
        self, Parsed,
        tokens::{Lexer, TokenKind, numeric_part},
        tree::{Item, Value, ValueKind},
    },
};

use crate::{diagnostics::fixtures, scenes::scenes, snapshot::assert_file};

/// Prints a syntax tree with one item or field per line, and then the comments and problems.
/// Brackets surround each sequence of operators and operands, such as `[1 + 2 + 3]`.
fn printed(source: &Source, parsed: &Parsed<'_>) -> String {
    let under = |span: Span| {
        let words = source.slice(span.range()).split_whitespace();
        words.collect::<Vec<_>>().join(" ")
    };
    let bad = |span: Span| format!("bad `{}`", under(span));
    let mut lines = Vec::new();
    for item in &parsed.tree.items {
        match item {
            Item::Definition(definition) => {
                let name = definition.name.map_or("?", |name| name.text);
                let equals = definition.equals.map_or("", |_| " =");
                let value = printed_value(&definition.value, &bad);
                lines.push(format!("let {name}{equals} {value}"));
            }
            Item::Block(block) => {
                let kind = block.kind.map_or("?", |kind| kind.text);
                let name = block.name.map_or("", |name| name.text);
                let open = block.open.map_or("", |_| "{");
                let close = block.close.map_or("", |_| "}");
                lines.push(format!("block {kind} {name} {open}{close}"));
                for field in &block.fields {
                    let value = printed_value(&field.value, &bad);
                    lines.push(format!("  {} {value}", field.name.text));
                }
                lines.extend(block.bad.iter().map(|&span| format!("  {}", bad(span))));
            }
            Item::Bad(span) => lines.push(bad(*span)),
        }
    }
    lines.extend(parsed.comments.iter().map(|&span| under(span)));
    for problem in &parsed.problems {
        let place = source.place(problem.labels[0].span.start);
        let said = format!("{}: {}", problem.code, problem.message);
        lines.push(format!("{}:{} {said}", place.line, place.column));
    }
    lines.push(String::new());
    lines.join("\n")
}

fn printed_value(value: &Value<'_>, bad: &impl Fn(Span) -> String) -> String {
    let parts = value.parts().into_iter();
    let mut parts: Vec<String> = parts.map(|part| printed_value(part, bad)).collect();
    match &value.kind {
        ValueKind::Number(text) | ValueKind::ColorCode(text) | ValueKind::Name(text) => {
            (*text).to_owned()
        }
        ValueKind::Angle { number, unit } => format!("{number} {unit:?}"),
        ValueKind::Call(call) => format!("{} ({})", call.function.text, parts.join(", ")),
        ValueKind::Parentheses(_) | ValueKind::Tuple(_) => format!("({})", parts.join(", ")),
        ValueKind::Negation { .. } => format!("-{}", parts[0]),
        ValueKind::Chain { rest, .. } => {
            for (part, step) in parts[1..].iter_mut().zip(rest) {
                *part = format!("{} {part}", step.operator.sign());
            }
            format!("[{}]", parts.join(" "))
        }
        ValueKind::Missing => "missing".to_owned(),
        ValueKind::Bad => bad(value.span),
    }
}

#[test]
fn syntax_trees_match_the_files_in_tests_syntax() {
    for (folder, is_right) in [("tests/syntax/ok", true), ("tests/syntax/bad", false)] {
        for path in scenes(folder) {
            let source = &Source::from_bytes("test.scn", std::fs::read(&path).unwrap());
            let parsed = syntax::parse(source, SourceId::File);
            assert_eq!(parsed.problems.is_empty(), is_right, "{}", path.display());
            assert_file(&path.with_extension("txt"), &printed(source, &parsed));
        }
    }
}

/// Returns the tokens and comments of a text, in order.
pub fn tokens(text: &str) -> Vec<&str> {
    let mut lexer = Lexer::new(text, 0);
    let tokens = std::iter::from_fn(|| {
        let token = lexer.token();
        (token.kind != TokenKind::End).then(|| &text[token.start..token.end])
    });
    tokens.collect()
}

/// An invisible character, such as a no-break space, may lie between the two characters of an
/// operator. The parser must then reach the end of the text.
#[test]
fn operators_split_by_an_invisible_character_do_not_hang_the_parser() {
    let mut torn = 0;
    let mut is_read = |text: &str, at: usize| {
        let text = format!("{}\u{a0}{}", &text[..at], &text[at..]);
        let (sender, receiver) = mpsc::channel();
        let told = text.clone();
        thread::spawn(move || {
            let source = Source::from_text("torn.scn", text);
            syntax::parse(&source, SourceId::File);
            sender.send(()).unwrap();
        });
        let found = receiver.recv_timeout(Duration::from_secs(60));
        assert!(found.is_ok(), "{told}");
        torn += 1;
    };
    for (_, sources) in fixtures() {
        let text = sources.file.text();
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let is_sign = |at: usize| line.as_bytes()[at].is_ascii_punctuation();
            // Lines of a fixture that begin with `//` are expectations, so they are skipped.
            let places = (1..line.len()).filter(|_| !line.starts_with("//"));
            for at in places.filter(|at| is_sign(at - 1) && is_sign(*at)) {
                is_read(text, start + at);
            }
            start += line.len();
        }
    }
    assert!(torn > 300, "{torn}");
}

#[test]
fn the_lexer_splits_any_text_into_tokens() {
    let text = "a1 .5 1e-3-2 30deg #fa0 “red” größe /* x */ ** '2 // e\r\n/* o";
    let expected = "a1|.5|1e-3|-|2|30deg|#fa0|“red”|größe|/* x */|**|'2|// e|/* o";
    assert_eq!(tokens(text).join("|"), expected);
    for case in "2=2 .5=.5 5.=5. 1e-3deg=1e-3 2e=2 1_000=1_000 1__0=1 0x10=0".split(' ') {
        let (written, number) = case.split_once('=').unwrap();
        assert_eq!(numeric_part(written), number, "{written}");
    }
}
