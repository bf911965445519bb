//! What an object changes in the picture when it is moved, or larger, by a part of a pixel.
//!
//! Errors that add up along such a change say that the object is off, through noise that hides it otherwise, and by how much.

use glam::{DVec2, DVec3};

use super::{SLOPES, likeliest, moved, with_shape};
use crate::{
    grade::{Case, Make, bias::Trend, extent::ball, level::axes},
    render::RenderError,
    scene::Shape,
};

/// By so many pixels an object is moved, or its outline: within a pixel the mean is nearly straight, and a step of less shows no more.
const STEP: f64 = 0.5;

/// A change of one object, by a little.
pub struct Slope {
    pub index: usize,
    /// How far it is moved, in pixels to the right and down.
    pub by: DVec2,
    /// How many times as large it is.
    pub factor: f64,
    pub trend: Trend,
}

/// The changes of the objects that are likeliest to be off.
pub fn slopes(case: &Case) -> Result<Vec<Slope>, RenderError> {
    let scene = &case.full.scene;
    let ([u, v, w], pitch) = axes(scene);
    let mut slopes = Vec::new();
    for (_, index) in likeliest(case, 1.0).into_iter().take(case.most(SLOPES)) {
        let shape = scene.objects[index].shape;
        let Some((middle, radius)) = ball(&shape) else {
            continue;
        };
        let depth = (scene.camera.eye - middle).dot(w);
        if depth <= 0.0 {
            continue;
        }
        let step = STEP * depth * pitch;
        for (by, place, factor) in [
            (DVec2::new(STEP, 0.0), u * step, 1.0),
            (DVec2::new(0.0, STEP), -v * step, 1.0),
            (DVec2::ZERO, DVec3::ZERO, 1.0 + step / radius),
        ] {
            let changed: Shape = moved(&shape, place, factor);
            let Make::Object(other, shapes) = with_shape(scene, index, changed) else {
                continue;
            };
            if let Some(trend) = case.full.trend(&other, &shapes, &case.control)? {
                slopes.push(Slope {
                    index,
                    by,
                    factor,
                    trend,
                });
            }
        }
    }
    Ok(slopes)
}
