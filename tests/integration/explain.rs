//! The pages of the diagnostic codes: each has its form, its wrong scene has that mistake and no other, its right one none.
//!
//! A scene stands in a fence `scn`, or `scn escaped`, where `\xE9` is a byte and `\u{A0}` a character that would not be seen. The
//! `--set` arguments of a command in a fence `console` apply to the scene above it. `PINHOLE_BLESS=1 cargo test explain` writes the index anew.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::PathBuf,
    process::{Command, Output},
};

use pinhole::{
    explain::{self, GROUPS, Page},
    scene,
    source::{Source, Sources},
};

use crate::{diagnostics::codes, scenes::fenced, table::rows};

/// What stands in a page below a heading of the second order.
fn section<'p>(page: &'p Page, heading: &str) -> &'p str {
    let start = format!("\n## {heading}\n");
    let (_, rest) = page.text.split_once(&start).expect("the heading");
    rest.split_once("\n## ").map_or(rest, |(own, _)| own)
}

/// The scene of a section, with the arguments.
fn sources(section: &str) -> Sources {
    let plain = fenced(section, "scn").into_iter().map(Vec::from);
    let escaped = fenced(section, "scn escaped").into_iter().map(unescaped);
    let scenes: Vec<Vec<u8>> = plain.chain(escaped).collect();
    assert_eq!(scenes.len(), 1, "a section has one scene: {section}");
    let commands = fenced(section, "console");
    let sets = commands.iter().flat_map(|command| sets(command));
    let sets: Vec<String> = sets.collect();
    Sources::new(Source::from_bytes("page.scn", scenes.concat())).with_sets(sets)
}

fn unescaped(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut parts = text.split('\\');
    bytes.extend_from_slice(parts.next().unwrap_or_default().as_bytes());
    let number = |digits| u32::from_str_radix(digits, 16).expect("a number in base 16");
    for part in parts {
        let rest = if let Some(rest) = part.strip_prefix("u{") {
            let (digits, rest) = rest.split_once('}').expect("an end");
            let character = char::from_u32(number(digits)).expect("a character");
            bytes.extend_from_slice(character.to_string().as_bytes());
            rest
        } else {
            let (digits, rest) = part.strip_prefix('x').expect("an escape").split_at(2);
            bytes.push(number(digits).try_into().expect("a byte"));
            rest
        };
        bytes.extend_from_slice(rest.as_bytes());
    }
    bytes
}

/// The `--set` arguments of a command line; quotes, if any, are single ones.
fn sets(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut is_quoted = false;
    for character in command.chars() {
        match character {
            '\'' => is_quoted = !is_quoted,
            _ if character.is_whitespace() && !is_quoted => words.push(String::new()),
            _ => words.last_mut().expect("a word").push(character),
        }
    }
    let pairs = words.windows(2).filter(|pair| pair[0] == "--set");
    pairs.map(|pair| pair[1].clone()).collect()
}

fn found(section: &str) -> Vec<String> {
    let diagnostics = scene::read(&sources(section)).diagnostics;
    diagnostics.into_iter().map(|found| found.code).collect()
}

#[test]
fn every_code_has_its_page_and_every_page_its_code() {
    let pages: BTreeSet<String> = explain::pages().map(|page| page.code.to_owned()).collect();
    assert_eq!(pages.len(), explain::pages().count(), "a code has one page");
    assert_eq!(pages, codes());
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/codes"));
    let files = fs::read_dir(folder).unwrap();
    let names: BTreeSet<String> = files
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|name| name != "README.md")
        .map(|name| name.trim_end_matches(".md").to_owned())
        .collect();
    assert_eq!(names, pages);
}

#[test]
fn the_wrong_scene_has_the_mistake_and_no_other_and_the_right_one_has_none() {
    for page in explain::pages() {
        let code = format!("pinhole::{}", page.code);
        assert_eq!(found(section(page, "Wrong")), [code], "{}", page.text);
        assert!(found(section(page, "Right")).is_empty(), "{}", page.text);
    }
}

#[test]
fn the_pages_are_of_one_form_and_no_two_are_alike() {
    let (mut titles, mut reasons) = (BTreeMap::new(), BTreeMap::new());
    for page in explain::pages() {
        let code = page.code;
        let headings: Vec<&str> = page.text.lines().filter(|l| l.starts_with('#')).collect();
        assert!(headings[0].starts_with("# "), "{code}");
        assert_eq!(headings[1..], ["## Wrong", "## Right", "## Why"], "{code}");
        let title = page.title();
        assert!(!title.ends_with('.') && !title.is_empty(), "{code}");
        let (_, meaning) = page.text.split_once("\n\n").unwrap();
        assert!(!meaning.starts_with('#'), "{code} says what it means");
        let why = section(page, "Why").trim();
        assert!(why.len() > 200, "{code} says why");
        assert!(page.text.lines().count() <= 45, "{code} is short");
        assert!(
            page.text.lines().all(|l| l.chars().count() <= 100),
            "{code}"
        );
        assert_eq!(titles.insert(title, code), None);
        assert_eq!(reasons.insert(why, code), None);
    }
}

#[test]
fn the_index_lists_all_pages() {
    let mut index = String::from(
        "# Every mistake that Pinhole reports\n\n\
         `pinhole explain CODE` prints a page of this folder.\n",
    );
    for group in GROUPS {
        index += &format!("\n## {}\n\n", group.name);
        for page in group.pages {
            index += &format!("- [`{0}`]({0}.md): {1}\n", page.code, page.title());
        }
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/codes/README.md");
    if std::env::var_os("PINHOLE_BLESS").is_some() {
        fs::write(path, &index).unwrap();
    }
    assert_eq!(fs::read_to_string(path).unwrap_or_default(), index);
}

fn explained(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
    command.arg("explain").args(arguments).output().unwrap()
}

#[test]
fn a_pipe_gets_the_page_as_it_is() {
    let codes = "bare_angle|pinhole::bare_angle|pinhole:bare_angle|[pinhole::bare_angle]|error[pinhole::bare_angle]|error[pinhole::bare_angle]:| bare_angle ";
    for code in codes.split('|') {
        let output = explained(&[code]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(output.stderr, b"");
        let page = explain::page("bare_angle").unwrap();
        assert_eq!(String::from_utf8(output.stdout).unwrap(), page.text);
    }
}

#[test]
fn without_a_code_all_are_listed() {
    let output = explained(&[]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = text.lines().filter_map(|l| l.strip_prefix("  ")).collect();
    let listed: BTreeSet<String> = lines
        .iter()
        .map(|line| line.split_whitespace().next().unwrap().to_owned())
        .collect();
    assert_eq!(listed, codes());
    assert!(
        lines
            .iter()
            .any(|l| l.ends_with("  An angle needs its unit"))
    );
}

#[test]
fn a_mistyped_code_gets_the_nearest_one() {
    let table = "
        bear_angle -> there is no code `bear_angle`: did you mean `bare_angle`?
        cammera -> there is no code `cammera`: did you mean `camera`?
        pinhole::E0308 -> there is no code `pinhole::E0308`: `pinhole explain` lists them all
         -> the code is empty: `pinhole explain` lists all codes
    ";
    for [written, says] in rows(table) {
        let output = explained(&[written]);
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(output.stdout, b"");
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(errors, format!("error: {says}\n"));
    }
}

#[test]
fn the_right_scenes_are_in_the_canonical_layout() {
    for page in explain::pages() {
        let source = sources(section(page, "Right")).file;
        let formatted = pinhole::format::format(&source).expect("it has no mistake");
        assert_eq!(source.text(), formatted, "{}", page.code);
    }
}

fn text_of(word: &str) -> String {
    let output = explained(&[word]);
    assert_eq!(output.status.code(), Some(0), "{word}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn words_of_the_language_are_explained() {
    use pinhole::schema;
    for row in schema::BLOCKS {
        let page = text_of(row.name);
        assert!(page.contains(row.help), "{page}");
        for field in row.fields {
            assert!(page.contains(&format!("- `{}` (", field.name)), "{page}");
        }
    }
    let roll = text_of("roll");
    assert_eq!(
        roll,
        "# roll\n\n`roll` of a camera: the turn about the view direction; positive dips the right side\n\n\
         (angle, `0deg` by default)\n\n```scn\nroll 30deg\n```\n"
    );
    assert!(text_of("v0").contains("not together with `centroid`, `normal`, `sides` or `spin`"));
    assert!(text_of("sobol").contains("`sobol`, a method of the sampler: Sobol' points"));
    assert!(text_of("atan2").contains("`atan2(y, x) → angle`"));
    // A field of a box and a function; a function and a colour.
    let min = text_of("min");
    assert!(min.contains("`min` of a box") && min.contains("`min(number, number, …) → number`"));
    assert!(
        text_of("tan").contains("the tangent of an angle") && text_of("tan").contains("#d2b48c")
    );
    assert_eq!(
        text_of("language"),
        include_str!("../../grammar/language.md")
    );
}
