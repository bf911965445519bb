//! `fmt`: the canonical layout of scenes.

use std::{fs, path::Path};

use diffy::Line;

use super::{
    Status, Trouble,
    args::{FmtArgs, Overrides},
    each,
    input::{Input, check_standard, is_standard, shown},
    interrupt::Interrupt,
    output,
};
use crate::{
    diagnostic::{Report, visible},
    film,
    format::format,
    source::{Source, Sources},
};

/// Lays out each scene in turn, or says what would change. The status is the gravest one.
pub fn run(args: &FmtArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    check_standard(&args.scenes)?;
    let act = if args.check { compare } else { write };
    Ok(each(&args.scenes, interrupt, |path| {
        one(path, act, interrupt)
    }))
}

/// What is done with a text and its layout; a long write ends when it is interrupted.
type Act = fn(&Path, &Source, &str, &Interrupt) -> Result<Status, Trouble>;

fn one(path: &Path, act: Act, interrupt: &Interrupt) -> Result<Status, Trouble> {
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
    match format(source) {
        Ok(formatted) => act(path, source, &formatted, interrupt),
        Err(mistakes) => {
            let sources = Sources::new(source.clone());
            output::to_people(&Report::new(&sources, output::style()).human(&mistakes));
            Ok(Status::SceneErrors)
        }
    }
}

/// Says what would change.
fn compare(_: &Path, source: &Source, formatted: &str, _: &Interrupt) -> Result<Status, Trouble> {
    if formatted == source.text() {
        return Ok(Status::Done);
    }
    output::to_people(&difference(source, formatted));
    Ok(Status::SceneErrors)
}

/// Writes the layout to where the text came from.
fn write(
    path: &Path,
    source: &Source,
    formatted: &str,
    interrupt: &Interrupt,
) -> Result<Status, Trouble> {
    if is_standard(path) {
        output::to_programs(formatted.as_bytes())?;
    } else if formatted != source.text() {
        film::write_whole(path, interrupt.watch(), |file| {
            file.write_all(formatted.as_bytes())
        })
        .map_err(|error| Trouble(format!("cannot write {}: {error}", shown(path))))?;
    }
    Ok(Status::Done)
}

/// What would change, as a unified diff. Where lines end in different ways, carriage returns are shown: lines can differ in them alone.
fn difference(source: &Source, formatted: &str) -> String {
    let patch = diffy::create_patch(source.text(), formatted);
    let name = visible(source.name());
    let color = output::style().color;
    let text = source.text();
    let is_mixed = text.matches('\n').count() != text.matches("\r\n").count();
    let mut text = format!("--- {name}\n+++ {name}, formatted\n");
    for hunk in patch.hunks() {
        text += &format!("@@ -{} +{} @@\n", hunk.old_range(), hunk.new_range());
        for line in hunk.lines() {
            let (sign, paint, value) = match *line {
                Line::Delete(value) => ('-', "\x1b[31m", value),
                Line::Insert(value) => ('+', "\x1b[32m", value),
                Line::Context(value) => (' ', "", value),
            };
            let line = value.trim_end_matches(['\n', '\r']);
            let mut line = visible(line).into_owned();
            if is_mixed && value.trim_end_matches('\n').ends_with('\r') {
                line.push('␍');
            }
            text += &match color && !paint.is_empty() {
                true => format!("{paint}{sign}{line}\x1b[0m\n"),
                false => format!("{sign}{line}\n"),
            };
            if !value.ends_with('\n') {
                text += "\\ No newline at end of file\n";
            }
        }
    }
    text
}
