//! `figure`: draws a figure of a scene as SVG, for teaching material.

use super::{
    CommandError, Status,
    args::FigureArgs,
    command_error,
    input::{SceneInput, is_same_file, is_standard, shown, unwritable},
    interrupt::Interrupt,
    output,
};
use crate::{
    figure::{self, Choice, Kind},
    files::{self, Purpose},
};

/// Draws the figure that the arguments ask for, and writes it to a file or to standard output.
pub fn run(args: &FigureArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let output = args.output.as_deref().filter(|path| !is_standard(path));
    if let Some(path) = output {
        let name = shown(path);
        if !path
            .extension()
            .is_some_and(|it| it.eq_ignore_ascii_case("svg"))
        {
            return Err(command_error(format!(
                "a figure is an SVG: {name} should end in .svg"
            )));
        }
        if is_same_file(path, &args.scene) {
            return Err(command_error(format!(
                "{name} is the scene itself: say with `-o FILE` where the figure goes"
            )));
        }
        files::check_writable(path, Purpose::Named).map_err(|error| unwritable(path, &error))?;
    }
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene()?;
    let choice = Choice {
        pixel: args.pixel,
        object: args.object.as_deref(),
    };
    let svg = figure::figure(&scene, args.kind, choice).map_err(command_error)?;
    if args.kind == Kind::Roll && scene.camera.roll.in_degrees() == 0.0 {
        output::warning(
            &"the camera does not roll, so nothing turns: `--set camera.roll=20deg` shows what a roll does",
        );
    }
    let Some(path) = output else {
        output::to_programs(svg.as_bytes())?;
        return Ok(Status::Done);
    };
    files::write(path, Purpose::Named, interrupt.watch(), |out| {
        out.write_all(svg.as_bytes())
    })
    .map_err(|error| interrupt.or(unwritable(path, &error)))?;
    Ok(Status::Done)
}
