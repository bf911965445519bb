//! No text that somebody types makes an answer fail: every beginning of every example, asked at its end.

use std::ops::Range;

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    scenes::{examples, sources},
};
use pinhole::{
    color::Color,
    editor::{
        Analysis, completions, definition, fixes, folds, formatting, hints, hover, occurrences,
        presentations, renamable, rename, semantic_tokens, signature, swatches, symbols,
    },
    format,
    source::{SourceId, Span},
};

/// Whether a span is one of whole characters.
fn is_place(text: &str, span: Span) -> bool {
    let [start, end] = [span.start, span.end].map(|at| text.is_char_boundary(at));
    span.start <= span.end && start && end
}

/// Asks everything there is at a place, and looks at what any client relies on.
fn ask(analysis: &Analysis<'_>, at: usize) {
    let text = analysis.text();
    for completion in completions(analysis, at) {
        assert!(
            is_place(text, completion.replaces)
                && completion.replaces.start <= at
                && at <= completion.replaces.end
        );
    }
    if let Some(hover) = hover(analysis, at) {
        assert!(is_place(text, hover.span) && !hover.markdown.is_empty());
    }
    signature(analysis, at);
    let found = occurrences(analysis, at);
    assert!(found.iter().all(|found| is_place(text, found.span)));
    assert_eq!(definition(analysis, at).is_some(), !found.is_empty());
    assert_eq!(renamable(analysis, at).is_ok(), !found.is_empty());
    assert_eq!(
        rename(analysis, at, "a_new_name_for_it").is_ok(),
        !found.is_empty()
    );
}

/// Asks everything there is about the whole text.
fn ask_of_all(analysis: &Analysis<'_>) {
    let text = analysis.text();
    let all: Range<usize> = 0..text.len();
    assert!(
        hints(analysis, all)
            .iter()
            .all(|hint| text.is_char_boundary(hint.at))
    );
    let tokens = semantic_tokens(analysis);
    for pair in tokens.windows(2) {
        assert!(
            pair[0].span.end <= pair[1].span.start,
            "tokens overlap: {pair:?}"
        );
    }
    for symbol in symbols(analysis) {
        let inner = [symbol.selection]
            .into_iter()
            .chain(symbol.children.iter().map(|child| child.span));
        for span in inner {
            assert!(
                symbol.span.start <= span.start && span.end <= symbol.span.end,
                "{symbol:?}"
            );
        }
    }
    folds(analysis);
    for (_, fix) in fixes(analysis, Span::new(SourceId::File, 0, text.len())) {
        assert!(
            fix.edits.iter().all(|edit| is_place(text, edit.span)),
            "{fix:?}"
        );
    }
    if let Some(changes) = formatting(analysis) {
        let mut formatted = text.to_owned();
        for edit in changes.into_iter().rev() {
            formatted.replace_range(edit.span.range(), &edit.text);
        }
        assert_eq!(Ok(formatted), format::format(analysis.source()));
    }
    for swatch in swatches(analysis) {
        assert!(!presentations(analysis, swatch.span, Color::BLACK).is_empty());
    }
}

sampled_and_exhaustive!(every_example_gets_its_answers_while_it_is_written);

/// Every beginning of it, asked at its end; the whole, asked at every place; and it with a piece cut out, as when a line is being rewritten.
fn every_example_gets_its_answers_while_it_is_written(effort: Effort) {
    for text in effort.first(2, examples()) {
        let whole = sources(&text);
        let whole = Analysis::new(&whole);
        ask_of_all(&whole);
        let starts: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
        for at in starts.iter().copied().chain([text.len()]) {
            ask(&whole, at);
            let beginning = sources(&text[..at]);
            let analysis = Analysis::new(&beginning);
            ask(&analysis, at);
            ask_of_all(&analysis);
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
