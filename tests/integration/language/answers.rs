//! Compares the scenes that texts describe, and the diagnostics of texts, with the files in
//! `tests/language`.

use pinhole::{
    diagnostic::{Diagnostic, Fix, apply},
    inspect::inspect,
    scene::{self, Shape},
    source::{SourceId, Sources, Span},
    suggest::nearest,
};

use super::{CAMERA, overrides};
use crate::{
    format::{formatted, laws::assert_formatter_laws},
    scenes::{json_of, sources},
    snapshot::assert_answers,
};

fn code(found: &Diagnostic) -> String {
    found.code.replace("pinhole::", "")
}

/// Returns the code of a diagnostic, the number of the `--set` argument that it is about, the text
/// under its first label, and its help. Arguments are numbered from 1; 0 stands for the file.
fn place(sources: &Sources, found: &Diagnostic) -> String {
    let span = found.labels[0].span;
    let argument = sources.sets().position(|(id, _)| id == span.source);
    let argument = argument.map_or(0, |index| index + 1);
    let help = found.help.as_deref().unwrap_or_default();
    format!(
        "{} {argument} `{}`: {help}",
        code(found),
        sources.text(span)
    )
}

/// Returns the code of a diagnostic, its message, its first label and its help.
fn said(_: &Sources, found: &Diagnostic) -> String {
    let help = found.help.as_deref().unwrap_or_default();
    let label = &found.labels[0].message;
    format!("{}: {} | {label} | {help}", code(found), found.message)
}

/// Applies the fix that `remove` makes for the part of `text` in brackets, and returns the
/// resulting text followed by the fix's title.
fn without(text: &str, remove: fn(String, Span, &Sources) -> Fix) -> String {
    let (start, end) = (text.find('[').unwrap(), text.find(']').unwrap() - 1);
    let sources = sources(&text.replace(['[', ']'], ""));
    let fix = remove(
        String::new(),
        Span::new(SourceId::File, start, end),
        &sources,
    );
    apply(&fix, SourceId::File, sources.file.text()) + &fix.title
}

fn answer(question: &str, text: &str, other: &str) -> String {
    let is_seen = text.contains("camera {");
    let camera = if is_seen { "" } else { CAMERA };
    let (whole, sets) = match question {
        "codes" => (
            format!("{text}\n{camera}sphere S {{ center (0, 1, 0) }}"),
            other,
        ),
        "x" => (format!("{CAMERA}sphere {{ center ({text}, 0, 0) }}"), other),
        "color" => (
            format!("{CAMERA}sphere {{ center (0, 0, 0) color {text} }}"),
            other,
        ),
        "means" => (format!("{camera}{text}"), other),
        "set" if other.is_empty() => (overrides::SCENE.to_owned(), text),
        "set" => (other.to_owned(), text),
        _ => (text.to_owned(), other),
    };
    let sets = sets.split("; ").filter(|set| !set.is_empty());
    let sources = sources(&whole).with_sets(sets);
    let found = |of: fn(&Sources, &Diagnostic) -> String, between: &str| {
        let found = scene::read(&sources).diagnostics;
        let said: Vec<String> = found.iter().map(|found| of(&sources, found)).collect();
        said.join(between)
    };
    match question {
        "codes" | "alone" => found(|_, found| code(found), " "),
        "said" => found(said, "; "),
        "set" => found(place, "; "),
        "means" => {
            let [settings, shapes] = overrides::meaning(&sources);
            if shapes == "[]" { settings } else { shapes }
        }
        "inspected" => {
            let scene = scene::read(&sources).scene.expect(text);
            json_of(&inspect(&scene, &sources.file)).to_string()
        }
        "x" | "color" => match scene::read(&sources).scene.map(|s| s.objects[0].shape) {
            Some(Shape::Sphere(sphere)) if question == "x" => format!("{:?}", sphere.center.x),
            Some(Shape::Sphere(sphere)) => format!("{:?}", sphere.color.srgb),
            _ => found(|_, found| code(found), " "),
        },
        "without" => without(text, Fix::remove),
        "without_all" => without(text, Fix::remove_whole),
        "near" => {
            let near = nearest(text, ["center", "radius", "color", "d", "up"]);
            near.unwrap_or_default().to_owned()
        }
        "layout" => match formatted(text) {
            Err(codes) => codes.join(" ").replace("pinhole::", ""),
            Ok(layout) => {
                assert_formatter_laws(text, &layout);
                let marked = formatted(&format!("\u{feff}{text}"));
                assert_eq!(marked, Ok(format!("\u{feff}{layout}")));
                layout
            }
        },
        _ => panic!("{question}"),
    }
}

#[test]
fn meanings_of_texts_match_the_files_in_tests_language() {
    assert_answers("tests/language", answer);
}
