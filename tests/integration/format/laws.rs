//! Tests of laws that the formatter must obey: it keeps tokens, comments and the syntax tree, and
//! formatting twice gives the same result as formatting once.

use pinhole::{
    source::{Source, SourceId},
    syntax,
};

use super::{all_scenes, formatted};
use crate::{diagnostics::diagnose, syntax::tokens};

/// Returns the tokens and comments of a text in order. White space at line ends within comments is
/// removed.
fn words(text: &str) -> Vec<String> {
    let tidy = |token: &str| {
        let lines = token.lines();
        let lines: Vec<&str> = lines
            .map(|l| l.trim_end_matches([' ', '\t', '\r']))
            .collect();
        lines.join("\n")
    };
    let text = text.trim_start_matches('\u{feff}');
    tokens(text).into_iter().map(tidy).collect()
}

/// Returns the printed syntax tree of a text, without spans.
fn tree(text: &str) -> String {
    let source = Source::from_text("a.scn", text);
    let printed = format!("{:?}", syntax::parse(&source, SourceId::File).tree);
    let mut parts = printed.split("Span {");
    let mut shape = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        shape += part.split_once('}').unwrap().1;
    }
    shape
}

pub fn assert_formatter_laws(text: &str, formatted_text: &str) {
    assert_eq!(formatted(formatted_text).as_deref(), Ok(formatted_text));
    assert_eq!(tree(text), tree(formatted_text));
    assert_eq!(words(text), words(formatted_text));
    let line_ends = formatted_text.matches('\n').count();
    let crlf = formatted_text.matches("\r\n").count();
    assert!(crlf == 0 || crlf == line_ends, "{formatted_text:?}");
    for line in formatted_text.lines() {
        assert_eq!(line.trim_end_matches([' ', '\t']), line);
    }
    // Two empty lines in a row occur only within a comment.
    for (at, _) in formatted_text.match_indices("\n\n\n") {
        // The text before the empty lines must end within a comment: it must contain a `/*` after
        // its last `*/`. The characters `/*/` begin a comment and do not end it, so they are
        // replaced before the search.
        let before = formatted_text[..at].replace("/*/", "/* ");
        assert!(
            before.rfind("/*") > before.rfind("*/"),
            "{formatted_text:?}"
        );
    }
    assert!(!formatted_text.ends_with("\n\n"));
}

/// Formatting a scene does not change its diagnostics.
#[test]
fn formatter_laws_hold_for_every_scene() {
    let said = |text: &str| {
        let found = diagnose(text, &[]).into_iter();
        let mut said: Vec<_> = found.map(|d| (d.code, d.message)).collect();
        said.sort();
        said
    };
    let (mut right, mut wrong, mut of_meaning) = (0, 0, 0);
    for text in all_scenes() {
        for text in [text.replace(' ', "\n"), text] {
            let Ok(formatted) = formatted(&text) else {
                assert!(diagnose(&text, &[]).iter().any(|d| d.is_error()), "{text}");
                wrong += 1;
                continue;
            };
            assert_formatter_laws(&text, &formatted);
            assert_eq!(said(&text), said(&formatted), "{text}");
            right += 1;
            of_meaning += usize::from(!said(&text).is_empty());
        }
    }
    let enough = right > 100 && wrong > 60 && of_meaning > 20;
    assert!(
        enough,
        "{right} right, {wrong} wrong, {of_meaning} mistaken"
    );
}
