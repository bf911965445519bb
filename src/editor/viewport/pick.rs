//! Finds the object at a point of the picture, and the colours of a pixel's samples.

use glam::DVec2;

use crate::{
    area::Area,
    color::Color,
    math::SimdWidth,
    render::{Control, render_as_asked},
    sampling::{Points, Sampling},
    scene::Scene,
    tracer::{Hit, World, ray},
};

/// Maximum number of samples of a pixel that [`samples`] returns; further ones are left out.
pub const MOST_SAMPLES: u64 = 1 << 16;

/// Maximum number of samples of a pixel for which [`samples`] renders the pixel. If the pixel has
/// more, an error is returned, since rendering it would take too long.
const MOST_TRACED: u64 = 1 << 20;

/// Returns the nearest hit of the ray through a point of the picture, and the colour that is
/// visible there. The hit is `None` if the ray shows the background. Returns `None` for both if the
/// point is outside of the picture.
pub fn pick(scene: &Scene, world: &World, point: DVec2) -> Option<(Option<Hit>, Color)> {
    let picture = world.picture();
    let size = DVec2::new(f64::from(picture.width), f64::from(picture.height));
    if !(point.cmpge(DVec2::ZERO) & point.cmple(size)).all() {
        return None;
    }
    let (_, hits) = ray(world, point);
    let seen = hits.into_iter().find(|hit| hit.visible);
    Some((seen, seen.map_or(scene.image.background, |hit| hit.color)))
}

/// Samples of a pixel.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct PixelSamples {
    /// Positions of the samples in pixels from the pixel's top left corner, and their colours.
    pub samples: Vec<(DVec2, Color)>,
    /// The colour of the pixel.
    pub color: Color,
}

/// Returns the colour of the pixel in column `x` and row `y`, and its first [`MOST_SAMPLES`]
/// samples. An exact picture has no samples.
///
/// # Errors
///
/// Returns a sentence that says why the pixel cannot be rendered.
pub fn samples(scene: &Scene, world: &World, [x, y]: [u32; 2]) -> Result<PixelSamples, String> {
    let (picture, pixel) = (world.picture(), Area::pixel(x, y));
    let sampling = Sampling::new(&scene.sampler, picture.width, picture.height);
    let count = sampling.count(x, y);
    if count > MOST_TRACED {
        return Err(format!("{count} samples of a pixel would take too long"));
    }
    let rendered = render_as_asked(world, &sampling, pixel, &Control::default());
    let rendered = rendered.map_err(|error| error.to_string())?;
    let mut points = Points::default();
    let shown = 0..count.min(MOST_SAMPLES);
    sampling.place(SimdWidth::Baseline, [x, y], count, shown, &mut points);
    let sample = |offset: DVec2| {
        let color = world.palette()[world.slot_at(x, y, offset)];
        (offset + 0.5, color)
    };
    Ok(PixelSamples {
        samples: points.iter().map(sample).collect(),
        color: Color::from_bytes(rendered.film().pixel(0, 0)),
    })
}
