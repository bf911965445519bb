//! `inspect`: prints the properties that follow from a scene, such as its field of view.

use super::{
    CommandError, Status,
    args::{AnswerFormat, InspectArgs},
    input::SceneInput,
    output,
};
use crate::inspect;

/// Prints the properties of a scene, as readable text or as JSON.
pub fn run(args: &InspectArgs) -> Result<Status, CommandError> {
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene()?;
    let inspection = inspect::inspect(&scene, &input.sources.file);
    match args.format.format {
        AnswerFormat::Human => output::answer(&inspection.to_string())?,
        AnswerFormat::Json => output::stream_to_programs(|out| inspection.write_json(out))?,
    }
    Ok(Status::Done)
}
