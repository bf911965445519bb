//! `fmt`: writes scenes in the canonical layout.

use std::path::Path;

use super::{
    CommandError, Status,
    args::{FmtArgs, Overrides},
    each,
    input::{SceneInput, change, check_standard},
    interrupt::Interrupt,
    layout_diff::layout_diff,
    output,
};
use crate::{diagnostic::Report, format::format, source::Sources};

/// Formats each scene in turn. With `--check`, prints what would change instead. Returns the
/// largest of the exit statuses.
pub fn run(args: &FmtArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    check_standard(&args.scenes)?;
    Ok(each(&args.scenes, interrupt, |path| {
        one(path, args, interrupt)
    }))
}

fn one(path: &Path, args: &FmtArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let no_overrides = Overrides { sets: Vec::new() };
    let (input, original) = SceneInput::to_change(path, &no_overrides, "fmt")?;
    let source = &input.sources.file;
    match format(source) {
        Ok(formatted) if formatted == source.text() && (args.check || original.is_some()) => {
            Ok(Status::Done)
        }
        Ok(formatted) if args.check => {
            output::to_people(&layout_diff(source, &formatted));
            Ok(Status::Negative)
        }
        Ok(formatted) => {
            match &original {
                Some(original) => change(path, original, &formatted, interrupt)?,
                None => output::to_programs(formatted.as_bytes())?,
            }
            Ok(Status::Done)
        }
        Err(mistakes) => {
            let sources = Sources::new(source.clone());
            output::to_people(&Report::new(&sources, output::style()).human(&mistakes));
            Ok(Status::Negative)
        }
    }
}
