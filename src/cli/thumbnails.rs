//! A picture and its heat map, small enough to stand in a page.

use std::io;

use base64::{Engine, prelude::BASE64_STANDARD};
use pinhole::film::{self, Film, Tolerance};

/// The longer side of a thumbnail, in pixels.
const LONGEST: u32 = 320;

/// A picture and its heat map, as `data:` URIs.
pub struct Thumbnails {
    pub picture: String,
    pub heat: String,
}

impl Thumbnails {
    /// Of a picture and the exact one.
    pub fn new(film: &Film, exact: &Film, tolerance: Tolerance) -> io::Result<Self> {
        let heat = film::heat_map(film, exact, tolerance).map_err(io::Error::other)?;
        Ok(Self {
            picture: data(film)?,
            heat: data(&heat)?,
        })
    }
}

/// A picture as a `data:` URI, of some pixels' means where it is large.
fn data(film: &Film) -> io::Result<String> {
    let factor = film.width().max(film.height()).div_ceil(LONGEST);
    let [width, height] = [film.width(), film.height()].map(|side| (side / factor).max(1));
    let small = Film::from_fn(width, height, |x, y| {
        let mut sum = [0.0; 3];
        let mut count = 0.0;
        for row in (y * factor..(y + 1) * factor).take_while(|row| *row < film.height()) {
            let columns = x * factor..((x + 1) * factor).min(film.width());
            for column in columns {
                let pixel = film.pixel(column, row);
                sum = [0, 1, 2].map(|i| sum[i] + pixel[i]);
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count)
    });
    let small = small.map_err(io::Error::other)?;
    let mut png = Vec::new();
    film::write_plain_png(&small, &mut png)?;
    Ok(format!(
        "data:image/png;base64,{}",
        BASE64_STANDARD.encode(png)
    ))
}
