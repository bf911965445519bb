//! Reduces pictures and encodes them as `data:` URIs, so that an HTML page can contain them.

use std::io;

use base64::{Engine, prelude::BASE64_STANDARD};

use super::{mean::mean, memory::TooLarge, pixels::Film, png::write_png};
use crate::area::Area;

/// Reduces the size of a picture to at most `columns` × `rows` pixels. The colour of each new pixel
/// is the mean of a square of old pixels, in linear light.
///
/// # Errors
///
/// There is not enough memory.
pub fn reduced(film: &Film, [columns, rows]: [u32; 2]) -> Result<Film, TooLarge> {
    let whole = Area::whole(film.width(), film.height());
    let side = (whole.width.div_ceil(columns)).max(whole.height.div_ceil(rows));
    let size = [whole.width, whole.height].map(|pixels| pixels.div_ceil(side));
    Film::from_fn(size[0], size[1], |x, y| {
        let square = Area {
            x: x * side,
            y: y * side,
            ..Area::whole(side, side)
        };
        let pixels = square.common(whole).iter();
        mean(pixels.map(|(x, y)| (1, film.pixel(x, y))))
    })
}

/// Encodes a picture as a PNG in a `data:` URI.
///
/// # Errors
///
/// PNG cannot encode the picture, for example because it has no pixels.
pub fn data_uri(film: &Film) -> io::Result<String> {
    let mut bytes = Vec::new();
    write_png(film, None, &mut bytes)?;
    Ok(format!(
        "data:image/png;base64,{}",
        BASE64_STANDARD.encode(bytes)
    ))
}
