//! `check`: reports the problems of scenes and, with `--fix`, applies their fixes.

use std::path::Path;

use super::{
    CommandError, Status,
    args::{AnswerFormat, CheckArgs},
    command_error, each,
    input::{SceneInput, change, check_standard, is_standard},
    interrupt::Interrupt,
    output,
    unified_diff::unified_diff,
};
use crate::{
    diagnostic::{self, Applicability, visible_line},
    scene::{self, Fixed},
    source::Source,
};

/// Checks each scene in turn and reports its problems. Returns the largest of the exit statuses.
pub fn run(args: &CheckArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    check_standard(&args.scenes)?;
    let is_json = args.format.format == AnswerFormat::Json;
    if args.fix && is_json && args.scenes.iter().any(|path| is_standard(path)) {
        let hint = "the text of `-` goes to standard output itself";
        return Err(command_error(format!(
            "--fix and --format json do not go together here: {hint}"
        )));
    }
    if args.diff && is_json {
        let hint = "both go to standard output";
        return Err(command_error(format!(
            "--diff and --format json do not go together: {hint}"
        )));
    }
    Ok(each(&args.scenes, interrupt, |path| {
        one(path, args, interrupt)
    }))
}

fn one(path: &Path, args: &CheckArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let input = if args.fix {
        fixed(path, args, interrupt)?
    } else {
        SceneInput::read(path, &args.overrides)?
    };
    report(&input, args.format.format)
}

/// Applies the fixes of a file's errors, and reports which fixes were applied. Writes the changed
/// file, or prints the changed text if the input is standard input. With `--diff`, only prints the
/// changes. Returns the input after the fixes.
fn fixed(path: &Path, args: &CheckArgs, interrupt: &Interrupt) -> Result<SceneInput, CommandError> {
    let (mut input, original) = SceneInput::to_change(path, &args.overrides, "--fix")?;
    let most = if args.unsafe_fixes {
        Applicability::Unsafe
    } else {
        Applicability::Safe
    };
    let fixed = scene::fix_all(&input.sources, most);
    match &original {
        _ if args.diff => {
            let name = visible_line(input.sources.file.name());
            let changes = unified_diff(&name, input.sources.file.text(), &fixed.text);
            output::to_programs(changes.as_bytes())?;
        }
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
    let is_utf8 = input.sources.file.invalid_utf8().is_empty();
    output::to_people(&held_back(&visible_line(&name), &fixed, is_utf8));
    if !fixed.done.is_empty() {
        input.sources.file = Source::from_text(name, fixed.text);
    }
    Ok(input)
}

/// Returns sentences that tell the user how many fixes were not applied, why, and with which option
/// they can be applied.
fn held_back(name: &str, fixed: &Fixed, is_utf8: bool) -> String {
    let mut text = String::new();
    let fixes = |count, one, more| match count {
        1 => format!("{name}: 1 fix {one}"),
        _ => format!("{name}: {count} fixes {more}"),
    };
    if fixed.held_back > 0 {
        let which = fixes(
            fixed.held_back,
            "is held back, as it chooses among meanings, or removes or changes something",
            "are held back, as they choose among meanings, or remove or change something",
        );
        text += &format!("{which}; `--fix --unsafe` applies such fixes\n");
    }
    if fixed.placeholders > 0 {
        let which = fixes(
            fixed.placeholders,
            "would make up a value",
            "would make up values",
        );
        text += &format!("{which}, and no command applies such fixes: write your own\n");
    }
    if fixed.waiting > 0 && is_utf8 {
        let which = fixes(fixed.waiting, "is left", "and perhaps more are left");
        text += &format!("{which}: the same command once more applies them\n");
    } else if fixed.waiting > 0 {
        let which = fixes(fixed.waiting, "waits", "wait");
        text += &format!("{which} until all bytes of the file are UTF-8: save it as that first\n");
    }
    text
}

fn report(input: &SceneInput, format: AnswerFormat) -> Result<Status, CommandError> {
    let reading = scene::read(&input.sources);
    match format {
        AnswerFormat::Human => {
            output::to_people(&input.report(&reading));
            if reading.diagnostics.is_empty() && output::is_watched() {
                let name = visible_line(input.sources.file.name());
                output::to_people(&format!("{name}: ok\n"));
            }
        }
        AnswerFormat::Json => {
            let lines = diagnostic::json_lines(&reading.diagnostics, &input.sources);
            output::to_programs(lines.as_bytes())?;
        }
    }
    Ok(match reading.scene {
        Some(_) => Status::Done,
        None => Status::Negative,
    })
}
