//! Renders a part of a picture in bands of rows, one after another.

use super::{Control, RenderError, Rendered, render_as_asked};
use crate::{
    area::Area,
    film::{Pixel, reserve_memory},
    sampling::Sampling,
    tracer::World,
};

/// Maximum number of pixels that are in memory at once. A larger picture is rendered and written in
/// bands of rows, so that only the disk limits its size. The pixels of a band need 12 to 50 MB.
/// With smaller bands, threads would wait more often for each other at a band's end.
const BAND_PIXELS: u32 = 1 << 22;

/// Number of pixels above which the size of a picture is probably mistyped. A larger picture is
/// rejected unless it would fit into memory, although rendering in bands needs less memory. A
/// poster with sides of 2^18 pixels has exactly this number of pixels. It is still rendered, which
/// takes hours.
const MISTYPED: u64 = 1 << 36;

/// Renders a part of the picture as [`render_as_asked`] does, in bands of rows, from the top. Each
/// band is rendered when it is requested, and is returned with its area.
///
/// # Errors
///
/// Fails if the part has so many pixels that its size is probably mistyped, and does not fit into
/// memory. A band fails as a render does.
///
/// # Panics
///
/// Panics if the sampling was made for a picture of another size.
pub fn render_bands<'a, P: Pixel>(
    world: &'a World,
    sampling: &'a Sampling,
    part: Area,
    control: &'a Control,
) -> Result<impl Iterator<Item = Result<(Area, Rendered<P>), RenderError>> + 'a, RenderError> {
    if part.pixels() > MISTYPED {
        reserve_memory(part.width, part.height, size_of::<P>() as u64)?;
    }
    let render = move |band| Ok((band, render_as_asked(world, sampling, band, control)?));
    Ok(bands(part).map(render))
}

/// Returns the bands of rows in which a part of a picture is rendered, from the top.
fn bands(part: Area) -> impl Iterator<Item = Area> {
    let rows = (BAND_PIXELS / part.width.max(1)).max(1);
    (0..part.height)
        .step_by(rows as usize)
        .map(move |top| Area {
            y: part.y + top,
            height: rows.min(part.height - top),
            ..part
        })
}
