//! Generates random texts for the formatter: random tokens with random gaps between them.

use proptest::{collection::vec, prelude::*, sample::select};

use super::{formatted, laws::assert_formatter_laws};

fn one_of(words: &'static str, separator: char) -> impl Strategy<Value = &'static str> {
    select(words.split(separator).collect::<Vec<_>>())
}

/// Generates gaps between tokens. A gap consists of white space and comments.
pub fn gaps() -> impl Strategy<Value = Vec<&'static str>> {
    // Bars separate the gaps. A gap that should be frequent is listed twice.
    let gaps = "|||| | |  |\n|\n|\n\n|\n \n\t\n|\r\n| // c \n|\n// own\n|/* b */| /* b */ |\n/* own */\n|/* two\n lines */|\n\n/* d */ /* e */\n|// f\n// g\n\n";
    vec(one_of(gaps, '|'), 200)
}

/// Joins the space-separated tokens in `tokens` with the gaps `gaps`. Adds a space where two tokens
/// would otherwise merge or begin a comment.
pub fn spaced(tokens: &str, gaps: &[&str]) -> String {
    let mut text = String::new();
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '#');
    let tokens = tokens.split(' ').filter(|token| !token.is_empty());
    for (token, gap) in tokens.zip(gaps.iter().cycle()) {
        let joins = text.ends_with(is_word) && gap.is_empty() && token.starts_with(is_word);
        if joins || (text.ends_with('/') && !gap.starts_with(' ')) {
            text.push(' ');
        }
        text += gap;
        text += token;
    }
    text + gaps[gaps.len() - 1]
}

fn value() -> impl Strategy<Value = String> {
    let words = "1 0.50 .5 5. 1e-3 1_000 30deg 0.5rad #fa0 #FFAA00 olive a b2 a_rather_long_name_of_something";
    one_of(words, ' ')
        .prop_map(str::to_owned)
        .prop_recursive(5, 60, 4, |inner| {
            let inner = inner.boxed();
            let list = (one_of("(|max (|f (", '|'), vec(inner.clone(), 0..4))
                .prop_filter("nothing in parentheses", |(open, values)| {
                    *open != "(" || !values.is_empty()
                })
                .prop_map(|(open, values)| format!("{open} {} )", values.join(" , ")));
            // A list whose elements are on lines of their own. After the `,` of each element, there
            // may be a comment.
            let remark = one_of("|\t//\tx|\t//\tof\tthe\tleft|\t/*\ty\t*/|\n//\town", '|');
            let explained = (one_of("(|max (", '|'), vec((inner.clone(), remark), 1..4)).prop_map(
                |(open, values)| {
                    let lines = values.iter();
                    let lines = lines.map(|(value, remark)| format!("{value} ,{remark}\n"));
                    let lines = lines.collect::<Vec<_>>().join(" ");
                    let last = lines.rfind(',').unwrap();
                    format!("{open} {}{} )", &lines[..last], &lines[last + 1..])
                },
            );
            let minus = inner.clone().prop_map(|value| format!("- {value}"));
            let operation = (inner.clone(), one_of("+ - * /", ' '), inner)
                .prop_map(|(left, sign, right)| format!("{left} {sign} {right}"));
            prop_oneof![2 => list, 2 => explained, 1 => minus, 2 => operation]
        })
}

fn item() -> impl Strategy<Value = String> {
    let name = || one_of("x y2 a_name _z Ball another_rather_long_name", ' ');
    let definition = (name(), value()).prop_map(|(name, value)| format!("let {name} = {value}"));
    let kind = one_of("image camera sampler sphere box checkerboard cube", ' ');
    let field = (name(), value()).prop_map(|(name, value)| format!("{name} {value}"));
    let block =
        (kind, prop::option::of(name()), vec(field, 0..4)).prop_map(|(kind, name, fields)| {
            format!(
                "{kind} {} {{ {} }}",
                name.unwrap_or_default(),
                fields.join(" ")
            )
        });
    prop_oneof![1 => definition, 2 => block]
}

proptest! {
    #[test]
    fn formatter_laws_hold_for_generated_texts(
        items in vec(item(), 0..8),
        mut gaps in gaps(),
        style in one_of("everywhere|between lines|crlf", '|'),
        start in one_of("|\u{feff}", '|'),
    ) {
        if style == "between lines" {
            for gap in gaps.iter_mut().filter(|gap| !gap.starts_with('\n')) {
                *gap = " ";
            }
        }
        let mut text = start.to_owned() + &spaced(&items.join(" "), &gaps);
        if style == "crlf" {
            text = text.replace("\r\n", "\n").replace('\n', "\r\n");
        }
        // Texts with `--` before a space or a tab are skipped. Such a `--` may be a double minus
        // sign, but it is reported as an error, because it looks like a comment of another
        // language.
        prop_assume!(!text.contains("-- ") && !text.contains("--\t"));
        assert_formatter_laws(&text, &formatted(&text).unwrap());
    }
}
