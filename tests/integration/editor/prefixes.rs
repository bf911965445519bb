//! Tests that reading or querying an incomplete or edited text never panics. Every example is cut
//! off at many offsets, and the beginning that remains is queried at its end.

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

/// Returns whether both ends of a span lie within the text and between two characters.
fn is_place(text: &str, span: Span) -> bool {
    text.get(span.range()).is_some()
}

/// Sends every kind of query about the offset `at`, and checks properties on which every client
/// relies.
fn ask_at(analysis: &Analysis<'_>, at: usize) {
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

/// Sends every kind of query about the whole text, and checks properties on which every client
/// relies.
fn ask_about_all(analysis: &Analysis<'_>) {
    let text = analysis.text();
    let hints = hints(analysis, 0..text.len());
    for hint in hints {
        // A hint in the middle of a line would shift the columns that the formatter aligns, so
        // every hint must be at the end of a line.
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

sampled_and_exhaustive!(every_prefix_and_edit_of_an_example_gets_consistent_editor_answers);

/// Queries an example, and its beginnings up to every second character. Also queries the example
/// without eight successive characters, as when a user rewrites a part of a line, and reads it
/// without one of its bytes.
fn every_prefix_and_edit_of_an_example_gets_consistent_editor_answers(effort: Effort) {
    for (index, text) in effort.first(3, examples()).enumerate() {
        let whole = sources(&text);
        let whole = Analysis::new(&whole);
        ask_about_all(&whole);
        let starts: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
        let places = starts.iter().copied().chain([text.len()]);
        for at in places.skip(index % 2).step_by(2) {
            ask_at(&whole, at);
            let beginning = &text[..at];
            robustness::read(beginning);
            parts::assert_same_in_parts(beginning, 1, &[]);
            let beginning = sources(beginning);
            let analysis = Analysis::new(&beginning);
            ask_at(&analysis, at);
            ask_about_all(&analysis);
        }
        for at in (index % 2..text.len()).step_by(2) {
            let mut bytes = text.clone().into_bytes();
            bytes.remove(at);
            robustness::read(bytes);
        }
        for window in starts.windows(9).step_by(5) {
            let cut = sources(&format!("{}{}", &text[..window[0]], &text[window[8]..]));
            let analysis = Analysis::new(&cut);
            ask_at(&analysis, window[0]);
            ask_about_all(&analysis);
        }
    }
}

#[test]
fn editor_requests_survive_malformed_texts() {
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
        // A client may send an offset within a character or beyond the end of the text. The server
        // moves such an offset to the preceding character boundary before it queries the text.
        for at in 0..text.len() + 3 {
            ask_at(&analysis, analysis.source().floor_char_boundary(at));
        }
        ask_about_all(&analysis);
    }
}
