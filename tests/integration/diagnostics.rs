//! Compares every diagnostic with the fixtures in `tests/diagnostics`, and some whole reports with
//! snapshots of what a user sees.
//!
//! A fixture is a scene whose comments state the expected diagnostics, each below its line: `^^^`
//! marks the primary label, and `---` every other label. A line `// --set TARGET=VALUE` is an
//! argument of the command, and the expectations below it are about that argument. `//! …` is an
//! expectation about the start of the text. `PINHOLE_BLESS=1 cargo test` rewrites the expectations.

use std::{collections::BTreeSet, fs, path::Path};

use pinhole::{
    diagnostic::{self, Diagnostic, Drawing, Label, Report, Style},
    scene,
    source::{Source, SourceId, Sources, Span},
};

use crate::{scenes::scenes, snapshot::assert_file};

/// Returns the diagnostics of the text `text`, read with the `--set` arguments `sets`.
pub fn diagnose(text: &str, sets: &[&str]) -> Vec<Diagnostic> {
    let sources = Sources::new(Source::from_text("a.scn", text));
    scene::read(&sources.with_sets(sets)).diagnostics
}

/// Returns the codes of the diagnostics of `text`, read with the `--set` arguments `sets`. The
/// codes lack their common prefix `pinhole::`.
pub fn codes(text: &str, sets: &[&str]) -> Vec<String> {
    let found = diagnose(text, sets).into_iter();
    found.map(|d| d.code.replace("pinhole::", "")).collect()
}

/// Returns whether a line of a fixture is an expectation rather than a part of the scene.
fn is_expectation(line: &[u8]) -> bool {
    let Some(rest) = line.strip_prefix(b"//") else {
        return false;
    };
    let sign = rest.iter().find(|&&byte| byte != b' ');
    matches!(sign, Some(b'^' | b'!'))
        || rest.trim_ascii_start().starts_with(b"---")
        || rest.trim_ascii_start().starts_with(b"- ")
        || rest.trim_ascii_start().starts_with(b"-- ")
}

const SET: &str = "// --set ";

/// Returns the sources of a fixture: its text and its `--set` arguments.
fn read(name: &str, bytes: &[u8]) -> Sources {
    let file = Source::from_bytes(name, bytes.to_vec());
    let sets: Vec<String> = sets(&file).map(|(_, set)| set.to_owned()).collect();
    Sources::new(file).with_sets(sets)
}

/// Returns the name and the sources of each fixture.
pub fn fixtures() -> impl Iterator<Item = (String, Sources)> {
    scenes("tests/diagnostics").into_iter().map(|path| {
        let name = path.file_stem().expect("a name").to_string_lossy();
        let sources = read("fixture.scn", &fs::read(&path).expect("a fixture"));
        (name.into_owned(), sources)
    })
}

/// Returns the `--set` arguments of a fixture, each with its line number, counted from 1.
fn sets(file: &Source) -> impl Iterator<Item = (usize, &str)> {
    let lines = file.text().lines().enumerate();
    lines.filter_map(|(index, line)| Some((index + 1, line.strip_prefix(SET)?)))
}

/// Returns the correct expectations for a fixture. Each has the number of the line below which it
/// belongs, counted from 1, or 0 for the start of the text.
fn expectations(sources: &Sources) -> Vec<(usize, String)> {
    let mut expected = Vec::new();
    for diagnostic in scene::read(sources).diagnostics {
        let first = format!("{}: {}", diagnostic.code, diagnostic.message);
        for (index, label) in diagnostic.labels.iter().enumerate() {
            let (words, sign) = match index {
                0 => (&first, "^"),
                _ => (&label.message, "-"),
            };
            let (line, drawn) = underlined(sources, label, sign);
            expected.push((line, format!("{drawn} {words}\n")));
        }
    }
    expected
}

fn underlined(sources: &Sources, label: &Label, sign: &str) -> (usize, String) {
    let Span { source, start, end } = label.span;
    if source == SourceId::File && start == 0 && end == 0 {
        return (0, "//!".to_owned());
    }
    let text = sources.get(source);
    let (from, to) = (text.place(start), text.place(end));
    let (line, shift) = match sources.sets().position(|(id, _)| id == source) {
        None => (from.line, 0),
        Some(index) => (sets(&sources.file).nth(index).unwrap().0, SET.len()),
    };
    let column = from.column - 1 + shift;
    assert!(column >= 2, "{label:?}: indent the scene by two columns");
    let last = if to.line == from.line {
        to.column
    } else {
        from.column + text.line_range(from.line).end - start
    };
    let width = (last - from.column).max(1);
    let blanks = " ".repeat(column - 2);
    (line, format!("//{blanks}{}", sign.repeat(width)))
}

/// Returns the bytes of a fixture with its expectations replaced by the correct ones.
fn annotated(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    // New expectations move lines, and a message may contain a line number. So the expectations are
    // computed several times, until all line numbers are right.
    for _ in 0..4 {
        let expected = expectations(&read("fixture.scn", &bytes));
        let below = |line: usize| {
            let of_line = expected.iter().filter(move |(at, _)| *at == line);
            of_line.flat_map(|(_, words)| words.as_bytes())
        };
        let mut text: Vec<u8> = below(0).copied().collect();
        for (index, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
            if !is_expectation(line) {
                text.extend(line.iter().chain(below(index + 1)));
            }
        }
        bytes = text;
    }
    bytes
}

#[test]
fn diagnostic_fixtures_match_their_annotations() {
    for path in scenes("tests/diagnostics") {
        let bytes = fs::read(&path).expect("the fixture can be read");
        let annotated = annotated(&bytes);
        if std::env::var_os("PINHOLE_BLESS").is_some() {
            fs::write(&path, &annotated).expect("the fixture can be written");
        } else {
            let [is, should] = [&bytes, &annotated].map(|text| String::from_utf8_lossy(text));
            assert_eq!(is, should, "{}", path.display());
        }
    }
}

/// Returns the codes of all diagnostics in the source files of the parser and of the translation to
/// a scene (`src/syntax/messages.rs` and `src/scene`). The codes lack their prefix `pinhole::`.
pub fn all_codes() -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut codes = BTreeSet::new();
    let mut paths = vec![root.join("src/scene"), root.join("src/syntax/messages.rs")];
    while let Some(path) = paths.pop() {
        if let Ok(entries) = fs::read_dir(&path) {
            paths.extend(entries.map(|entry| entry.expect("an entry").path()));
            continue;
        }
        let text = fs::read_to_string(path).expect("the source can be read");
        for start in ["error(", "warning(", "twice(", "Message::new(["] {
            let calls = text.split(start).skip(1);
            let quoted = calls.filter_map(|call| call.trim_start().strip_prefix('"'));
            let quoted = quoted.filter_map(|text| text.split_once('"'));
            codes.extend(quoted.map(|(code, _)| code.to_owned()));
        }
    }
    codes
}

#[test]
fn every_code_has_a_fixture_and_every_diagnostic_has_help_and_labels() {
    let mut names = BTreeSet::new();
    for (name, sources) in fixtures() {
        let found = scene::read(&sources).diagnostics;
        let code = format!("pinhole::{name}");
        assert!(found.iter().any(|d| d.code == code), "{name}: {found:?}");
        names.insert(name);
        for diagnostic in found {
            let help = diagnostic.help.as_deref().unwrap_or_default();
            assert!(!help.is_empty(), "{diagnostic:?}");
            assert!(!diagnostic.labels.is_empty(), "{diagnostic:?}");
            for words in [&diagnostic.message, help] {
                assert!(!words.ends_with('!'), "{words}");
                for jargon in ["token", "identifier", "rule", "EOI", "literal"] {
                    assert!(!words.contains(jargon), "{words}");
                }
            }
        }
    }
    assert_eq!(all_codes(), names);
}

fn report(sources: &Sources, drawing: Drawing) -> String {
    let style = Style {
        drawing,
        ..Style::default()
    };
    Report::new(sources, style).human(&scene::read(sources).diagnostics)
}

#[test]
fn whole_reports_match_their_snapshots() {
    for path in scenes("tests/diagnostics/report") {
        let name = path.file_name().expect("a name").to_string_lossy();
        let sources = read(&name, &fs::read(&path).expect("the scene can be read"));
        for (drawing, ending) in [
            (Drawing::Unicode, "txt"),
            (Drawing::Ascii, "ascii.txt"),
            (Drawing::Narrated, "narrated.txt"),
        ] {
            assert_file(&path.with_extension(ending), &report(&sources, drawing));
        }
        let json = diagnostic::json_lines(&scene::read(&sources).diagnostics, &sources);
        assert_file(&path.with_extension("json"), &json);
    }
}

#[test]
fn reports_are_coloured_only_on_request() {
    let sources = Sources::new(Source::from_text("a.scn", "sphere { radus 2 }"));
    let diagnostics = scene::read(&sources).diagnostics;
    let style = Style {
        color: true,
        ..Style::default()
    };
    let colored = Report::new(&sources, style).human(&diagnostics);
    assert!(colored.contains("\x1b["));
    let plain = Report::new(&sources, Style::default()).human(&diagnostics);
    assert!(!plain.contains('\x1b'));
}

#[test]
fn long_source_lines_are_cut_in_reports() {
    let long = format!(
        "sphere {{ center (0, 1, 0) {} radus 2 }}",
        "é".repeat(100_000)
    );
    let sources = Sources::new(Source::from_text("a.scn", long));
    let text = report(&sources, Drawing::Unicode);
    let is_cut = |line: &str| line.chars().count() < 250;
    assert!(text.lines().all(is_cut), "{text}");
}

#[test]
fn a_text_in_utf_16_is_one_mistake() {
    let marked = "\u{feff}sphere { center (0, 1, 0) }\n";
    // Some programs write UTF-16 without a byte order mark. The encoding is then recognized by its
    // zero bytes, one for each ASCII letter. Cyrillic letters, as in the comment of the scene
    // below, have no zero byte, so its ASCII letters must suffice.
    let bare = "// Кубы\nsphere { center (0, 1, 0)  radius 2 }\n";
    let texts = [marked, bare, &marked[3..]].into_iter();
    let encoded = texts.flat_map(|text| {
        [u16::to_le_bytes, u16::to_be_bytes]
            .map(|bytes| text.encode_utf16().flat_map(bytes).collect::<Vec<u8>>())
    });
    for bytes in encoded {
        let sources = Sources::new(Source::from_bytes("a.scn", bytes));
        let [found] = &scene::read(&sources).diagnostics[..] else {
            panic!("one mistake");
        };
        assert_eq!(found.code, "pinhole::invalid_utf8");
        assert_eq!(found.message, "this file is UTF-16, not UTF-8");
    }
}

/// In a narrow terminal, an excerpt of the scene shows only the surroundings of the label, and all
/// other lines wrap at words. A line may be wider than the terminal only if it contains a very long
/// word. Diagnostics with several labels are not tested, because their excerpts may be wider too.
#[test]
fn reports_fit_into_the_terminal() {
    let mut cut = 0;
    for (name, sources) in fixtures() {
        let found = scene::read(&sources).diagnostics;
        for width in [60, 80] {
            let style = Style {
                width,
                excerpt: Some(width - 8),
                ..Style::default()
            };
            let report = Report::new(&sources, style);
            for diagnostic in found.iter().filter(|found| found.labels.len() == 1) {
                let text = report.one(diagnostic);
                cut += usize::from(text.contains('…'));
                for line in text.lines() {
                    let columns = line.chars().count();
                    let longest = line.split(' ').map(|word| word.chars().count()).max();
                    let is_word = longest.unwrap_or(0) + 20 > width;
                    assert!(columns <= width || is_word, "{width}, {name}: {line}");
                }
            }
        }
    }
    assert!(cut > 50, "{cut}");
}
