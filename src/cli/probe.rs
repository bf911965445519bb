//! `probe`: lists the surfaces along one ray.

use glam::DVec2;

use super::{
    CommandError, Status,
    args::{AnswerFormat, ProbeArgs},
    input::SceneInput,
    output,
};
use crate::probe;

/// Prints the surfaces that the ray through a point of the picture hits.
pub fn run(args: &ProbeArgs) -> Result<Status, CommandError> {
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene()?;
    let probe = probe::probe(&scene, DVec2::new(args.x, args.y));
    match args.format.format {
        AnswerFormat::Human => output::answer(&probe.to_string())?,
        AnswerFormat::Json => output::to_programs(format!("{}\n", probe.to_json()).as_bytes())?,
    }
    Ok(Status::Done)
}
