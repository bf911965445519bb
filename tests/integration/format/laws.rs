//! What holds of every layout: the same tokens, comments and tree; twice is once.

use std::fs;

use pinhole::{
    format::format,
    scene,
    source::{Source, SourceId, Sources, Span},
    syntax,
};

use super::{all_scenes, formatted};
use crate::syntax::token_spans;

/// Tokens and comments in their order, without the white space at the ends of the lines of comments.
fn words(text: &str) -> Vec<String> {
    let source = Source::from_text("a.scn", text);
    let parsed = syntax::parse(&source, SourceId::File);
    assert_eq!(parsed.problems, []);
    let mut spans = token_spans(&parsed.tree);
    spans.extend(&parsed.comments);
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

pub fn the_laws_hold(text: &str, formatted_text: &str) {
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

/// What is wrong with a scene does not depend on its white space.
#[test]
fn the_layout_changes_no_report() {
    let said = |text: &str| {
        let sources = Sources::new(Source::from_text("a.scn", text));
        let found = scene::read(&sources).diagnostics.into_iter();
        let mut said: Vec<_> = found.map(|d| (d.code, d.message)).collect();
        said.sort();
        said
    };
    let mut wrong = 0;
    for path in all_scenes() {
        let Ok(text) = String::from_utf8(fs::read(&path).unwrap()) else {
            continue;
        };
        let words = text.replace(' ', "\n");
        for text in [text, words] {
            if let Ok(formatted) = formatted(&text) {
                assert_eq!(said(&text), said(&formatted), "{}", path.display());
                wrong += usize::from(!said(&text).is_empty());
            }
        }
    }
    assert!(wrong > 20, "{wrong} scenes with mistakes");
}
