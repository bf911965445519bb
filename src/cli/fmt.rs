//! `fmt`: the canonical layout of scenes.

use std::path::Path;

use super::{
    Status, Trouble,
    args::{FmtArgs, Overrides},
    difference::difference,
    each,
    input::{Input, change, check_standard},
    interrupt::Interrupt,
    output,
};
use crate::{
    diagnostic::Report,
    files::Original,
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

/// Where a text comes from, unless it is standard input, and what was there.
type Origin<'a> = Option<(&'a Path, &'a Original)>;

/// What is done with a text and its layout; a long write ends when it is interrupted.
type Act = fn(Origin, &Source, &str, &Interrupt) -> Result<Status, Trouble>;

fn one(path: &Path, act: Act, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let no_overrides = Overrides { sets: Vec::new() };
    let (input, original) = Input::to_change(path, &no_overrides, "fmt")?;
    let source = &input.sources.file;
    match format(source) {
        Ok(formatted) => {
            let origin = original.as_ref().map(|original| (path, original));
            act(origin, source, &formatted, interrupt)
        }
        Err(mistakes) => {
            let sources = Sources::new(source.clone());
            output::to_people(&Report::new(&sources, output::style()).human(&mistakes));
            Ok(Status::SceneErrors)
        }
    }
}

/// Says what would change.
fn compare(_: Origin, source: &Source, formatted: &str, _: &Interrupt) -> Result<Status, Trouble> {
    if formatted == source.text() {
        return Ok(Status::Done);
    }
    output::to_people(&difference(source, formatted));
    Ok(Status::SceneErrors)
}

/// Writes the layout to where the text came from.
fn write(
    origin: Origin,
    source: &Source,
    formatted: &str,
    interrupt: &Interrupt,
) -> Result<Status, Trouble> {
    match origin {
        None => output::to_programs(formatted.as_bytes())?,
        Some((path, original)) if formatted != source.text() => {
            change(path, original, formatted, interrupt)?;
        }
        Some(_) => {}
    }
    Ok(Status::Done)
}
