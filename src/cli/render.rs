//! `render`: renders a scene to a picture file.

use std::time::Instant;

use super::{
    Status, Trouble,
    args::RenderArgs,
    input::{SceneInput, shown},
    interrupt::Interrupt,
    output,
    picture::{PictureOutput, picture},
};
use crate::{area::Area, render::RenderError, tracer::World};

/// Renders a scene and writes the picture.
pub fn run(args: &RenderArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let output = PictureOutput::of(&args.scene, args.output.as_deref())?;
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let reading = input.scene();
    // The output is checked before rendering, which may take hours, and even if the scene has
    // errors: the exit status of an output that cannot be written is the worse one.
    output.check(&args.scene)?;
    let Some(scene) = reading.scene else {
        return Ok(Status::SceneErrors);
    };
    // A crop on the command line replaces the crop that a picture carries. Both are in pixels of
    // the whole picture.
    let crop = args.crop.or(input.crop);
    let whole = Area::whole(scene.image.width, scene.image.height);
    let part = crop.unwrap_or(whole);
    if !part.lies_in(whole) {
        let carried = match args.crop {
            Some(_) => String::new(),
            None => format!(", which {} carries,", shown(&args.scene)),
        };
        return Err(Trouble(format!(
            "the crop {part}{carried} does not lie within the picture, which has {} × {} pixels",
            whole.width, whole.height
        )));
    }
    let cancel = interrupt.watch();
    let started = Instant::now();
    let Ok(world) = World::new_unless(&scene, cancel) else {
        return Ok(Status::Interrupted);
    };
    let picture = match picture(&scene, &world, part, output.keep(), cancel) {
        Ok(picture) => picture,
        Err(RenderError::Cancelled) => return Ok(Status::Interrupted),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    let recipe = input.recipe(crop);
    match output.write(&args.scene, &picture, &recipe, whole, cancel) {
        Ok(()) => {}
        Err(_) if interrupt.pressed() => return Ok(Status::Interrupted),
        Err(trouble) => return Err(trouble),
    }
    output::to_people(&output.note_of_length(&recipe));
    output::to_people(&picture.notes(part, &output));
    if output::is_watched() {
        let (width, height) = picture.size();
        let seconds = started.elapsed().as_secs_f64();
        output::to_people(&format!(
            "wrote {output}: {width} × {height} pixels in {seconds:.2} s\n"
        ));
    }
    Ok(Status::Done)
}
