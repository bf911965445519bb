//! `explain`: the page of a diagnostic code, or the list of all.
//!
//! The answer is what was asked for, and is to be piped into a pager: so it goes to standard output, as the manual does, as Markdown
//! unless a terminal shows it.

use std::fmt::Write;

use pinhole::{
    diagnostic::Style,
    explain::{self, GROUPS, Page},
    suggest,
};

use super::{Status, Trouble, args::ExplainArgs, output};

/// Longer lines are hard to read, however wide the terminal is.
const WIDEST: usize = 90;

/// Prints the page, or the list.
pub fn run(args: &ExplainArgs) -> Result<Status, Trouble> {
    let style = output::page_style();
    let text = match (&args.code, style) {
        (None, None) => list(Headings::Plain),
        (None, Some(style)) => list(Headings::of(style)),
        (Some(code), Some(style)) => drawn(
            page(code)?,
            style.width.clamp(20, WIDEST),
            Headings::of(style),
        ),
        (Some(code), None) => page(code)?.text.to_owned(),
    };
    output::to_programs(text.as_bytes())?;
    Ok(Status::Done)
}

/// How headings stand out.
#[derive(Clone, Copy)]
enum Headings {
    Plain,
    Bold,
}

impl Headings {
    /// Bold is a colour, as far as a terminal is concerned.
    fn of(style: Style) -> Self {
        match style.color {
            true => Self::Bold,
            false => Self::Plain,
        }
    }

    fn heading(self, words: &str) -> String {
        match self {
            Self::Bold => format!("\x1b[1m{words}\x1b[0m"),
            Self::Plain => words.to_owned(),
        }
    }
}

fn page(code: &str) -> Result<&'static Page, Trouble> {
    if code.trim().is_empty() {
        let hint = "`pinhole explain` lists all codes";
        return Err(Trouble(format!("the code is empty: {hint}")));
    }
    explain::page(code).ok_or_else(|| {
        let codes = explain::pages().map(|page| page.code);
        Trouble(match suggest::nearest(explain::short(code), codes) {
            Some(near) => format!("there is no code `{code}`: did you mean `{near}`?"),
            None => format!("there is no code `{code}`: `pinhole explain` lists them all"),
        })
    })
}

/// All codes with their titles, by subject.
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
    text
}

/// A page for a terminal: scenes indented, and lines that fit.
fn drawn(page: &Page, width: usize, headings: Headings) -> String {
    let mut text = String::new();
    let mut paragraph = String::new();
    let mut is_scene = false;
    // The empty line after the last one ends its paragraph.
    for line in page.text.lines().chain([""]) {
        if line.starts_with("```") {
            is_scene = !is_scene;
        } else if is_scene {
            let _ = writeln!(text, "    {line}");
        } else if let Some(words) = line.trim_start_matches('#').strip_prefix(' ') {
            let _ = writeln!(text, "{}", headings.heading(words));
        } else if line.is_empty() {
            push_wrapped(&mut text, &paragraph, width);
            paragraph.clear();
            text.push('\n');
        } else {
            paragraph.push_str(line);
            paragraph.push(' ');
        }
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

fn push_wrapped(text: &mut String, paragraph: &str, width: usize) {
    let mut used = 0;
    for word in paragraph.split_whitespace() {
        let length = word.chars().count();
        match used {
            0 => {}
            _ if used + 1 + length > width => {
                text.push('\n');
                used = 0;
            }
            _ => {
                text.push(' ');
                used += 1;
            }
        }
        text.push_str(word);
        used += length;
    }
    if used > 0 {
        text.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_shows_lines_that_fit() {
        for page in explain::pages() {
            for width in [20, 40, WIDEST] {
                let text = drawn(page, width, Headings::Plain);
                for line in text.lines().filter(|line| !line.starts_with("    ")) {
                    let fits = line.chars().count() <= width || line == page.title();
                    assert!(fits || !line.contains(' '), "{}: {line}", page.code);
                }
                let is_markdown = |line: &str| line.starts_with("```") || line.starts_with("# ");
                assert!(!text.lines().any(is_markdown), "{text}");
                assert!(!text.contains("\n\n\n"), "{text}");
            }
        }
    }

    #[test]
    fn scenes_are_indented_and_headings_bold() {
        let page = Page {
            code: "test",
            text: "# A title\n\nSome words\nand more.\n\n## Wrong\n\n```scn\nsphere {\n  radus 1\n}\n```\n",
        };
        let text = drawn(&page, 12, Headings::Bold);
        let expected = "\x1b[1mA title\x1b[0m\n\nSome words\nand more.\n\n\x1b[1mWrong\x1b[0m\n\n    sphere {\n      radus 1\n    }\n";
        assert_eq!(text, expected);
    }
}
