//! The canonical layout: what it looks like, as `tests/format` says, and what holds of every text.
//!
//! Beside each `NAME.scn` of `tests/format` stands `NAME.formatted.scn`; `UPDATE_EXPECT=1 cargo test` writes these anew.

use std::{
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use pinhole::{
    format::format,
    source::{Source, SourceId, Span},
    syntax::{
        self,
        tree::{Element, Item, Value, ValueKind},
    },
};
use proptest::{prelude::*, sample::select, strategy::ValueTree};

fn formatted(text: &str) -> Result<String, Vec<String>> {
    let codes = |diagnostics: Vec<pinhole::diagnostic::Diagnostic>| {
        diagnostics.into_iter().map(|d| d.code).collect()
    };
    format(&Source::from_text("a.scn", text)).map_err(codes)
}

/// Every scene below a folder.
fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "scn") {
            found.push(path);
        }
    }
    found.sort();
}

fn all_scenes() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in ["examples", "tests"] {
        scenes(&root.join(folder), &mut found);
    }
    found
}

#[test]
fn the_layout_is_as_it_stands_beside() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/format");
    let mut found = Vec::new();
    scenes(&root, &mut found);
    found.retain(|path| !path.to_string_lossy().ends_with(".formatted.scn"));
    assert!(found.len() >= 4);
    for path in found {
        let beside = path.with_extension("formatted.scn");
        let formatted = formatted(&fs::read_to_string(&path).unwrap()).unwrap();
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            fs::write(&beside, formatted).unwrap();
            continue;
        }
        let expected = fs::read_to_string(&beside).unwrap_or_default();
        assert_eq!(formatted, expected, "{}", beside.display());
    }
}

#[test]
fn the_examples_and_the_scenes_of_the_documents_are_canonical() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut examples = Vec::new();
    scenes(&root.join("examples"), &mut examples);
    let mut texts: Vec<String> = examples
        .iter()
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    for document in ["README.md", "grammar/language.md"] {
        let document = fs::read_to_string(root.join(document)).unwrap();
        let fenced = document.split("```scn\n").skip(1);
        texts.extend(fenced.map(|rest| rest.split("```").next().unwrap().to_owned()));
    }
    assert!(texts.len() > 28);
    for text in texts {
        assert_eq!(formatted(&text).as_ref(), Ok(&text));
    }
}

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

fn the_laws_hold(text: &str, formatted_text: &str) {
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
fn lists_are_open(text: &str) -> usize {
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

#[test]
fn mistakes_of_syntax_are_told_and_no_others() {
    let codes = |codes: &[&str]| Err(codes.iter().map(|c| format!("pinhole::{c}")).collect());
    assert_eq!(
        formatted("let a = 1; sphere { radus b }"),
        codes(&["needless_separator"])
    );
    assert_eq!(
        formatted("sphere { center (1, 2, 3) radius }"),
        codes(&["missing_value"])
    );
    // So it is where the field is no field.
    assert_eq!(formatted("sphere { radus }"), codes(&["missing_value"]));
    assert_eq!(formatted("ball { radius }"), codes(&["missing_value"]));
    // And so it is with a value that could not be read.
    for (value, code) in [
        ("(2", "unclosed_parenthesis"),
        ("2)", "stray_closing"),
        ("2.5.5", "bad_number"),
        ("#ff", "bad_color_code"),
        (", color red", "needless_separator"),
        (")", "stray_closing"),
    ] {
        let text = format!("sphere {{ center (0, 1, 0)  radus {value} }}");
        assert_eq!(formatted(&text), codes(&[code]), "{text}");
    }
    assert_eq!(
        formatted("sphere { center (1"),
        codes(&["unclosed_block", "unclosed_parenthesis"])
    );
    // The comment would have to end where it does not.
    assert_eq!(formatted("// a\rlet a=1\r"), codes(&["odd_space"]));
    assert_eq!(
        formatted("let a=1\rlet b=2\r").unwrap(),
        "let a = 1\nlet b = 2\n"
    );
    let source = Source::from_bytes("a.scn", b"// \xff\nsphere { }".to_vec());
    let mistakes = format(&source).unwrap_err();
    assert_eq!(mistakes[0].code, "pinhole::invalid_utf8");
    // What the names mean does not matter.
    let text = "ball { radus 1 / 0  radus b }\n";
    assert_eq!(formatted(text).as_deref(), Ok(text));
}

#[test]
fn little_texts() {
    let cases = [
        ("", ""),
        ("\n \t\r\n", ""),
        ("\u{feff}", "\u{feff}"),
        ("\u{feff}\n\nlet a=1", "\u{feff}let a = 1\n"),
        (
            "// only  \n\n\n\n/* comments */\n",
            "// only\n\n/* comments */\n",
        ),
        ("let a=1\r\nlet b=2\r\n", "let a = 1\r\nlet b = 2\r\n"),
        ("let a=1\r\nlet b=2", "let a = 1\r\nlet b = 2\r\n"),
        ("let a=1\r\nlet b=2\n", "let a = 1\nlet b = 2\n"),
        ("/* a \r\n b */let a=1\r\n", "/* a\r\n b */ let a = 1\r\n"),
        ("let a=2/ /* two */3", "let a = 2 / /* two */ 3\n"),
        ("let a=2/ // two\n3", "let a = 2 /  // two\n  3\n"),
        ("let a=-// minus\n3", "let a = -  // minus\n  3\n"),
        (
            "let a=max(// c\n1,2/* d */)",
            "let a = max(  // c\n  1,\n  2  /* d */\n)\n",
        ),
        ("let a=f(\n/* c */\n)", "let a = f(\n  /* c */\n)\n"),
        ("let a=(1,/* c */\n2,3)", "let a = (1, /* c */ 2, 3)\n"),
        ("let a=(1 // c\n)", "let a = (\n  1  // c\n)\n"),
        ("box A{min a max(b)}", "box A { min a  max (b) }\n"),
    ];
    for (text, expected) in cases {
        assert_eq!(formatted(text).as_deref(), Ok(expected), "{text:?}");
        the_laws_hold(text, expected);
    }
}

#[test]
fn deep_and_long_values_are_laid_out() {
    let deep = format!("let a = {}1{}\n", "(".repeat(256), ")".repeat(256));
    assert_eq!(formatted(&deep).as_ref(), Ok(&deep));
    let signs = format!("let a = {}(2 - {}1)\n", "-".repeat(100), "-".repeat(100));
    the_laws_hold(&signs, &formatted(&signs).unwrap());
    let calls = format!("let a={}1{}", "max(1,".repeat(200), ")".repeat(200));
    the_laws_hold(&calls, &formatted(&calls).unwrap());
    let sum = format!("let a = 1{}", "+ 22 * 3".repeat(10_000));
    let formatted = formatted(&sum).unwrap();
    assert!(formatted.lines().all(|line| line.len() <= 100));
    the_laws_hold(&sum, &formatted);
}

/// Ten times the text takes some ten times as long, not a hundred.
#[test]
fn the_time_is_linear() {
    let text = |count: usize| {
        let object = |n: usize| {
            format!(
                "sphere S{n} {{center({n},{},-1) radius 1}} // {n}\nbox {{\nmin (1,2,3)}}",
                n % 7
            )
        };
        let lines: Vec<String> = (0..count).map(object).collect();
        lines.join("\n")
    };
    let time = |count: usize| {
        let source = Source::from_text("a.scn", text(count));
        let start = Instant::now();
        let formatted = format(&source).unwrap();
        assert!(formatted.len() > source.text().len());
        start.elapsed()
    };
    time(1000);
    let (short, long) = (time(2000), time(20_000));
    assert!(long < 40 * short, "{short:?}, {long:?}");
}

/// What may stand between two tokens. A blank comes first where the tokens would be one without it, or the start of a comment.
fn gap() -> impl Strategy<Value = &'static str> {
    let gaps = [
        "",
        "",
        "",
        "",
        " ",
        " ",
        "  ",
        "\n",
        "\n",
        "\n\n",
        "\n \n\t\n",
        "\r\n",
        " // c \n",
        "\n// own\n",
        "/* b */",
        " /* b */ ",
        "\n/* own */\n",
        "/* two\n lines */",
        "\n\n/* d */ /* e */\n",
        "// f\n// g\n\n",
    ];
    select(gaps.to_vec())
}

fn value() -> impl Strategy<Value = Vec<String>> {
    let words = [
        "1",
        "0.50",
        ".5",
        "5.",
        "1e-3",
        "1_000",
        "30deg",
        "0.5rad",
        "#fa0",
        "#FFAA00",
        "olive",
        "a",
        "b2",
        "a_rather_long_name_of_something",
    ];
    let leaf = select(words.to_vec()).prop_map(|word| vec![word.to_owned()]);
    leaf.prop_recursive(5, 60, 4, |inner| {
        let inner = inner.boxed();
        let listed = |open: Vec<String>, values: Vec<Vec<String>>| {
            let mut all = open;
            for (index, value) in values.into_iter().enumerate() {
                all.extend((index > 0).then(|| ",".to_owned()));
                all.extend(value);
            }
            all.push(")".to_owned());
            all
        };
        let parentheses = prop::collection::vec(inner.clone(), 1..4)
            .prop_map(move |values| listed(vec!["(".to_owned()], values));
        let call = (
            select(vec!["max", "f"]),
            prop::collection::vec(inner.clone(), 0..4),
        )
            .prop_map(move |(function, values)| {
                listed(vec![function.to_owned(), "(".to_owned()], values)
            });
        let minus = inner.clone().prop_map(|value| {
            let sign = ["-".to_owned()];
            sign.into_iter().chain(value).collect()
        });
        // As it is written by hand: an element a line, and what it is beside it.
        let remark = select(vec![
            "",
            " // x",
            " // of the left one",
            " /* y */",
            "\n// own",
        ]);
        let explained = (
            select(vec!["(", "max("]),
            prop::collection::vec((inner.clone(), remark), 1..4),
        )
            .prop_map(|(open, values)| {
                let last = values.len() - 1;
                let mut all: Vec<String> = open.split_inclusive("max").map(str::to_owned).collect();
                for (index, (value, remark)) in values.into_iter().enumerate() {
                    all.extend(value);
                    let comma = if index < last { "," } else { "" };
                    all.push(format!("{comma}{remark}\n"));
                }
                all.push(")".to_owned());
                all
            });
        let operator = select(vec!["+", "-", "*", "/"]);
        let operation = (inner.clone(), operator, inner).prop_map(|(mut left, sign, right)| {
            left.push(sign.to_owned());
            left.extend(right);
            left
        });
        prop_oneof![
            parentheses,
            call,
            explained.clone(),
            explained,
            minus,
            operation.clone(),
            operation
        ]
    })
}

fn item() -> impl Strategy<Value = Vec<String>> {
    let name = || {
        select(vec![
            "x",
            "y2",
            "a_name",
            "_z",
            "Ball",
            "another_rather_long_name",
        ])
    };
    let definition = (name(), value()).prop_map(|(name, value)| {
        let start = ["let", name, "="].map(str::to_owned);
        start.into_iter().chain(value).collect()
    });
    let kind = select(vec![
        "image",
        "camera",
        "sampler",
        "sphere",
        "box",
        "checkerboard",
        "cube",
    ]);
    let field = (name(), value()).prop_map(|(name, value)| {
        let mut field = vec![name.to_owned()];
        field.extend(value);
        field
    });
    let fields = prop::collection::vec(field, 0..4);
    let block = (kind, prop::option::of(name()), fields).prop_map(|(kind, name, fields)| {
        let mut block = vec![kind.to_owned()];
        block.extend(name.map(str::to_owned));
        block.push("{".to_owned());
        block.extend(fields.into_iter().flatten());
        block.push("}".to_owned());
        block
    });
    prop_oneof![1 => definition, 2 => block]
}

fn text() -> impl Strategy<Value = String> {
    let tokens = prop::collection::vec(item(), 0..8).prop_map(|items| items.concat());
    let gaps = prop::collection::vec(gap(), 200);
    let style = select(vec!["everywhere", "between lines", "crlf"]);
    (tokens, gaps, style, any::<bool>())
        .prop_map(|(tokens, gaps, style, bom)| {
            let mut text = if bom { "\u{feff}" } else { "" }.to_owned();
            let mut gaps = gaps.into_iter().cycle();
            let word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '#');
            for token in tokens {
                let gap = gaps.next().unwrap_or_default();
                let gap = match style {
                    "between lines" if !gap.starts_with('\n') => " ",
                    _ => gap,
                };
                let joins = text.ends_with(word) && (gap.is_empty() || gap.starts_with(word));
                if (joins && token.starts_with(word))
                    || (text.ends_with('/') && !gap.starts_with(' '))
                {
                    text.push(' ');
                }
                text += gap;
                text += &token;
            }
            text += gaps.next().unwrap_or_default();
            match style {
                "crlf" => text.replace("\r\n", "\n").replace('\n', "\r\n"),
                _ => text,
            }
        })
        // What looks like another language's comment is told so, though it may be a difference.
        .prop_filter("two minuses and a blank", |text| {
            !text.contains("-- ") && !text.contains("--\t")
        })
}

/// The generated texts have such lists, also within one another.
#[test]
fn lists_with_comments_are_generated() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let count = |runner: &mut _| {
        let text = text().new_tree(runner).unwrap().current();
        lists_are_open(&formatted(&text).unwrap())
    };
    let counts: Vec<usize> = (0..300).map(|_| count(&mut runner)).collect();
    assert!(
        counts.iter().filter(|&&count| count > 1).count() > 30,
        "{counts:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]
    #[test]
    fn the_laws_hold_of_any_text(text in text()) {
        the_laws_hold(&text, &formatted(&text).unwrap());
    }
}

/// What is written into a text in the wrong place.
const SLIPS: &[&str] = &[
    "", "(", ")", "{", "}", ",", "=", "#ff", "2.5.5", " radus ", " let ", "\"", "/*", "*/", "//",
    "*", "-", "[", "é", "\r",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, ..ProptestConfig::default() })]
    /// There is a layout, or something to say.
    #[test]
    fn what_is_not_laid_out_has_a_mistake(
        scene in select(texts_of_scenes()),
        slips in proptest::collection::vec((any::<prop::sample::Index>(), 0_usize..4, select(SLIPS)), 1..4),
    ) {
        let mut letters: Vec<char> = scene.chars().collect();
        for (place, gone, slip) in slips {
            let at = place.index(letters.len() + 1);
            let end = letters.len().min(at + gone);
            letters.splice(at..end, slip.chars());
        }
        let text: String = letters.into_iter().collect();
        if let Err(mistakes) = formatted(&text) {
            prop_assert!(!mistakes.is_empty(), "{text}");
        }
    }
}

/// The texts of all scenes, right or wrong, that are not long.
fn texts_of_scenes() -> Vec<String> {
    let texts = all_scenes().into_iter().map(|path| fs::read(path).unwrap());
    let texts = texts.filter_map(|bytes| String::from_utf8(bytes).ok());
    texts.filter(|text| text.len() < 1000).collect()
}
