//! `render`: renders a scene to a picture file.

use std::time::Instant;

use super::{
    Status, Trouble,
    args::RenderArgs,
    input::{SceneInput, shown},
    interrupt::Interrupt,
    output,
    picture::{PictureOutput, picture},
    trouble,
};
use crate::{area::Area, render::RenderError, tracer::World};

/// Renders a scene and writes the picture.
pub fn run(args: &RenderArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let output = PictureOutput::of(&args.scene, args.output.as_deref())?;
    let input = SceneInput::read(&args.scene, &args.overrides)?;
    let scene = input.scene();
    // The output is checked before rendering, which may take hours. It is checked before the
    // scene's errors are returned, because an output that cannot be written leads to exit status 2,
    // which takes precedence over 1, the status of scene errors.
    output.check(&args.scene)?;
    let scene = scene?;
    // A crop on the command line replaces the one stored in the PNG. Both are in pixels of the
    // whole picture.
    let crop = args.crop.or(input.crop);
    let whole = Area::whole(scene.image.width, scene.image.height);
    let part = crop.unwrap_or(whole);
    if !part.lies_in(whole) {
        let carried = match args.crop {
            Some(_) => String::new(),
            None => format!(", which {} carries,", shown(&args.scene)),
        };
        return Err(trouble(format!(
            "the crop {part}{carried} does not lie within the picture, which has {} × {} pixels",
            whole.width, whole.height
        )));
    }
    let cancel = interrupt.watch();
    let started = Instant::now();
    let world = World::new_unless(&scene, cancel).map_err(RenderError::from)?;
    let picture = picture(&scene, &world, part, output.keep(), cancel)?;
    let recipe = input.recipe(crop);
    output
        .write(&args.scene, &picture, &recipe, whole, cancel)
        .map_err(|trouble| interrupt.or(trouble))?;
    output::to_people(&output.note_of_length(&recipe));
    output::to_people(&picture.notes(part, &output));
    if output::is_watched() {
        let [width, height] = [part.width, part.height];
        let seconds = started.elapsed().as_secs_f64();
        output::to_people(&format!(
            "wrote {output}: {width} × {height} pixels in {seconds:.2} s\n"
        ));
    }
    Ok(Status::Done)
}
