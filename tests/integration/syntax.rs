//! Texts and their trees: beside each `.scn` of `tests/syntax` stands its tree in `.txt`.

use pinhole::{
    source::{Source, SourceId, Span},
    syntax::{
        self, Parsed,
        tokens::{Lexer, TokenKind, numeric_part},
        tree::{Item, Value, ValueKind},
    },
};

use crate::{scenes::scenes, snapshot::assert_file, table::rows};

/// Prints a tree: a node a line, with the text of its tokens.
struct Printer<'s> {
    source: &'s Source,
    out: String,
}

impl Printer<'_> {
    fn line(&mut self, depth: usize, words: &str) {
        self.out += &format!("{}{words}\n", "  ".repeat(depth));
    }

    fn span(&mut self, depth: usize, what: &str, span: Span) {
        let text = self.source.slice(span.range());
        let words: Vec<&str> = text.split_whitespace().collect();
        self.line(depth, &format!("{what} {}", words.join(" ")));
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
                let name = block.name.map_or("", |name| name.text);
                let open = block.open.map_or("", |_| "{");
                let close = block.close.map_or("", |_| "}");
                let words = ["block", kind, name, open, close];
                let words: Vec<&str> = words.into_iter().filter(|w| !w.is_empty()).collect();
                self.line(0, &words.join(" "));
                for field in &block.fields {
                    self.line(1, field.name.text);
                    self.value(2, &field.value);
                }
                block.bad.iter().for_each(|&span| self.span(1, "bad", span));
            }
            Item::Bad(span) => self.span(0, "bad", *span),
        }
    }

    fn value(&mut self, depth: usize, value: &Value<'_>) {
        let mut signs = Vec::new();
        match &value.kind {
            ValueKind::Number(text) => self.line(depth, &format!("number {text}")),
            ValueKind::Angle { number, unit } => {
                self.line(depth, &format!("angle {number} {unit:?}"));
            }
            ValueKind::ColorCode(text) => self.line(depth, &format!("color {text}")),
            ValueKind::Name(text) => self.line(depth, &format!("name {text}")),
            ValueKind::Call(call) => self.line(depth, &format!("call {}", call.function.text)),
            ValueKind::Parentheses(_) => self.line(depth, "parentheses"),
            ValueKind::Tuple(_) => self.line(depth, "tuple"),
            ValueKind::Negation { .. } => self.line(depth, "negation"),
            ValueKind::Chain { rest, .. } => {
                signs.extend(rest.iter().map(|step| step.operator.sign().to_string()));
                self.line(depth, "chain");
            }
            ValueKind::Missing => self.line(depth, "missing"),
            ValueKind::Bad => self.span(depth, "bad", value.span),
        }
        for (index, part) in value.parts().into_iter().enumerate() {
            if let Some(sign) = index.checked_sub(1).and_then(|before| signs.get(before)) {
                self.line(depth + 1, sign);
            }
            self.value(depth + 1, part);
        }
    }

    fn all(mut self, parsed: &Parsed<'_>) -> String {
        parsed.tree.items.iter().for_each(|item| self.item(item));
        for comment in &parsed.comments {
            self.span(0, "comment", *comment);
        }
        for problem in &parsed.problems {
            let place = self.source.place(problem.labels[0].span.start);
            let said = format!("{}: {}", problem.code, problem.message);
            self.line(0, &format!("{}:{} {said}", place.line, place.column));
        }
        self.out
    }
}

#[test]
fn trees() {
    for (folder, is_right) in [("tests/syntax/ok", true), ("tests/syntax/bad", false)] {
        for path in scenes(folder) {
            let source = &Source::from_bytes("test.scn", std::fs::read(&path).unwrap());
            let parsed = syntax::parse(source, SourceId::File);
            assert_eq!(parsed.problems.is_empty(), is_right, "{}", path.display());
            let out = String::new();
            assert_file(
                &path.with_extension("txt"),
                &Printer { source, out }.all(&parsed),
            );
        }
    }
}

#[test]
fn spans_of_nodes_hold_their_parts() {
    let text = "let a = 1 + 2 // c\n  sphere B { radius -a * (2) }  ";
    let source = Source::from_text("test.scn", text);
    let items = syntax::parse(&source, SourceId::File).tree.items;
    let Item::Block(block) = &items[1] else {
        panic!("{items:?}");
    };
    let field = &block.fields[0];
    let spans = [
        items[0].span(),
        items[1].span(),
        field.span,
        field.value.span,
    ];
    let expected = [
        "let a = 1 + 2",
        "sphere B { radius -a * (2) }",
        "radius -a * (2)",
        "-a * (2)",
    ];
    assert_eq!(spans.map(|span| source.slice(span.range())), expected);
}

/// The tokens and comments of any text.
pub fn tokens(text: &str) -> Vec<&str> {
    let mut lexer = Lexer::new(text, 0);
    let tokens = std::iter::from_fn(|| {
        let token = lexer.token();
        (token.kind != TokenKind::End).then(|| &text[token.start..token.end])
    });
    tokens.collect()
}

#[test]
fn tokens_of_any_text() {
    let text = "a1 .5 1e-3-2 30deg #fa0 “red” größe /* x */ ** '2 // e\r\n/* o";
    let expected = "a1|.5|1e-3|-|2|30deg|#fa0|“red”|größe|/* x */|**|'2|// e|/* o";
    assert_eq!(tokens(text).join("|"), expected);
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
