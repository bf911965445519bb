//! Compares the editor's answers with the files in `tests/editor`, in which `$0` is the cursor.

use glam::dvec2;
use pinhole::{
    color::Color,
    diagnostic::{Fix, apply},
    editor::{
        Analysis, Completion, SnippetPart, Symbol, completions, definition, fixes, folds,
        formatting, hints, hover, occurrences, presentations, renamable, rename, semantic_tokens,
        signature, swatches, symbols,
        viewport::{Along, Drag, alone, drag},
    },
    source::{SourceId, Span},
};

use crate::{
    scenes::{read, sources},
    snapshot::assert_answers,
};

/// Start of each text in which an object is dragged. The camera looks along −z, so that the effect
/// of a drag is easy to compute.
const LEVEL: &str =
    "image { width 200 height 100 } camera { eye (0, 0, 10) direction (0, 0, -1) d 8 }\n";

/// Start of each text in which the camera is dragged. The scene consists of a sphere on a
/// checkerboard.
const SEEN: &str = "image { width 400 height 200 }\nsphere { center (0, 1, 0) }\ncheckerboard {}\n";

/// Returns the labels of the completions `all`, grouped by their kind.
fn offered(all: &[Completion]) -> String {
    let kind = |completion: &Completion| {
        let kind = format!("{:?}", completion.kind);
        kind.split('(').next().unwrap_or_default().to_owned()
    };
    let groups = all.chunk_by(|a, b| kind(a) == kind(b)).map(|group| {
        let labels: Vec<&str> = group.iter().map(|c| c.label.as_str()).collect();
        format!("{}: {}", kind(&group[0]), labels.join(" "))
    });
    groups.collect::<Vec<_>>().join(" | ")
}

/// Returns `text` after `completion` is inserted. The signs `‹›` enclose its placeholders.
pub fn inserted(text: &str, completion: &Completion) -> String {
    let insert = completion.insert.iter().map(|piece| match piece {
        SnippetPart::Text(text) => text.clone(),
        SnippetPart::Placeholder(value) => format!("‹{value}›"),
    });
    let mut text = text.to_owned();
    text.replace_range(completion.replaces.range(), &insert.collect::<String>());
    text
}

/// Returns the text with `‹›` around each use of the name at the offset `at`, and with `«»` around
/// its definition. If the name cannot be renamed, returns the reason.
fn uses(analysis: &Analysis<'_>, at: usize) -> String {
    let mut text = analysis.text().to_owned();
    let found = occurrences(analysis, at);
    for used in found.iter().rev() {
        let [open, close] = if used.is_definition {
            ["«", "»"]
        } else {
            ["‹", "›"]
        };
        text.insert_str(used.span.end, close);
        text.insert_str(used.span.start, open);
    }
    let mut definitions = found.iter().filter(|used| used.is_definition);
    let defined = definitions.next().map(|used| used.span);
    assert_eq!(definition(analysis, at), defined);
    renamable(analysis, at).map_or_else(|why| why, |_| text)
}

/// Returns the signature of the call at the offset `at`, with `‹›` around the parameter that is
/// being typed. Returns `None` if there is no call.
fn called(analysis: &Analysis<'_>, at: usize) -> Option<String> {
    let found = signature(analysis, at)?;
    let mut label = found.label;
    if let Some(parameter) = found.parameters.get(found.active) {
        label.insert(parameter.end, '›');
        label.insert(parameter.start, '‹');
    }
    Some(label)
}

/// Formats an outline: a line for each definition and block, and the fields of each block.
fn outline(symbols: &[Symbol]) -> String {
    let shown = |symbol: &Symbol| format!("{:?} {} {}", symbol.kind, symbol.name, symbol.detail);
    let lines = symbols.iter().map(|symbol| {
        let children: Vec<String> = symbol.children.iter().map(shown).collect();
        format!("{} [{}]", shown(symbol), children.join(", "))
    });
    lines.collect::<Vec<_>>().join(" | ")
}

/// Returns the text after the drag `moved`. If the drag is refused, returns the reason.
pub fn dragged(text: &str, moved: &Drag<'_>) -> Result<String, String> {
    let (sources, scene) = (sources(text), read(text));
    let alone = alone(&sources, &scene, moved.object);
    let dragged = drag(&sources, &alone, &scene, moved)?;
    Ok(apply(&Fix::new("", dragged.edits), SourceId::File, text))
}

/// Applies a drag to the text `start` followed by `text`, and returns the part of the result after
/// `start`. `words` is separated by spaces and begins with the name of the handle. For an object,
/// the x and y to which the handle is dragged follow, and optionally the axis or plane of the
/// movement. For the camera (`object` is `None`), the pointer's x and y before and after the drag
/// follow.
fn after_drag(start: &str, text: &str, object: Option<usize>, words: &str) -> String {
    let words: Vec<&str> = words.split(' ').collect();
    let point = |at: usize| dvec2(words[at].parse().unwrap(), words[at + 1].parse().unwrap());
    let (from, to, along) = match object {
        Some(_) => (1, 1, words.get(3)),
        None => (1, 3, None),
    };
    let moved = Drag {
        object,
        handle: words[0],
        from: point(from),
        to: point(to),
        along: along.and_then(|along| Along::named(along)),
        step: None,
        observer: None,
    };
    match dragged(&format!("{start}{text}"), &moved) {
        Ok(text) => text[start.len()..].to_owned(),
        Err(why) => why,
    }
}

/// Returns the answer to the query `question`, such as `hover`, about `text`. The query is about
/// the place of `$0` in the text, or about a part of the text in brackets. `other` is an argument
/// of the query, such as the label of a completion; it is empty if there is none.
fn answer(question: &str, text: &str, other: &str) -> String {
    let at = text.find(['$', '[']).unwrap_or_default();
    let end = text.find(']').map_or(at, |end| end - 1);
    let sources = sources(&text.replace("$0", "").replace(['[', ']'], ""));
    let analysis = &Analysis::new(&sources);
    let (text, span) = (analysis.text(), Span::new(SourceId::File, at, end));
    let all = completions(analysis, at);
    let parts: Vec<String> = match question {
        "offered" => vec![offered(&all)],
        "inserted" => all
            .iter()
            .filter(|completion| completion.label == other)
            .map(|c| {
                format!(
                    "{} | {:?} | {} | {}",
                    inserted(text, c),
                    c.kind,
                    c.detail,
                    c.help
                )
            })
            .collect(),
        "hover" => hover(analysis, at)
            .map(|hover| format!("‹{}› {}", analysis.slice(hover.span), hover.markdown))
            .into_iter()
            .collect(),
        "called" => called(analysis, at).into_iter().collect(),
        "uses" => vec![uses(analysis, at)],
        "renamed" => vec![match rename(analysis, at, other) {
            Ok(spans) => {
                let mut text = text.to_owned();
                for span in spans.into_iter().rev() {
                    text.replace_range(span.range(), other);
                }
                text
            }
            Err(why) => why,
        }],
        "outline" => vec![outline(&symbols(analysis))],
        "folds" => folds(analysis)
            .into_iter()
            .map(|fold| format!("{:?} {}", fold.kind, analysis.slice(fold.span)))
            .collect(),
        "colors" => swatches(analysis)
            .into_iter()
            .map(|swatch| format!("{} {}", analysis.slice(swatch.span), swatch.color))
            .collect(),
        "picked" => {
            let [.., red, green, blue] = u32::from_str_radix(other, 16).unwrap().to_be_bytes();
            presentations(analysis, span, Color::from_bytes([red, green, blue]))
        }
        "remarked" => {
            let mut text = text.to_owned();
            for hint in hints(analysis, 0..text.len()).into_iter().rev() {
                text.insert_str(hint.at, &format!("‹{}›", hint.text));
            }
            vec![text]
        }
        "layout" => match formatting(analysis) {
            None => vec!["none".to_owned()],
            Some(edits) => edits
                .iter()
                .map(|edit| format!("{:?} {}", edit.span.range(), edit.text))
                .collect(),
        },
        "fixes" => fixes(analysis, span)
            .map(|(diagnostic, fix)| {
                let text = apply(fix, SourceId::File, text);
                format!("{}: {text}", diagnostic.code.replace("pinhole::", ""))
            })
            .collect(),
        "words" => semantic_tokens(analysis)
            .into_iter()
            .map(|token| {
                let mark = if token.is_declaration { "!" } else { "" };
                format!("{}:{:?}{mark}", analysis.slice(token.span), token.kind)
            })
            .collect(),
        "dragged" if text.contains("camera") => vec![after_drag("", text, Some(0), other)],
        "dragged" => vec![after_drag(LEVEL, text, Some(0), other)],
        "moved" => vec![after_drag(SEEN, text, None, other)],
        _ => panic!("{question}"),
    };
    parts.join(if question == "words" { " " } else { " | " })
}

#[test]
fn editor_answers_match_the_files_in_tests_editor() {
    assert_answers("tests/editor", answer);
}
