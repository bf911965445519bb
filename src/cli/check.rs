//! `check`: the problems of scenes, and with `--fix` the way out of those that have one.

use std::path::Path;

use super::{
    Status, Trouble,
    args::{CheckArgs, Format},
    each,
    input::{Input, change, check_standard, is_standard},
    interrupt::Interrupt,
    output,
};
use crate::{
    diagnostic::{self, visible_line},
    scene,
    source::Source,
};

/// Reports the problems of each scene in turn. The status is the gravest one.
pub fn run(args: &CheckArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    check_standard(&args.scenes)?;
    let is_json = args.format.format == Format::Json;
    if args.fix && is_json && args.scenes.iter().any(|path| is_standard(path)) {
        let hint = "the text of `-` goes to standard output itself";
        return Err(Trouble(format!(
            "--fix and --format json do not go together here: {hint}"
        )));
    }
    Ok(each(&args.scenes, interrupt, |path| {
        one(path, args, interrupt)
    }))
}

fn one(path: &Path, args: &CheckArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let input = match args.fix {
        true => fixed(path, args, interrupt)?,
        false => Input::read(path, &args.overrides)?,
    };
    report(&input, args.format.format)
}

/// Fixes the errors of a file, and says what was done.
fn fixed(path: &Path, args: &CheckArgs, interrupt: &Interrupt) -> Result<Input, Trouble> {
    let (mut input, original) = Input::to_change(path, &args.overrides, "--fix")?;
    let fixed = scene::fix_all(&input.sources);
    match &original {
        None => output::to_programs(fixed.text.as_bytes())?,
        Some(original) if fixed.text != input.sources.file.text() => {
            change(path, original, &fixed.text, interrupt)?;
        }
        Some(_) => {}
    }
    let name = input.sources.file.name().to_owned();
    for done in &fixed.done {
        let (line, column) = (done.place.line, done.place.column);
        let title = visible_line(&done.title);
        let name = visible_line(&name);
        output::to_people(&format!("{name}:{line}:{column}: {title}\n"));
    }
    if !fixed.done.is_empty() {
        input.sources.file = Source::from_text(name, fixed.text);
    }
    Ok(input)
}

fn report(input: &Input, format: Format) -> Result<Status, Trouble> {
    let reading = match format {
        Format::Human => {
            let reading = input.scene();
            if reading.diagnostics.is_empty() && output::is_watched() {
                let name = visible_line(input.sources.file.name());
                output::to_people(&format!("{name}: ok\n"));
            }
            reading
        }
        Format::Json => {
            let reading = scene::read(&input.sources);
            let lines = diagnostic::json_lines(&reading.diagnostics, &input.sources);
            output::to_programs(lines.as_bytes())?;
            reading
        }
    };
    Ok(match reading.scene {
        Some(_) => Status::Done,
        None => Status::SceneErrors,
    })
}
