//! `explain`: prints the page of a diagnostic code, the page of a word of the language, the
//! language reference, or the list of all codes.
//!
//! The page goes to standard output, since it may be piped into a pager. It is Markdown unless
//! standard output is a terminal.

use std::{borrow::Cow, fmt::Write};

use textwrap::WordSplitter;

use super::{CommandError, Status, args::ExplainArgs, command_error, output};
use crate::{
    diagnostic::Style,
    explain::{self, GROUPS},
    scene::describe,
    schema, suggest,
};

/// Maximum width of a printed page, in columns. Even on a wider terminal, lines are not longer,
/// because long lines are hard to read. Any similar width works.
const WIDEST: usize = 90;

/// Prints the page of `args.words`, or the list of all codes if there are no words.
pub fn run(args: &ExplainArgs) -> Result<Status, CommandError> {
    let style = output::page_style();
    let headings = style.map_or(Headings::Plain, Headings::of);
    let text = match args.words.as_slice() {
        [] => match style {
            Some(style) => output::wrapped(&list(headings), style.width),
            None => list(headings),
        },
        words => {
            let page = page(&words.join(" "))?;
            match style {
                Some(style) => drawn(&page, style.width.clamp(20, WIDEST), headings),
                None => page.into_owned(),
            }
        }
    };
    output::page(&text)?;
    Ok(Status::Done)
}

/// Style of the headings of a printed page.
#[derive(Clone, Copy)]
enum Headings {
    Plain,
    Bold,
}

impl Headings {
    /// Returns bold headings if the terminal shows colours, since such a terminal also shows bold
    /// text.
    fn of(style: Style) -> Self {
        if style.color { Self::Bold } else { Self::Plain }
    }

    fn heading(self, words: &str) -> String {
        match self {
            Self::Bold => format!("\x1b[1m{words}\x1b[0m"),
            Self::Plain => words.to_owned(),
        }
    }
}

/// Returns the page of a diagnostic code or a word, as Markdown. If there is none, the error
/// suggests a similar word.
fn page(word: &str) -> Result<Cow<'static, str>, CommandError> {
    let trimmed = word.trim();
    if trimmed.is_empty() {
        let hint = "`pinhole explain` lists all codes";
        return Err(command_error(format!("the code is empty: {hint}")));
    }
    if trimmed == "language" {
        return Ok(explain::LANGUAGE.into());
    }
    let field = || describe::field_of(&trimmed.replacen(' ', ".", 1));
    if explain::page(trimmed).is_none()
        && let Some(page) = describe::word(trimmed).or_else(field)
    {
        return Ok(with_reasons(page, trimmed).into());
    }
    let of_vector = trimmed
        .rsplit_once('.')
        .filter(|(block, axis)| schema::block(block).is_none() && matches!(*axis, "x" | "y" | "z"));
    let asked = of_vector.map_or(trimmed, |_| "ball.x");
    // In a shell, `vanishing point` must be quoted, so it may also be written as `vanishing_point`
    // or `vanishing-point`.
    let spaced = asked.replace(['_', '-'], " ");
    let is_asked = |name: &str| {
        [asked, &spaced]
            .iter()
            .any(|it| name.eq_ignore_ascii_case(it))
    };
    let other = explain::other_names().find(|(name, _)| is_asked(name));
    let heading = explain::headings().find(|heading| is_asked(heading));
    let meant = other.map(|(_, meant)| meant).or(heading).unwrap_or(trimmed);
    if meant == "left_handed" {
        return Ok(explain::LEFT_HANDED.into());
    }
    if let Some(page) = explain::page(meant) {
        return Ok(page.text.into());
    }
    if let Some(page) = meant
        .split_once(": ")
        .and_then(|(heading, words)| explain::part(heading, words))
    {
        return Ok(page.into());
    }
    if let Some(page) = explain::section(meant) {
        return Ok(format!("{page}\n").into());
    }
    if let Some(page) = describe::word(meant) {
        return Ok(page.into());
    }
    let codes = explain::pages().map(|page| page.code);
    let pages = ["language", "left_handed"].into_iter();
    let words = codes.chain(describe::words()).chain(pages);
    let others = explain::other_names().map(|(name, _)| name);
    let words = words.chain(explain::headings()).chain(others);
    let near = suggest::nearest(explain::short(trimmed), words);
    let of_block = trimmed
        .split_once('.')
        .and_then(|(block, field)| Some((schema::block(block)?, field)));
    let hint = match (near, of_block) {
        (_, Some((row, field))) => {
            let fields = suggest::list(row.field_names());
            return Err(command_error(format!(
                "{} has no field `{field}`: it takes {fields}",
                row.noun
            )));
        }
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, _) => {
            "`pinhole explain` lists the codes, and `pinhole explain language` is the reference"
                .to_owned()
        }
    };
    Err(command_error(format!(
        "nothing is known about `{word}`: {hint}"
    )))
}

/// Appends the reasons why a sampling method works well, if `word` is the name of a method.
fn with_reasons(page: String, word: &str) -> String {
    let section = schema::method(word).and_then(|_| explain::section_of(explain::SAMPLING, word));
    match section.and_then(|section| section.split_once("\n\n")) {
        Some((_, reasons)) => format!("{page}\n{reasons}\n"),
        None => page,
    }
}

/// Returns all codes with the titles of their pages, grouped by subject.
fn list(headings: Headings) -> String {
    let width = explain::pages().map(|page| page.code.len()).max();
    let width = width.unwrap_or_default();
    let mut text = String::new();
    for group in GROUPS {
        if !text.is_empty() {
            text.push('\n');
        }
        let _ = writeln!(text, "{}", headings.heading(group.name));
        for page in group.pages {
            let _ = writeln!(text, "  {:width$}  {}", page.code, page.title());
        }
    }
    text.push_str("\nThere are also `language`, the reference, each of its headings, such as `repetition`, a field of a block, such as `camera.up`, words such as `stratum`, `depth` or `vanishing_point`, and `left_handed`, for scenes of programs whose z points away.\n");
    text
}

/// Formats a Markdown page for a terminal: scenes are indented, lines are wrapped, and pictures are
/// left out.
fn drawn(page: &str, width: usize, headings: Headings) -> String {
    let mut text = String::new();
    let mut paragraph = String::new();
    let mut is_scene = false;
    let mut rows: Vec<Vec<&str>> = Vec::new();
    let lines = page.lines().filter(|line| !line.starts_with("!["));
    let lines = lines.map(without_targets).collect::<Vec<_>>();
    // An empty line ends a paragraph, so one is added after the last paragraph.
    for line in lines.iter().map(String::as_str).chain([""]) {
        if !is_scene && line.starts_with('|') {
            rows.push(cells(line));
            continue;
        }
        push_table(&mut text, &std::mem::take(&mut rows), width);
        if line.starts_with("```") {
            is_scene = !is_scene;
        } else if is_scene {
            let _ = writeln!(text, "    {line}");
        } else if line.starts_with('#')
            && let Some(words) = line.trim_start_matches('#').strip_prefix(' ')
        {
            let _ = writeln!(text, "{}", headings.heading(words));
        } else if line.is_empty() {
            push_wrapped(&mut text, &paragraph, width);
            paragraph.clear();
            // Where a picture was left out, two empty lines would follow each other, so only one is
            // written.
            if !text.ends_with("\n\n") {
                text.push('\n');
            }
        } else {
            if line.starts_with("- ") {
                push_wrapped(&mut text, &paragraph, width);
                paragraph.clear();
            }
            paragraph.push_str(line);
            paragraph.push(' ');
        }
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// Replaces each Markdown link by its text, since a terminal cannot follow links.
fn without_targets(line: &str) -> String {
    let link = |rest: &'_ str| {
        let at = rest.find("](")?;
        let start = rest.get(..at)?.rfind('[')?;
        let end = at + rest.get(at..)?.find(')')?;
        Some((start, at, end))
    };
    let (mut text, mut rest) = (String::new(), line);
    while let Some((start, at, end)) = link(rest) {
        text += rest.get(..start).unwrap_or_default();
        text += rest.get(start + 1..at).unwrap_or_default();
        rest = rest.get(end + 1..).unwrap_or_default();
    }
    text + rest
}

/// Splits a row of a Markdown table into cells. An escaped `\|` does not separate cells.
fn cells(line: &str) -> Vec<&str> {
    let inner = line.trim().trim_start_matches('|');
    let inner = inner.strip_suffix('|').unwrap_or(inner);
    let mut cells = Vec::new();
    let (mut start, mut before) = (0, ' ');
    for (at, c) in inner.char_indices() {
        if c == '|' && before != '\\' {
            cells.push(inner.get(start..at).unwrap_or_default().trim());
            start = at + 1;
        }
        before = c;
    }
    cells.push(inner.get(start..).unwrap_or_default().trim());
    cells
}

/// Appends a table to `text`. If its columns do not fit into `width`, each row becomes a paragraph.
fn push_table(text: &mut String, rows: &[Vec<&str>], width: usize) {
    let is_rule = |row: &&Vec<&str>| {
        row.iter()
            .all(|cell| cell.chars().all(|c| "-: ".contains(c)))
    };
    let rows: Vec<_> = rows.iter().filter(|row| !is_rule(row)).collect();
    let columns = rows.iter().map(|row| row.len()).max().unwrap_or_default();
    let length = |cell: &str| cell.chars().count();
    let widths: Vec<usize> = (0..columns)
        .map(|column| {
            let cells = rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| length(cell)).max().unwrap_or_default()
        })
        .collect();
    let fits = widths.iter().map(|width| width + 2).sum::<usize>() <= width + 2;
    for row in rows {
        if fits {
            let padded = row.iter().zip(&widths);
            let padded: Vec<String> = padded
                .map(|(cell, width)| format!("{cell}{}", " ".repeat(width - length(cell))))
                .collect();
            let _ = writeln!(text, "{}", padded.join("  ").trim_end());
        } else {
            let texts = row.iter().filter(|cell| !cell.is_empty());
            push_wrapped(text, &Vec::from_iter(texts.copied()).join(" · "), width);
        }
    }
}

/// Appends a wrapped paragraph to `text`. In a list item, all lines after the first are indented.
fn push_wrapped(text: &mut String, paragraph: &str, width: usize) {
    let words: Vec<&str> = paragraph.split_whitespace().collect();
    if words.is_empty() {
        return;
    }
    let indent = if words[0] == "-" { "  " } else { "" };
    let options = textwrap::Options::new(width).subsequent_indent(indent);
    let options = options
        .break_words(false)
        .word_splitter(WordSplitter::NoHyphenation);
    let _ = writeln!(text, "{}", textwrap::fill(&words.join(" "), options));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_shows_lines_that_fit() {
        for page in explain::pages() {
            for width in [20, 40, WIDEST] {
                let text = drawn(page.text, width, Headings::Plain);
                for line in text.lines().filter(|line| !line.starts_with("    ")) {
                    let fits = line.chars().count() <= width || line == page.title();
                    assert!(
                        fits || !line.trim_start().contains(' '),
                        "{}: {line}",
                        page.code
                    );
                }
                let is_markdown = |line: &str| line.starts_with("```") || line.starts_with("# ");
                assert!(!text.lines().any(is_markdown), "{text}");
                assert!(!text.contains("\n\n\n"), "{text}");
            }
        }
    }

    #[test]
    fn the_reference_fits_terminals() {
        let [sampling, camera] = [explain::SAMPLING, explain::CAMERA].map(|text| {
            let (_, text) = text.split_once("\n\n").unwrap();
            text
        });
        let text = format!("{}\n{sampling}\n{camera}", explain::LANGUAGE);
        for width in [20, 40, 60, 80, WIDEST] {
            let text = drawn(&text, width, Headings::Plain);
            let is_heading = |line: &str| explain::headings().any(|heading| heading == line);
            let mut lines = text
                .lines()
                .filter(|line| !line.starts_with("    ") && !is_heading(line));
            let is_wide =
                |line: &&str| line.chars().count() > width && line.trim_start().contains(' ');
            let wide = lines.find(|line| is_wide(line));
            assert_eq!(wide, None, "{width}");
            assert!(!text.contains("| --"), "{text}");
        }
    }

    #[test]
    fn what_others_call_things_is_explained() {
        let headings = explain::headings();
        let others = explain::other_names().map(|(name, _)| name);
        for word in
            headings
                .chain(others)
                .chain(["camera.up", "box.colors", "camera eye", "ball.x"])
        {
            let found = page(word).map(|page| page.starts_with('#'));
            assert!(found.is_ok_and(|is_page| is_page), "{word}");
        }
        for heading in explain::headings() {
            let found = page(heading).unwrap();
            let is_method = schema::method(heading).is_some();
            let level = if is_method { "#" } else { "##" };
            assert!(
                found.starts_with(&format!("{level} {heading}\n")),
                "{heading}"
            );
        }
        // The page of each sampling method has three parts: what it is, how it is written, and why
        // it works.
        for method in schema::method_names() {
            let page = page(method).unwrap();
            assert!(page.matches("\n\n").count() == 3, "{page}");
        }
        // Another program may use a different name for a word of the language. Both names have the
        // same page.
        for (name, meant) in explain::other_names() {
            match meant.split_once(": ") {
                None => assert_eq!(page(name).unwrap(), page(meant).unwrap(), "{name}"),
                // If another program's name means only a part of a page, such as one field, only
                // the lines about this part are printed.
                Some((_, words)) => {
                    let page = page(name).unwrap();
                    let lines: Vec<&str> = page.lines().collect();
                    let answer = lines[2].trim_start_matches("- ");
                    assert!(answer.starts_with(words) && lines.len() < 9, "{page}");
                    assert!(page.matches("\n- ").count() < 2, "{page}");
                }
            }
        }
        // A word that consists of several parts may be written with spaces, underscores or hyphens.
        for parts in [
            "vanishing point",
            "field of view",
            "view plane",
            "monte carlo",
        ] {
            for between in ["_", "-"] {
                let word = parts.replace(' ', between);
                assert_eq!(page(&word).unwrap(), page(parts).unwrap(), "{word}");
            }
        }
        // These words are explained in sections about several subjects. Only the lines about the
        // word are printed.
        for word in ["window", "horizon", "wall", "mesh", "t", "pixel", "bound"] {
            assert!(page(word).unwrap().lines().count() < 10, "{word}");
        }
        for (word, said) in [
            (
                "xyz",
                "nothing is known about `xyz`: `pinhole explain` lists the codes",
            ),
            (
                "sphre",
                "nothing is known about `sphre`: did you mean `sphere`?",
            ),
            (
                "sphere.roll",
                "a sphere has no field `roll`: it takes center, radius and color",
            ),
        ] {
            let Err(error) = page(word) else {
                panic!("{word}")
            };
            assert!(error.to_string().starts_with(said), "{error}");
        }
        assert!(page("box.radius").is_err());
    }

    #[test]
    fn links_lose_their_targets_and_items_hang() {
        let page = "see [one](#a) and [`b` two](c.md)\n\n- a [list](#list) of words\n- x\n";
        let text = "see one and\n`b` two\n\n- a list of\n  words\n- x\n";
        assert_eq!(drawn(page, 11, Headings::Plain), text);
    }

    #[test]
    fn scenes_are_indented_and_headings_bold() {
        let page = "# A title\n\nSome words\nand more.\n\n## Wrong\n\n```scn\nsphere {\n  radus 1\n}\n```\n";
        let text = drawn(page, 12, Headings::Bold);
        let expected = "\x1b[1mA title\x1b[0m\n\nSome words\nand more.\n\n\x1b[1mWrong\x1b[0m\n\n    sphere {\n      radus 1\n    }\n";
        assert_eq!(text, expected);
    }
}
