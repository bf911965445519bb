//! `inspect`: what a scene means.

use super::{
    Status, Trouble,
    args::{Format, InspectArgs},
    input::Input,
    output,
};
use crate::inspect;

/// Prints what a scene means.
pub fn run(args: &InspectArgs) -> Result<Status, Trouble> {
    let input = Input::read(&args.scene, &args.overrides)?;
    let Some(scene) = input.scene().scene else {
        return Ok(Status::SceneErrors);
    };
    let inspection = inspect::inspect(&scene, &input.sources.file);
    match args.format.format {
        Format::Human => output::answer(&inspection.to_string())?,
        Format::Json => output::stream_to_programs(|out| inspection.write_json(out))?,
    }
    Ok(Status::Done)
}
