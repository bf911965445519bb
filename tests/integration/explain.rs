//! The pages of the diagnostic codes: each has its form, its wrong scene has that mistake and no other, its right one none.
//!
//! A scene stands in a fence `scn`, or `scn escaped`, where `\xE9` is a byte and `\u{A0}` a character that would not be seen. The
//! `--set` arguments of a command in a fence `console` apply to the scene above it. `PINHOLE_BLESS=1 cargo test explain` writes the index anew.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
};

use pinhole::{
    explain::{self, GROUPS, Page},
    scene,
    source::{Source, Sources},
};

use crate::{
    diagnostics::codes,
    program::{Folder, names, words},
    scenes::fenced,
    table::rows,
};

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

/// The `--set` arguments of a command line.
fn sets(command: &str) -> Vec<String> {
    let words = words(command);
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
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/codes");
    let mut files: BTreeSet<String> = names(folder.as_ref()).into_iter().collect();
    assert!(files.remove("README.md"));
    let pages = pages.into_iter().map(|code| format!("{code}.md"));
    assert_eq!(files, pages.collect());
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

/// What is told of a word, as it is typed.
fn explained(word: &str) -> String {
    let said = Folder::with([]).done(&format!("explain {word}"));
    said.text().to_owned()
}

#[test]
fn a_pipe_gets_the_page_as_it_is() {
    let codes = "bare_angle|pinhole::bare_angle|pinhole:bare_angle|[pinhole::bare_angle]|error[pinhole::bare_angle]|error[pinhole::bare_angle]:|' bare_angle '";
    let page = explain::page("bare_angle").unwrap();
    for code in codes.split('|') {
        assert_eq!(explained(code), page.text);
    }
}

#[test]
fn without_a_code_all_are_listed() {
    let text = explained("");
    let lines: Vec<&str> = text.lines().filter_map(|l| l.strip_prefix("  ")).collect();
    let code = |line: &&str| line.split(' ').next().unwrap().to_owned();
    assert_eq!(lines.iter().map(code).collect::<BTreeSet<_>>(), codes());
    let title = "  An angle needs its unit";
    assert!(lines.iter().any(|line| line.ends_with(title)));
}

#[test]
fn a_mistyped_code_gets_the_nearest_one() {
    let table = "
        bear_angle -> there is no code `bear_angle`: did you mean `bare_angle`?
        cammera -> there is no code `cammera`: did you mean `camera`?
        pinhole::E0308 -> there is no code `pinhole::E0308`: `pinhole explain` lists them all
        '' -> the code is empty: `pinhole explain` lists all codes
    ";
    for [written, says] in rows(table) {
        let told = Folder::with([]).told(&format!("explain {written}"), 2);
        assert_eq!(told, format!("error: {says}\n"));
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

#[test]
fn words_of_the_language_are_explained() {
    use pinhole::schema;
    for row in schema::BLOCKS {
        let page = explained(row.name);
        assert!(page.contains(row.help), "{page}");
        for field in row.fields {
            assert!(page.contains(&format!("- `{}` (", field.name)), "{page}");
        }
    }
    let roll = explained("roll");
    assert_eq!(
        roll,
        "# roll\n\n`roll` of a camera: the turn about the view direction; positive dips the right side\n\n\
         (angle, `0deg` by default)\n\n```scn\nroll 30deg\n```\n"
    );
    for [word, part] in rows(
        "
        v0 -> not together with `centroid`, `normal`, `sides` or `spin`
        sobol -> `sobol`, a method of the sampler: Sobol' points
        atan2 -> `atan2(y, x) → angle`
        -- A field of a box and a function; a function and a colour.
        min -> `min` of a box
        min -> `min(number, number, …) → number`
        tan -> the tangent of an angle
        tan -> #d2b48c
    ",
    ) {
        assert!(explained(word).contains(part), "{word}: {part}");
    }
    assert_eq!(
        explained("language"),
        include_str!("../../grammar/language.md")
    );
}
