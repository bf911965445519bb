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
    diagnostic::{self, Diagnostic, visible_line},
    scene::{self, Reading},
    source::Source,
};

/// The diagnostics of a file that a program is told.
const MOST: usize = 1000;

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
            let Reading { scene, diagnostics } = scene::read(&input.sources);
            let diagnostics = the_first(diagnostics);
            let lines = diagnostic::json_lines(&diagnostics, &input.sources);
            output::to_programs(lines.as_bytes())?;
            Reading { scene, diagnostics }
        }
    };
    Ok(match reading.scene {
        Some(_) => Status::Done,
        None => Status::SceneErrors,
    })
}

/// The first of many diagnostics, and one that says how many more there are.
fn the_first(mut diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let rest = diagnostics.split_off(diagnostics.len().min(MOST));
    if let Some(first) = rest.first() {
        let gravest = rest.iter().find(|diagnostic| diagnostic.is_error());
        let mut last = gravest.unwrap_or(first).clone();
        last.code = "pinhole::more".to_owned();
        last.message = format!(
            "there are {} more problems, which are not listed",
            rest.len()
        );
        last.help = Some("solve the first ones, and check again".to_owned());
        last.labels = first.labels.iter().take(1).cloned().collect();
        last.fixes = Vec::new();
        diagnostics.push(last);
    }
    diagnostics
}
