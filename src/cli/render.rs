//! `render`: renders a scene to a picture file. With `--sweep`, renders several variants of the
//! scene to a file each.

use std::time::Instant;

use super::{
    CommandError, Status,
    args::RenderArgs,
    command_error,
    frames::{self, FramePattern},
    input::{SceneInput, shown},
    interrupt::Interrupt,
    output,
    picture::PictureOutput,
    sweep::Sweep,
};
use crate::{area::Area, film::Recipe, render::RenderError, scene::Scene, tracer::World};

/// Renders a scene and writes the picture, or the pictures of a sweep.
pub fn run(args: &RenderArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    if let Some(sweep) = &args.sweep {
        return render_sweep(args, sweep, interrupt);
    }
    if args.shard.is_some() && args.output.is_none() {
        return Err(command_error(
            "a shard is one of several files: say with `-o FILE` where it goes",
        ));
    }
    let output = PictureOutput::of(&args.scene, args.output.as_deref())?;
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene();
    // Rendering may take hours, so the output is checked first. It is checked even if the scene has
    // errors: an output that cannot be written causes the exit status 2, which takes precedence
    // over the status 1 of a scene with errors.
    output.check(&args.scene)?;
    let scene = scene?;
    let recipe = recipe(args, input, &scene)?;
    render(args, &scene, &recipe, &output, interrupt)?;
    Ok(Status::Done)
}

/// Renders a scene and writes the picture to `output`.
fn render(
    args: &RenderArgs,
    scene: &Scene,
    recipe: &Recipe,
    output: &PictureOutput,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let part = recipe.crop.unwrap_or(whole);
    let cancel = interrupt.watch();
    let started = Instant::now();
    let world = World::new_unless(scene, cancel).map_err(RenderError::from)?;
    let note = output
        .render(scene, &world, part, recipe, &args.scene, cancel)
        .map_err(|error| interrupt.or(error))?;
    output::to_people(&output.note_of_length(recipe));
    output::to_people(&note);
    if output::is_watched() {
        let [width, height] = [part.width, part.height];
        let seconds = started.elapsed().as_secs_f64();
        output::to_people(&format!(
            "wrote {output}: {width} × {height} pixels in {seconds:.2} s\n"
        ));
    }
    Ok(())
}

/// Returns what the picture's file stores: the scene, its overrides and the rendered part of the
/// picture.
fn recipe(args: &RenderArgs, input: SceneInput, scene: &Scene) -> Result<Recipe, CommandError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let crop = crop(args, &input, whole)?;
    Ok(input.into_recipe(crop, whole))
}

/// Returns the part of the picture to render, or `None` for the whole picture.
fn crop(args: &RenderArgs, input: &SceneInput, whole: Area) -> Result<Option<Area>, CommandError> {
    if let Some(shard) = args.shard {
        let band = shard.band(whole).ok_or_else(|| {
            command_error(format!(
                "{shard} is not one of at most {} shards: the picture has so many rows",
                whole.height
            ))
        })?;
        return Ok(Some(band));
    }
    // A crop on the command line replaces the one stored in the PNG. Both are in pixels of the
    // whole picture.
    let crop = args.crop.or(input.crop);
    match crop {
        Some(part) if !part.lies_in(whole) => {
            let carried = match args.crop {
                Some(_) => String::new(),
                None => format!(", which {} carries,", shown(&args.scene)),
            };
            Err(command_error(format!(
                "the crop {part}{carried} does not lie within the picture, which has {} × {} pixels",
                whole.width, whole.height
            )))
        }
        crop => Ok(crop),
    }
}

/// Renders each scene of a sweep to a file of its own.
fn render_sweep(
    args: &RenderArgs,
    sweep: &Sweep,
    interrupt: &Interrupt,
) -> Result<Status, CommandError> {
    let pattern = FramePattern::of(args.output.as_deref())?;
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let outputs = (0..sweep.count()).map(|i| {
        let output = PictureOutput::of(&args.scene, Some(&pattern.path(i)))?;
        output.check(&args.scene)?;
        Ok(output)
    });
    let outputs: Vec<PictureOutput> = outputs.collect::<Result<_, CommandError>>()?;
    for (step, output) in input.steps(sweep)?.into_iter().zip(outputs) {
        let input = input.with_set(&step.set);
        let scene = input.scene_without_warnings()?;
        let recipe = recipe(args, input, &scene)?;
        if !args.resume || !frames::is_rendered(&output, &recipe) {
            render(args, &scene, &recipe, &output, interrupt)?;
        }
    }
    Ok(Status::Done)
}
