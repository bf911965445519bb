//! No text that somebody types makes a reading or an answer fail: beginnings of every example,
//! asked at their ends.

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    parts, robustness,
    scenes::{examples, sources},
};
use pinhole::{
    color::Color,
    diagnostic::{Fix, apply},
    editor::{
        Analysis, completions, definition, fixes, folds, formatting, hints, hover, occurrences,
        presentations, renamable, rename, semantic_tokens, signature, swatches, symbols,
    },
    format,
    source::{SourceId, Span},
};

/// Whether a span is one of whole characters.
fn is_place(text: &str, span: Span) -> bool {
    text.get(span.range()).is_some()
}

/// Asks everything there is at a place, and looks at what any client relies on.
fn ask(analysis: &Analysis<'_>, at: usize) {
    let text = analysis.text();
    for completion in completions(analysis, at) {
        let span = completion.replaces;
        assert!(is_place(text, span) && span.start <= at && at <= span.end);
    }
    if let Some(hover) = hover(analysis, at) {
        assert!(is_place(text, hover.span) && !hover.markdown.is_empty());
    }
    signature(analysis, at);
    let found = occurrences(analysis, at);
    assert!(found.iter().all(|found| is_place(text, found.span)));
    for is_known in [
        definition(analysis, at).is_some(),
        renamable(analysis, at).is_ok(),
        rename(analysis, at, "a_new_name_for_it").is_ok(),
    ] {
        assert_eq!(is_known, !found.is_empty());
    }
}

/// Asks everything there is about the whole text.
fn ask_of_all(analysis: &Analysis<'_>) {
    let text = analysis.text();
    let hints = hints(analysis, 0..text.len());
    for hint in hints {
        // Within a line, it would push apart what the formatter puts under one another.
        let rest = text.get(hint.at..).expect("a place between characters");
        let is_end = rest
            .lines()
            .next()
            .is_none_or(|rest| rest.trim().is_empty());
        assert!(is_end, "{hint:?}");
    }
    for pair in semantic_tokens(analysis).windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(|token| token.span);
        assert!(before.end <= after.start, "tokens overlap: {pair:?}");
    }
    for symbol in symbols(analysis) {
        let children = symbol.children.iter().map(|child| child.span);
        for span in children.chain([symbol.selection]) {
            let is_inside = symbol.span.start <= span.start && span.end <= symbol.span.end;
            assert!(is_inside, "{symbol:?}");
        }
    }
    folds(analysis);
    for (_, fix) in fixes(analysis, Span::new(SourceId::File, 0, text.len())) {
        let mut edits = fix.edits.iter();
        assert!(edits.all(|edit| is_place(text, edit.span)), "{fix:?}");
    }
    if let Some(edits) = formatting(analysis) {
        let formatted = apply(&Fix::new("", edits), SourceId::File, text);
        assert_eq!(Ok(formatted), format::format(analysis.source()));
    }
    for swatch in swatches(analysis) {
        assert!(!presentations(analysis, swatch.span, Color::BLACK).is_empty());
    }
}

sampled_and_exhaustive!(every_example_gets_its_answers_while_it_is_written);

/// Its beginnings, asked at their ends; the whole, asked at every place; and it without a byte, or
/// with a piece cut out, as when a line is being rewritten. Examples have much in common: of each
/// it is every other place, of one example the odd ones and of the next the even ones.
fn every_example_gets_its_answers_while_it_is_written(effort: Effort) {
    for (index, text) in effort.first(3, examples()).enumerate() {
        let whole = sources(&text);
        let whole = Analysis::new(&whole);
        ask_of_all(&whole);
        let starts: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
        let places = starts.iter().copied().chain([text.len()]);
        for at in places.skip(index % 2).step_by(2) {
            ask(&whole, at);
            let beginning = &text[..at];
            robustness::read(beginning);
            parts::check(beginning, 1, &[]);
            let beginning = sources(beginning);
            let analysis = Analysis::new(&beginning);
            ask(&analysis, at);
            ask_of_all(&analysis);
        }
        for at in (index % 2..text.len()).step_by(2) {
            let mut bytes = text.clone().into_bytes();
            bytes.remove(at);
            robustness::read(bytes);
        }
        for window in starts.windows(9).step_by(5) {
            let cut = sources(&format!("{}{}", &text[..window[0]], &text[window[8]..]));
            let analysis = Analysis::new(&cut);
            ask(&analysis, window[0]);
            ask_of_all(&analysis);
        }
    }
}

#[test]
fn odd_texts_get_their_answers() {
    let texts = [
        "\u{feff}let a = 1\r\nsphere { center a }\r\n",
        "let é = 1 sphere { center 🎱 radius \"é",
        "/* 🎱 */ let a = 1 // é",
        "let Ball = sphere { radius 1 }",
        "}}}}{{{{",
        "((((((",
        "sphere { let a = 1 radius a } let b = a",
        "let let let = = =",
        "sphere sphere sphere { sphere { box {",
        "#",
        "sphere { color # }",
        "1e+",
        "let a = 2 deg",
        "let a = '(0, 1",
    ];
    for text in texts {
        let sources = sources(text);
        let analysis = Analysis::new(&sources);
        // A client may ask for any place, one within a character or behind the text too.
        for at in 0..text.len() + 3 {
            ask(&analysis, analysis.source().floor_char_boundary(at));
        }
        ask_of_all(&analysis);
    }
}
