//! Renders the exact pictures of two scenes, which `diff` compares. They are computed without
//! sampling noise.

use std::{path::Path, sync::atomic::AtomicBool};

use super::{
    CommandError,
    args::DiffArgs,
    command_error,
    input::{SceneInput, shown},
    progress,
};
use crate::{
    area::Area,
    film::Film,
    render::{RenderError, render_exact},
    scene::Scene,
    tracer::World,
};

/// Tolerance between the exact pictures of two scenes, in steps of 8-bit sRGB. It must exceed the
/// errors of both pictures together. Each error is usually at most 10^−9 in linear light. The sRGB
/// curve is steepest near black, where one unit of linear light becomes 255·12.92 steps, so this
/// error is at most 3.3·10^−6 steps. A larger tolerance would hide small differences between the
/// scenes.
pub const EXACT_STEPS: f64 = 1e-4;

/// Returns whether a path has the extension of scenes, `.scn`.
pub fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "scn")
}

/// Renders the exact pictures of both scenes that the arguments name.
pub fn of_scenes(args: &DiffArgs, cancel: &AtomicBool) -> Result<[Film; 2], CommandError> {
    if args.crop.is_some() {
        let message = "`--crop` says which part of a scene a picture shows, and these are scenes";
        return Err(command_error(message));
    }
    let a = SceneInput::read(&args.a, &args.overrides)?;
    let b = SceneInput::read(&args.b, &args.overrides)?;
    // Both scenes are read before the first error is returned, so that the errors of both are
    // printed.
    let (a, b) = (a.scene(), b.scene());
    let (a, b) = (a?, b?);
    let sizes = [&a, &b].map(|scene| [scene.image.width, scene.image.height]);
    if sizes[0] != sizes[1] {
        let [[w, h], [other_w, other_h]] = sizes;
        let [a, b] = [&args.a, &args.b].map(|path| shown(path));
        return Err(command_error(format!(
            "{a} is {w} x {h} pixels and {b} is {other_w} x {other_h}: give both one size, such as by `--set image.width={w} --set image.height={h}`"
        )));
    }
    let whole = Area::whole(sizes[0][0], sizes[0][1]);
    let total = 2 * whole.pixels();
    Ok(progress::rendering(total, None, cancel, |control| {
        let film = |scene: &Scene| -> Result<Film, RenderError> {
            let world = World::new_unless(scene, cancel)?;
            Ok(render_exact(&world, whole, control)?.film)
        };
        Ok::<_, RenderError>([film(&a)?, film(&b)?])
    })?)
}
