//! The exact pictures of two scenes that `diff` compares.

use std::{
    path::Path,
    sync::atomic::{AtomicBool, Ordering},
};

use super::{
    Trouble,
    args::DiffArgs,
    input::{Input, shown},
    progress,
};
use crate::{
    area::Area,
    film::Film,
    render::{Control, RenderError, render_exact},
    scene::Scene,
    tracer::World,
};

/// Steps of 8-bit sRGB that two exact pictures of one thing may differ by. A bound of 10^−9 of the
/// light is at most 3.3·10^−6 steps for each of them.
pub const EXACT_STEPS: f64 = 1e-4;

/// Whether a file is named as a scene.
pub fn is_scene(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "scn")
}

/// The pictures, or why there are none: what is wrong with the arguments, or with the work; `None`
/// if a scene has errors, which are reported.
pub fn of_scenes(
    args: &DiffArgs,
    cancel: &AtomicBool,
) -> Result<Option<Result<[Film; 2], RenderError>>, Trouble> {
    if args.crop.is_some() {
        let message = "`--crop` says which part of a scene a picture shows, and these are scenes";
        return Err(Trouble(message.to_owned()));
    }
    let a = Input::read(&args.a, &args.overrides)?;
    let b = Input::read(&args.b, &args.overrides)?;
    // Both report their mistakes.
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
    Ok(Some(progress::watched(2 * whole.pixels(), |done| {
        let control = Control {
            threads: None,
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        };
        let film = |scene: &Scene| -> Result<Film, RenderError> {
            let world = World::new_unless(scene, cancel)?;
            Ok(render_exact(&world, whole, &control)?.film)
        };
        Ok([film(&a)?, film(&b)?])
    })))
}
