//! The laws on generated texts, and slips in the scenes that there are.

use std::fs;

use proptest::{prelude::*, sample::select};

use super::{all_scenes, formatted, laws::the_laws_hold};

/// What may stand between two tokens. A blank comes first where the tokens would be one without it, or the start of a comment.
fn gap() -> impl Strategy<Value = &'static str> {
    // Apart by bars, the more frequent ones twice.
    let gaps = "|||| | |  |\n|\n|\n\n|\n \n\t\n|\r\n| // c \n|\n// own\n|/* b */| /* b */ |\n/* own */\n|/* two\n lines */|\n\n/* d */ /* e */\n|// f\n// g\n\n";
    select(gaps.split('|').collect::<Vec<_>>())
}

fn value() -> impl Strategy<Value = Vec<String>> {
    let words = "1 0.50 .5 5. 1e-3 1_000 30deg 0.5rad #fa0 #FFAA00 olive a b2 a_rather_long_name_of_something";
    let words: Vec<&str> = words.split(' ').collect();
    let leaf = select(words).prop_map(|word| vec![word.to_owned()]);
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
        let remark = select(vec!["", " // x", " // of the left", " /* y */", "\n// own"]);
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
    let one_of = |words: &'static str| select(words.split(' ').collect::<Vec<_>>());
    let name = || one_of("x y2 a_name _z Ball another_rather_long_name");
    let definition = (name(), value()).prop_map(|(name, value)| {
        let start = ["let", name, "="].map(str::to_owned);
        start.into_iter().chain(value).collect()
    });
    let kind = one_of("image camera sampler sphere box checkerboard cube");
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

proptest! {
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
