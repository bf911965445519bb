//! Finds the object at a point of the picture, and the colours of a pixel's samples.

use glam::DVec2;

use crate::{
    area::Area,
    color::Color,
    film::Encoder,
    math::SimdWidth,
    render::{Control, render_as_asked},
    sampling::{Points, Sampling},
    scene::{Sampler, Scene},
    tracer::{Hit, World, ray},
};

/// Maximum number of samples of a pixel that [`samples`] returns, to limit the length of the answer
/// to the editor. Further samples are left out, since a drawing of one pixel could not show more
/// points separately.
pub const MOST_SAMPLES: u64 = 1 << 16;

/// Maximum number of samples per pixel with which [`samples`] renders a pixel. For more samples, an
/// error is returned, since the answer would be delayed too long. All samples are rendered, even
/// those that are not returned, because the pixel's colour depends on them.
const MOST_TRACED: u64 = 1 << 20;

/// Returns the hit at which the view ray through the point `point` of the picture meets the visible
/// object, and the colour at this point. The hit is `None` if only the background is visible. The
/// whole result is `None` if the point is outside of the picture.
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

/// The colour of a pixel, and the samples from which it is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelSamples {
    /// Positions of the samples, in pixels from the pixel's top left corner, with their colours.
    pub samples: Vec<(DVec2, Color)>,
    /// The pixel's colour, which takes all samples into account.
    pub color: Color,
    /// The same colour in linear light, before it is rounded.
    pub mean: [f64; 3],
}

/// Returns the colour of the pixel in column `x` and row `y`, and its first [`MOST_SAMPLES`]
/// samples. A picture that is computed exactly has no samples.
///
/// # Errors
///
/// Returns a sentence that says why the pixel cannot be rendered.
pub fn samples(sampler: &Sampler, world: &World, [x, y]: [u32; 2]) -> Result<PixelSamples, String> {
    let (picture, pixel) = (world.picture(), Area::pixel(x, y));
    let sampling = Sampling::new(sampler, picture.width, picture.height);
    let count = sampling.count(x, y);
    if count > MOST_TRACED {
        return Err(format!("{count} samples of a pixel would take too long"));
    }
    let rendered = render_as_asked::<[f64; 3]>(world, &sampling, pixel, &Control::default());
    let rendered = rendered.map_err(|error| error.to_string())?;
    let mut points = Points::default();
    let shown = 0..count.min(MOST_SAMPLES);
    sampling.place(SimdWidth::Baseline, [x, y], count, shown, &mut points);
    let sample = |offset: DVec2| {
        let color = world.palette()[world.color_index_at(x, y, offset)];
        (offset + 0.5, color)
    };
    let mean = rendered.film().pixels()[0];
    Ok(PixelSamples {
        samples: points.iter().map(sample).collect(),
        color: color_of(mean),
        mean,
    })
}

/// Returns the colour of the mean light of a pixel.
pub fn color_of(mean: [f64; 3]) -> Color {
    Color::from_bytes(Encoder::shared().pixel(mean))
}
