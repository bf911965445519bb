//! Every diagnostic, as the fixtures in `tests/diagnostics` say, and whole reports as people see them.
//!
//! A fixture is a scene with the expectations in its own comments, below the line that they are about: `^^^` stands under
//! the place to jump to, and `---` under every other label. A line `// --set TARGET=VALUE` is an argument, and what stands
//! below it is about the argument. `//! …` is about the start of the text. `UPDATE_EXPECT=1 cargo test` writes them anew.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use pinhole::{
    diagnostic::{self, Diagnostic, Drawing, Label, Report, Style},
    scene,
    source::{Source, SourceId, Sources, Span},
};

use crate::scenes::scenes;

fn updating() -> bool {
    std::env::var_os("UPDATE_EXPECT").is_some()
}

/// A line of a fixture that is an expectation, not a part of the scene.
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

/// The text of a fixture with the arguments that it gives.
fn read(bytes: &[u8]) -> Sources {
    let sources = Sources::new(Source::from_bytes("fixture.scn", bytes.to_vec()));
    let sets = sets(&sources.file);
    let arguments: Vec<String> = sets.into_iter().map(|(_, argument)| argument).collect();
    sources.with_sets(arguments)
}

const SET: &str = "// --set ";

/// The lines that give an argument, counted from 1, with the arguments.
fn sets(file: &Source) -> Vec<(usize, String)> {
    let lines = file.text().lines().enumerate();
    lines
        .filter_map(|(index, line)| Some((index + 1, line.strip_prefix(SET)?.to_owned())))
        .collect()
}

/// The expectations that a fixture should have, each with the line that it stands below (0: the first).
fn expectations(sources: &Sources, diagnostics: &[Diagnostic]) -> Vec<(usize, String)> {
    let sets = sets(&sources.file);
    let mut expected = Vec::new();
    for diagnostic in diagnostics {
        for (index, label) in diagnostic.labels.iter().enumerate() {
            let words = match index {
                0 => format!("{}: {}", diagnostic.code, diagnostic.message),
                _ => label.message.clone(),
            };
            let sign = if index == 0 { "^" } else { "-" };
            let (line, drawn) = under(sources, &sets, label, sign);
            expected.push((line, format!("{drawn} {words}")));
        }
    }
    expected
}

fn under(
    sources: &Sources,
    sets: &[(usize, String)],
    label: &Label,
    sign: &str,
) -> (usize, String) {
    let Span { source, start, end } = label.span;
    if source == SourceId::File && start == 0 && end == 0 {
        return (0, "//!".to_owned());
    }
    let text = sources.get(source);
    let (from, to) = (text.place(start), text.place(end));
    let (line, shift) = match sources.sets().position(|(id, _)| id == source) {
        None => (from.line, 0),
        Some(index) => (sets[index].0, SET.len()),
    };
    let column = from.column - 1 + shift;
    assert!(column >= 2, "{label:?}: indent the scene by two columns");
    let last = match to.line == from.line {
        true => to.column,
        false => from.column + text.line_range(from.line).end - start,
    };
    let width = (last - from.column).max(1);
    (
        line,
        format!("//{}{}", " ".repeat(column - 2), sign.repeat(width)),
    )
}

/// The fixture with these expectations, and without those that it had.
fn annotated(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    // A message can name a line, and a new expectation moves lines.
    for _ in 0..4 {
        let sources = read(&bytes);
        let diagnostics = scene::read(&sources).diagnostics;
        let expected = expectations(&sources, &diagnostics);
        let mut text = Vec::new();
        let push = |after: usize, text: &mut Vec<u8>| {
            for (_, words) in expected.iter().filter(|(line, _)| *line == after) {
                text.extend_from_slice(words.as_bytes());
                text.push(b'\n');
            }
        };
        push(0, &mut text);
        for (index, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
            if !is_expectation(line) {
                text.extend_from_slice(line);
                push(index + 1, &mut text);
            }
        }
        bytes = text;
    }
    bytes
}

#[test]
fn fixtures_say_what_they_produce() {
    for path in scenes("tests/diagnostics") {
        let bytes = fs::read(&path).expect("the fixture can be read");
        let annotated = annotated(&bytes);
        if updating() && annotated != bytes {
            fs::write(&path, &annotated).expect("the fixture can be written");
            continue;
        }
        let (is, should) = (
            String::from_utf8_lossy(&bytes),
            String::from_utf8_lossy(&annotated),
        );
        assert_eq!(is, should, "{}", path.display());
    }
}

/// The codes that the stages have, without `pinhole::`: where they are written.
pub fn codes() -> BTreeSet<String> {
    let mut codes = BTreeSet::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for path in sources_in(&root.join("src/scene")) {
        let text = fs::read_to_string(path).expect("the source can be read");
        for start in ["error(", "warning(", "twice("] {
            codes.extend(text.split(start).skip(1).filter_map(quoted));
        }
    }
    let messages = root.join("src/syntax/messages.rs");
    let syntax = fs::read_to_string(messages).expect("the source can be read");
    codes.extend(syntax.split("Message::new(").skip(1).filter_map(quoted));
    codes
}

/// What stands in quotes at the start of a text.
fn quoted(text: &str) -> Option<String> {
    let (quoted, _) = text.trim_start().strip_prefix('"')?.split_once('"')?;
    Some(quoted.to_owned())
}

/// Every file in a folder and in those within.
fn sources_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let paths = paths.flat_map(|path| match path.is_dir() {
        true => sources_in(&path),
        false => vec![path],
    });
    paths.collect()
}

#[test]
fn every_code_has_its_fixture_and_every_fixture_its_code() {
    let mut fixtures = BTreeSet::new();
    for path in scenes("tests/diagnostics") {
        let name = path.file_stem().expect("a name").to_string_lossy();
        let sources = read(&fs::read(&path).expect("the fixture can be read"));
        let code = format!("pinhole::{name}");
        let found = scene::read(&sources).diagnostics;
        assert!(
            found.iter().any(|d| d.code == code),
            "{name}.scn has no {code}"
        );
        fixtures.insert(name.into_owned());
    }
    assert_eq!(codes(), fixtures);
}

#[test]
fn every_report_stands_alone_and_helps() {
    for path in scenes("tests/diagnostics") {
        let sources = read(&fs::read(&path).expect("the fixture can be read"));
        for diagnostic in scene::read(&sources).diagnostics {
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
}

/// Reports on some sources in one manner.
fn reports(sources: &Sources, drawing: Drawing) -> Report<'_> {
    let style = Style {
        drawing,
        ..Style::default()
    };
    Report::new(sources, style)
}

fn report(sources: &Sources, drawing: Drawing) -> String {
    reports(sources, drawing).human(&scene::read(sources).diagnostics)
}

#[test]
fn whole_reports() {
    for path in scenes("tests/diagnostics/report") {
        let name = path.file_name().expect("a name").to_string_lossy();
        let bytes = fs::read(&path).expect("the scene can be read");
        let plain = Sources::new(Source::from_bytes(name, bytes));
        let arguments: Vec<String> = sets(&plain.file).into_iter().map(|set| set.1).collect();
        let sources = plain.with_sets(arguments);
        for (drawing, ending) in [
            (Drawing::Unicode, "txt"),
            (Drawing::Ascii, "ascii.txt"),
            (Drawing::Narrated, "narrated.txt"),
        ] {
            let beside = path.with_extension(ending);
            let drawn = report(&sources, drawing);
            if updating() {
                fs::write(&beside, drawn).expect("the report can be written");
                continue;
            }
            let expected = fs::read_to_string(&beside).unwrap_or_default();
            assert_eq!(drawn, expected, "{}", beside.display());
        }
    }
}

#[test]
fn colour_is_only_added_where_it_is_wanted() {
    let sources = Sources::new(Source::from_text("a.scn", "sphere { radus 2 }"));
    let diagnostics = scene::read(&sources).diagnostics;
    let style = Style {
        color: true,
        ..Style::default()
    };
    let colored = Report::new(&sources, style).human(&diagnostics);
    assert!(colored.contains("\x1b["));
    assert!(!report(&sources, Drawing::Unicode).contains('\x1b'));
    assert!(report(&sources, Drawing::Ascii).is_ascii());
}

#[test]
fn json_is_as_the_contract_says() {
    let text = "\u{feff}// é\r\nsphere {\r\n  radus 2\r\n}";
    let sources = Sources::new(Source::from_text("a.scn", text)).with_sets(["x=1", "cam=2"]);
    let diagnostics = scene::read(&sources).diagnostics;
    let lines = diagnostic::json_lines(&diagnostics, &sources);
    let value = |line| serde_json::from_str(line).expect("a line is an object");
    let values: Vec<serde_json::Value> = lines.lines().map(value).collect();
    let codes = values.iter().filter_map(|value| value["code"].as_str());
    let codes = codes.collect::<Vec<_>>().join(" ");
    let expected = "missing_camera missing_field unknown_field no_such_target no_such_target";
    assert_eq!(codes.replace("pinhole::", ""), expected);
    assert_eq!(
        values[2].to_string(),
        concat!(
            r#"{"file":"a.scn","severity":"error","code":"pinhole::unknown_field","#,
            r#""message":"a sphere has no field `radus`","#,
            r#""help":"did you mean `radius`? A sphere takes center, radius and color.","#,
            r#""labels":[{"offset":22,"length":5,"line":3,"column":3,"end_line":3,"end_column":8,"#,
            r#""message":"not a field of a sphere"}],"#,
            r#""fixes":[{"title":"write `radius`","edits":[{"offset":22,"length":5,"text":"radius"}]}]}"#
        )
    );
    let label = &values[4]["labels"][0];
    assert_eq!(label["file"], "--set #2");
    assert_eq!((&label["offset"], &label["length"]), (&0.into(), &3.into()));
    assert_eq!(values[4]["file"], "a.scn");
    let sources = Sources::new(Source::from_text("a.scn", text)).with_sets(["image.widht=1"]);
    let diagnostics = scene::read(&sources).diagnostics;
    let of_argument = diagnostic::to_json(&diagnostics[3], &sources);
    assert_eq!(
        of_argument["fixes"].to_string(),
        r#"[{"title":"write `width`","edits":[{"file":"--set #1","offset":6,"length":5,"text":"width"}]}]"#
    );
}

#[test]
fn labels_at_and_past_the_end_are_drawn() {
    let sources = Sources::new(Source::from_text("a.scn", "sphere {"));
    for (start, end) in [(8, 8), (8, 9), (7, 100), (100, 200), (0, 0)] {
        let nothing = Sources::new(Source::from_text("a.scn", ""));
        let mut diagnostic = scene::read(&nothing).diagnostics.remove(0);
        diagnostic.labels = vec![Label {
            span: Span::new(SourceId::File, start, end),
            message: "here it is".to_owned(),
        }];
        for drawing in [Drawing::Unicode, Drawing::Ascii, Drawing::Narrated] {
            let text = reports(&sources, drawing).one(&diagnostic);
            assert!(text.contains("here it is"), "{start}..{end}: {text}");
        }
        let json = diagnostic::to_json(&diagnostic, &sources);
        let offset = json["labels"][0]["offset"].as_u64().expect("an offset");
        assert!(offset <= 8);
    }
}

#[test]
fn a_long_line_is_cut() {
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
    let text = "sphere { center (0, 1, 0) }\n";
    let little = text.encode_utf16().flat_map(u16::to_le_bytes);
    let big = text.encode_utf16().flat_map(u16::to_be_bytes);
    let texts = [
        [0xFF, 0xFE].into_iter().chain(little).collect::<Vec<u8>>(),
        [0xFE, 0xFF].into_iter().chain(big).collect(),
    ];
    for bytes in texts {
        let sources = Sources::new(Source::from_bytes("a.scn", bytes));
        let found = scene::read(&sources).diagnostics;
        let codes: Vec<&str> = found.iter().map(|d| d.code.as_str()).collect();
        assert_eq!(codes, ["pinhole::invalid_utf8"]);
        assert_eq!(found[0].message, "this file is UTF-16, not UTF-8");
    }
}
