//! Texts and their trees, as `tests/syntax` says, and what holds of every tree.
//!
//! Beside each `.scn` stands its tree in `.txt`; `UPDATE_EXPECT=1 cargo test` writes the trees anew.

use std::{fmt::Write, fs, path::Path};

use pinhole::{
    source::{Source, SourceId, Span},
    syntax::{
        self, Parsed,
        tokens::{Lexer, TokenKind, numeric_part},
        tree::{Block, Definition, Element, Field, Item, Value, ValueKind},
    },
};

use crate::scenes::scenes;

fn source(path: &Path) -> Source {
    Source::from_bytes("test.scn", fs::read(path).expect("the file can be read"))
}

/// Prints a tree: a node a line, with the text of its tokens.
struct Printer<'s> {
    text: &'s str,
    out: String,
    depth: usize,
}

impl Printer<'_> {
    fn line(&mut self, words: &str) {
        let _ = writeln!(self.out, "{}{words}", "  ".repeat(self.depth));
    }

    fn under(&self, span: Span) -> String {
        let text = self
            .text
            .get(span.range())
            .expect("a span lies between characters");
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    fn within(&mut self, print: impl FnOnce(&mut Self)) {
        self.depth += 1;
        print(self);
        self.depth -= 1;
    }

    fn item(&mut self, item: &Item<'_>) {
        match item {
            Item::Definition(definition) => self.definition(definition),
            Item::Block(block) => self.block(block),
            Item::Bad(span) => self.line(&format!("bad {}", self.under(*span))),
        }
    }

    fn definition(&mut self, definition: &Definition<'_>) {
        let name = definition.name.map_or("?", |name| name.text);
        let equals = if definition.equals.is_some() {
            " ="
        } else {
            ""
        };
        self.line(&format!("let {name}{equals}"));
        self.within(|p| p.value(&definition.value));
    }

    fn block(&mut self, block: &Block<'_>) {
        let kind = block.kind.map_or("?", |kind| kind.text);
        let name = block
            .name
            .map_or(String::new(), |name| format!(" {}", name.text));
        let open = if block.open.is_some() { " {" } else { "" };
        let close = if block.close.is_some() { " }" } else { "" };
        self.line(&format!("block {kind}{name}{open}{close}"));
        self.within(|p| {
            for field in &block.fields {
                p.field(field);
            }
            for bad in &block.bad {
                p.line(&format!("bad {}", p.under(*bad)));
            }
        });
    }

    fn field(&mut self, field: &Field<'_>) {
        self.line(field.name.text);
        self.within(|p| p.value(&field.value));
    }

    fn value(&mut self, value: &Value<'_>) {
        let under = self.under(value.span);
        match &value.kind {
            ValueKind::Number(text) => self.line(&format!("number {text}")),
            ValueKind::Angle { number, unit } => self.line(&format!("angle {number} {unit:?}")),
            ValueKind::ColorCode(text) => self.line(&format!("color {text}")),
            ValueKind::Name(text) => self.line(&format!("name {text}")),
            ValueKind::Call(call) => {
                self.line(&format!("call {}", call.function.text));
                self.elements(&call.arguments);
            }
            ValueKind::Parentheses(inner) => {
                self.line("parentheses");
                self.within(|p| p.value(inner));
            }
            ValueKind::Tuple(elements) => {
                self.line("tuple");
                self.elements(elements);
            }
            ValueKind::Negation { operand, .. } => {
                self.line("negation");
                self.within(|p| p.value(operand));
            }
            ValueKind::Chain { first, rest } => {
                self.line("chain");
                self.within(|p| {
                    p.value(first);
                    for step in rest {
                        p.line(&step.operator.sign().to_string());
                        p.value(&step.operand);
                    }
                });
            }
            ValueKind::Missing => self.line("missing"),
            ValueKind::Bad => self.line(&format!("bad {under}")),
        }
    }

    fn elements(&mut self, elements: &[Element<'_>]) {
        self.within(|p| {
            for element in elements {
                p.value(&element.value);
            }
        });
    }
}

fn printed(source: &Source, parsed: &Parsed<'_>) -> String {
    let mut printer = Printer {
        text: source.text(),
        out: String::new(),
        depth: 0,
    };
    for item in &parsed.tree.items {
        printer.item(item);
    }
    for comment in &parsed.comments {
        printer.line(&format!("comment {}", printer.under(*comment)));
    }
    for diagnostic in &parsed.problems {
        let place = source.place(diagnostic.labels[0].span.start);
        printer.line(&format!(
            "{}:{} {}: {}",
            place.line, place.column, diagnostic.code, diagnostic.message
        ));
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

/// Marks the bytes of every token of a tree, and of every comment.
struct Tokens {
    covered: Vec<bool>,
}

impl Tokens {
    fn mark(&mut self, span: Span) {
        for byte in span.range() {
            assert!(!self.covered[byte], "two tokens share byte {byte}");
            self.covered[byte] = true;
        }
    }

    fn item(&mut self, item: &Item<'_>) {
        match item {
            Item::Definition(definition) => {
                self.mark(definition.keyword);
                self.mark(definition.name.expect("a name").span);
                self.mark(definition.equals.expect("an equals sign"));
                self.value(&definition.value);
            }
            Item::Block(block) => {
                self.mark(block.kind.expect("a kind").span);
                block.name.iter().for_each(|name| self.mark(name.span));
                self.mark(block.open.expect("a brace"));
                for field in &block.fields {
                    self.mark(field.name.span);
                    self.value(&field.value);
                }
                self.mark(block.close.expect("a brace"));
            }
            Item::Bad(span) => panic!("bad item at {span:?}"),
        }
    }

    fn value(&mut self, value: &Value<'_>) {
        match &value.kind {
            ValueKind::Number(_)
            | ValueKind::Angle { .. }
            | ValueKind::ColorCode(_)
            | ValueKind::Name(_) => self.mark(value.span),
            ValueKind::Call(call) => {
                self.mark(call.function.span);
                self.list(call.parentheses, &call.arguments);
            }
            ValueKind::Parentheses(inner) => {
                self.ends(value.span);
                self.value(inner);
            }
            ValueKind::Tuple(elements) => self.list(value.span, elements),
            ValueKind::Negation { sign, operand } => {
                self.mark(*sign);
                self.value(operand);
            }
            ValueKind::Chain { first, rest } => {
                self.value(first);
                for step in rest {
                    self.mark(step.sign);
                    self.value(&step.operand);
                }
            }
            ValueKind::Missing | ValueKind::Bad => panic!("{value:?}"),
        }
    }

    fn list(&mut self, parentheses: Span, elements: &[Element<'_>]) {
        self.ends(parentheses);
        for element in elements {
            self.value(&element.value);
            element.comma.iter().for_each(|comma| self.mark(*comma));
        }
    }

    fn ends(&mut self, span: Span) {
        self.mark(Span::new(span.source, span.start, span.start + 1));
        self.mark(Span::new(span.source, span.end - 1, span.end));
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
        let mut tokens = Tokens {
            covered: vec![false; text.len()],
        };
        for comment in &parsed.comments {
            tokens.mark(*comment);
        }
        for item in &parsed.tree.items {
            tokens.item(item);
        }
        for (byte, covered) in text.bytes().zip(&tokens.covered).skip(source.bom_len()) {
            let blank = byte.is_ascii_whitespace();
            assert!(*covered || blank, "{}", path.display());
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
    assert_eq!(
        tokens,
        [
            "a1",
            ".5",
            "1e-3",
            "-",
            "2",
            "30deg",
            "#fa0",
            "“red”",
            "größe",
            "/* x */",
            "**",
            "'2",
            "// e",
            "/* o"
        ]
    );
}

#[test]
fn numbers_end_before_their_units() {
    for (written, number) in [
        ("2", "2"),
        (".5", ".5"),
        ("5.", "5."),
        ("1e-3deg", "1e-3"),
        ("2e", "2"),
        ("1_000", "1_000"),
        ("1__0", "1"),
        ("0x10", "0"),
    ] {
        assert_eq!(numeric_part(written), number, "{written}");
    }
}
