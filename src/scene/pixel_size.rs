//! Computes the size of a pixel at depth 1.

use super::model::{Camera, Image, Lens};
use crate::math::{Angle, Real};

/// Returns the side of a pixel at depth 1, in metres. For a distance d to the view plane, it is
///
///   view_height / (height · d),
///
/// where height is in pixels. For a field of view, it is 2·tan(angle/2) divided by the picture's
/// height or width in pixels. `tan_half` computes tan(angle/2) in the precision that the caller
/// needs.
pub fn pixel_size<T: Real>(camera: &Camera, image: &Image, tan_half: impl Fn(Angle) -> T) -> T {
    let [width, height] = [image.width, image.height].map(|pixels| T::from_f64(pixels.into()));
    let slope = |angle| T::from_f64(2.0).times(&tan_half(angle));
    match camera.lens {
        Lens::Distance(d) => T::from_f64(camera.view_height)
            .over(&T::from_f64(d))
            .over(&height),
        Lens::Fov(angle) => slope(angle).over(&height),
        Lens::HorizontalFov(angle) => slope(angle).over(&width),
    }
}
