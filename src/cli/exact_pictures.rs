//! Renders the exact pictures of two scenes, which `diff` compares.

use std::{path::Path, sync::atomic::AtomicBool};

use super::{
    Trouble,
    args::DiffArgs,
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

/// Tolerance between the exact pictures of two scenes, in steps of 8-bit sRGB. A larger difference
/// is reported. The tolerance exceeds the error bound of both pictures: each one's bound of 10^−9
/// in linear light is at most 3.3·10^−6 steps.
pub const EXACT_STEPS: f64 = 1e-4;

/// Returns whether a path has the extension of scenes, `.scn`.
pub fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "scn")
}

/// Renders the exact pictures of both scenes that the arguments name. The outer error is about the
/// arguments, the inner one about rendering. Returns `None` if a scene has errors, which are
/// reported.
pub fn of_scenes(
    args: &DiffArgs,
    cancel: &AtomicBool,
) -> Result<Option<Result<[Film; 2], RenderError>>, Trouble> {
    if args.crop.is_some() {
        let message = "`--crop` says which part of a scene a picture shows, and these are scenes";
        return Err(Trouble(message.to_owned()));
    }
    let a = SceneInput::read(&args.a, &args.overrides)?;
    let b = SceneInput::read(&args.b, &args.overrides)?;
    // Both scenes are read before returning, so that the errors of both are reported.
    let (Some(a), Some(b)) = (a.scene().scene, b.scene().scene) else {
        return Ok(None);
    };
    let sizes = [&a, &b].map(|scene| [scene.image.width, scene.image.height]);
    if sizes[0] != sizes[1] {
        let [[w, h], [other_w, other_h]] = sizes;
        let [a, b] = [&args.a, &args.b].map(|path| shown(path));
        return Err(Trouble(format!(
            "{a} is {w} x {h} pixels and {b} is {other_w} x {other_h}: give both one size, such as by `--set image.width={w} --set image.height={h}`"
        )));
    }
    let whole = Area::whole(sizes[0][0], sizes[0][1]);
    let total = 2 * whole.pixels();
    Ok(Some(progress::rendering(total, None, cancel, |control| {
        let film = |scene: &Scene| -> Result<Film, RenderError> {
            let world = World::new_unless(scene, cancel)?;
            Ok(render_exact(&world, whole, control)?.film)
        };
        Ok([film(&a)?, film(&b)?])
    })))
}
