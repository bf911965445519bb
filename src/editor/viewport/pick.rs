//! What is seen at a point of the picture, and what a pixel's samples see.

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

/// No more samples of a pixel are shown.
pub const MOST_SAMPLES: u64 = 1 << 16;

/// More samples of a pixel would take too long.
const MOST_TRACED: u64 = 1 << 20;

/// What is seen at a point of the picture: where an object is hit, unless it is the background, and
/// the colour. Nothing outside the picture.
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

/// The samples of a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelSamples {
    /// Where they lie in it, from its top left corner, and what each sees.
    pub samples: Vec<(DVec2, Color)>,
    /// The pixel's colour.
    pub color: Color,
}

/// The samples of the pixel in a column and a row, which lies in the picture; none of an exact
/// picture. Of more than [`MOST_SAMPLES`] only the first are shown.
///
/// # Errors
///
/// Why the pixel cannot be rendered, in a sentence.
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
