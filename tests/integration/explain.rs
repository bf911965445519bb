//! Tests of the pages that explain the diagnostic codes. All pages have the same structure. The
//! wrong scene of a page has only the mistake that the page explains; its right scene has no
//! mistake.
//!
//! A scene is a fenced block `scn` or `scn escaped`. In a block `scn escaped`, escapes such as
//! `\xE9` stand for bytes, and escapes such as `\u{A0}` for invisible characters. A fenced block
//! `console` below a scene has a command; the scene is read with the command's `--set` arguments.
//! `PINHOLE_BLESS=1 cargo test explain` rewrites the index of the pages.

use std::{collections::BTreeSet, path::Path};

use pinhole::{
    explain::{self, GROUPS, Page},
    scene, schema,
    source::{Source, Sources},
};

use crate::{
    diagnostics::all_codes,
    format::formatted,
    program::{Folder, names, words},
    scenes::fenced,
    snapshot::assert_file,
    table::rows,
};

/// Returns the folder that contains the pages that explain the diagnostic codes.
fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/grammar/codes"))
}

/// Returns the part of `page` below the second-level heading `heading`.
fn section<'p>(page: &'p Page, heading: &str) -> &'p str {
    let start = format!("\n## {heading}\n");
    let (_, rest) = page.text.split_once(&start).expect("the heading");
    rest.split_once("\n## ").map_or(rest, |(own, _)| own)
}

/// Returns the scene in a section of a page, with the `--set` arguments of the section's command.
fn sources(section: &str) -> Sources {
    let plain = fenced(section, "scn").into_iter().map(Vec::from);
    let escaped = fenced(section, "scn escaped").into_iter().map(unescaped);
    let scenes: Vec<Vec<u8>> = plain.chain(escaped).collect();
    assert_eq!(scenes.len(), 1, "a section has one scene: {section}");
    let words = words(&fenced(section, "console").concat());
    let pairs = words.windows(2).filter(|pair| pair[0] == "--set");
    let source = Source::from_bytes("page.scn", scenes.concat());
    Sources::new(source).with_sets(pairs.map(|pair| &pair[1]))
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

#[test]
fn every_diagnostic_code_has_exactly_one_explain_page() {
    let mut files: Vec<String> = explain::pages()
        .map(|page| format!("{}.md", page.code))
        .collect();
    files.push("README.md".to_owned());
    files.sort();
    assert_eq!(
        files,
        names(folder()),
        "a code has one page, and a page one file"
    );
    let codes = explain::pages().map(|page| page.code.to_owned());
    assert_eq!(codes.collect::<BTreeSet<_>>(), all_codes());
}

#[test]
fn the_wrong_scene_of_a_page_has_only_its_code_and_the_right_one_none() {
    for page in explain::pages() {
        let found = |section: &str| scene::read(&sources(section)).diagnostics;
        let wrong = found(section(page, "Wrong")).into_iter();
        let codes: Vec<String> = wrong.map(|found| found.code).collect();
        assert_eq!(codes, [format!("pinhole::{}", page.code)], "{}", page.text);
        let right = section(page, "Right");
        assert_eq!(found(right), [], "{}", page.text);
        let right = sources(right).file;
        assert_eq!(formatted(right.text()).as_deref(), Ok(right.text()));
    }
}

#[test]
fn the_page_on_unknown_blocks_names_all_kinds_of_blocks() {
    let page = explain::pages().find(|page| page.code == "unknown_kind");
    let page = page.expect("a page on unknown blocks").text;
    let kinds: Vec<&str> = schema::BLOCKS.iter().map(|row| row.name).collect();
    let (last, others) = kinds.split_last().expect("kinds of blocks");
    let list = format!("{} and {last}", others.join(", "));
    let text = page.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains(&list), "{list}");
}

#[test]
fn explain_pages_share_one_structure_and_no_title_or_reason() {
    let mut alike = BTreeSet::new();
    for page in explain::pages() {
        let (code, lines) = (page.code, page.text.lines());
        let headings: Vec<&str> = lines.clone().filter(|l| l.starts_with('#')).collect();
        assert!(headings[0].starts_with("# "), "{code}");
        assert_eq!(headings[1..], ["## Wrong", "## Right", "## Why"], "{code}");
        let title = page.title();
        assert!(!title.ends_with('.') && !title.is_empty(), "{code}");
        let (_, meaning) = page.text.split_once("\n\n").unwrap();
        assert!(!meaning.starts_with('#'), "{code} says what it means");
        let why = section(page, "Why").trim();
        assert!(why.len() > 200, "{code} says why");
        assert!(lines.clone().count() <= 45, "{code} is short");
        assert!(lines.clone().all(|l| l.chars().count() <= 100), "{code}");
        assert!(alike.insert(title) && alike.insert(why), "{code}");
    }
}

#[test]
fn the_index_lists_every_explain_page() {
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
    assert_file(&folder().join("README.md"), &index);
}

/// Returns the output of the command `pinhole explain WORD`.
fn explained(word: &str) -> String {
    let said = Folder::with([]).done(&format!("explain {word}"));
    said.text().to_owned()
}

#[test]
fn explain_without_a_code_lists_every_code() {
    let text = explained("");
    let mut lines = text.lines().filter_map(|l| l.strip_prefix("  "));
    let codes = lines
        .clone()
        .map(|line| line.split(' ').next().unwrap().to_owned());
    assert_eq!(codes.collect::<BTreeSet<_>>(), all_codes());
    let title = "  An angle needs its unit";
    assert!(lines.any(|line| line.ends_with(title)));
}

#[test]
fn explain_describes_blocks_fields_functions_and_colours() {
    for row in schema::BLOCKS {
        let page = explained(row.name);
        assert!(page.contains(row.help), "{page}");
        for field in row.fields {
            assert!(page.contains(&format!("- `{}` (", field.name)), "{page}");
        }
    }
    let roll = "# roll\n\n`roll` of a camera: the turn about the view direction; positive dips the right side\n\n\
                (angle, `0deg` by default)\n\n```scn\nroll 30deg\n```\n";
    assert_eq!(explained("roll"), roll);
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
    let language = include_str!("../../grammar/language.md");
    assert_eq!(explained("language"), language);
    let page = explain::page("bare_angle").unwrap();
    assert_eq!(explained("bare_angle"), page.text);
}
