//! `figure`: a figure of a scene for a page of a course, as SVG.

use super::{
    Status, Trouble,
    args::FigureArgs,
    input::{SceneInput, is_same_file, is_standard, shown, unwritable},
    interrupt::Interrupt,
    output,
};
use crate::{
    figure::{self, Choice, Kind},
    files::{self, Purpose},
};

/// Draws the figure that the arguments ask for, and writes it to a file or to standard output.
pub fn run(args: &FigureArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let output = args.output.as_deref().filter(|path| !is_standard(path));
    if let Some(path) = output {
        let name = shown(path);
        if !path
            .extension()
            .is_some_and(|it| it.eq_ignore_ascii_case("svg"))
        {
            return Err(Trouble(format!(
                "a figure is an SVG: {name} should end in .svg"
            )));
        }
        if is_same_file(path, &args.scene) {
            return Err(Trouble(format!(
                "{name} is the scene itself: say with `-o FILE` where the figure goes"
            )));
        }
        files::check_writable(path, Purpose::Named).map_err(|error| unwritable(path, &error))?;
    }
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let Some(scene) = input.scene().scene else {
        return Ok(Status::SceneErrors);
    };
    let choice = Choice {
        pixel: args.pixel,
        object: args.object.as_deref(),
    };
    let svg = figure::figure(&scene, args.kind, choice).map_err(Trouble)?;
    if args.kind == Kind::Roll && scene.camera.roll.in_degrees() == 0.0 {
        output::warning(
            &"the camera does not roll, so nothing turns: `--set camera.roll=20deg` shows what a roll does",
        );
    }
    let Some(path) = output else {
        output::to_programs(svg.as_bytes())?;
        return Ok(Status::Done);
    };
    let written = files::write(path, Purpose::Named, interrupt.watch(), |out| {
        out.write_all(svg.as_bytes())
    });
    match written {
        Err(_) if interrupt.pressed() => Ok(Status::Interrupted),
        Err(error) => Err(unwritable(path, &error)),
        Ok(()) => Ok(Status::Done),
    }
}
