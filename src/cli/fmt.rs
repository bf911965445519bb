//! `fmt`: the canonical layout of scenes.

use std::{fs, path::Path};

use pinhole::{
    diagnostic::{Report, printable},
    film,
    format::format,
    source::{Source, Sources},
};
use similar::{ChangeTag, TextDiff};

use super::{
    Status, Trouble,
    args::{FmtArgs, Overrides},
    input::{Input, check_standard, is_standard, shown},
    interrupt::Interrupt,
    output,
};

/// Lays out each scene in turn, or says what would change. The status is the gravest one.
pub fn run(args: &FmtArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    check_standard(&args.scenes)?;
    let mut status = Status::Done;
    for path in &args.scenes {
        let found = one(path, args.check, interrupt).unwrap_or_else(|trouble| {
            output::error(&trouble);
            Status::Trouble
        });
        status = status.max(found);
        if interrupt.pressed() {
            return Ok(Status::Interrupted);
        }
    }
    Ok(status)
}

fn one(path: &Path, check: bool, interrupt: &Interrupt) -> Result<Status, Trouble> {
    // Opening a pipe may take for ever, and what is written into one comes back to nobody.
    let is_pipe = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    if is_pipe && !is_standard(path) {
        let hint = "fmt takes files, or standard input as `-`";
        return Err(Trouble(format!("{} is not a file: {hint}", shown(path))));
    }
    let no_overrides = Overrides { sets: Vec::new() };
    let input = Input::read(path, &no_overrides)?;
    if input.is_picture {
        return Err(Trouble(format!(
            "{} is a picture; fmt takes the scene's text",
            shown(path)
        )));
    }
    let source = &input.sources.file;
    let formatted = match format(source) {
        Ok(formatted) => formatted,
        Err(mistakes) => {
            let sources = Sources::new(source.clone());
            output::to_people(&Report::new(&sources, output::style()).human(&mistakes));
            return Ok(Status::SceneErrors);
        }
    };
    let changes = formatted != source.text();
    if check {
        if changes {
            output::to_people(&difference(source, &formatted));
        }
        return Ok(match changes {
            true => Status::SceneErrors,
            false => Status::Done,
        });
    }
    if is_standard(path) {
        output::to_programs(formatted.as_bytes())?;
    } else if changes {
        film::write_whole(path, interrupt.watch(), |file| {
            file.write_all(formatted.as_bytes())
        })
        .map_err(|error| Trouble(format!("cannot write {}: {error}", shown(path))))?;
    }
    Ok(Status::Done)
}

/// What would change, as a unified diff.
fn difference(source: &Source, formatted: &str) -> String {
    let lines = TextDiff::from_lines(source.text(), formatted);
    let name = source.name();
    let color = output::style().color;
    let mut text = format!("--- {name}\n+++ {name}, formatted\n");
    for hunk in lines.unified_diff().iter_hunks() {
        text += &format!("{}\n", hunk.header());
        for change in hunk.iter_changes() {
            let (sign, paint) = match change.tag() {
                ChangeTag::Delete => ('-', "\x1b[31m"),
                ChangeTag::Insert => ('+', "\x1b[32m"),
                ChangeTag::Equal => (' ', ""),
            };
            let line = change.value().trim_end_matches(['\n', '\r']);
            let line: String = line.chars().map(printable).collect();
            text += &match color && !paint.is_empty() {
                true => format!("{paint}{sign}{line}\x1b[0m\n"),
                false => format!("{sign}{line}\n"),
            };
            if change.missing_newline() {
                text += "\\ No newline at end of file\n";
            }
        }
    }
    text
}
