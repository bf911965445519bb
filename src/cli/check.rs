//! `check`: the problems of scenes, and nothing else.

use pinhole::{diagnostic, scene};

use super::{
    Status, Trouble,
    args::{CheckArgs, Format},
    input::{Input, check_standard},
    output,
};

/// Reports the problems of each scene in turn. The status is the gravest one.
pub fn run(args: &CheckArgs) -> Result<Status, Trouble> {
    check_standard(&args.scenes)?;
    let mut status = Status::Done;
    for path in &args.scenes {
        let found = match Input::read(path, &args.overrides) {
            Ok(input) => report(&input, args.format.format)?,
            Err(trouble) => {
                output::error(&trouble);
                Status::Trouble
            }
        };
        status = status.max(found);
    }
    Ok(status)
}

fn report(input: &Input, format: Format) -> Result<Status, Trouble> {
    let reading = match format {
        Format::Human => input.scene(),
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
