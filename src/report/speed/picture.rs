//! The pictures of the page: a part that every method shows, and the exact picture as a whole.

use std::io;

use base64::{Engine, prelude::BASE64_STANDARD};

use crate::{
    area::Area,
    film::{self, Film, TooLarge, write_plain_png},
};

/// The largest part: several stand beside each other on a page, and a sample's noise is to be seen.
const PART: (u32, u32) = (240, 135);

/// The picture as a whole is at most so wide and high: a page is not much wider, and its file stays small.
const WHOLE: (u32, u32) = (640, 480);

/// The part of a picture where it is most wrong, in steps of half its size.
pub fn part(film: &Film, reference: &Film) -> Result<Area, TooLarge> {
    let (width, height) = (film.width().min(PART.0), film.height().min(PART.1));
    let places = |length: u32, size: u32| {
        let last = length - size;
        (0..last).step_by((size / 2).max(1) as usize).chain([last])
    };
    let (mut worst, mut most) = (Area::whole(width, height), 0.0);
    for y in places(film.height(), height) {
        for x in places(film.width(), width) {
            let part = Area { x, y, ..worst };
            let error = film::rmse(&cropped(film, part)?, &cropped(reference, part)?);
            if error > most {
                (worst, most) = (part, error);
            }
        }
    }
    Ok(worst)
}

/// A part of a picture as a picture.
pub fn cropped(film: &Film, part: Area) -> Result<Film, TooLarge> {
    Film::from_fn(part.width, part.height, |x, y| {
        film.pixel(part.x + x, part.y + y)
    })
}

/// A picture small enough for a page: squares of as many pixels as it takes are averaged, in linear light.
pub fn reduced(film: &Film) -> Result<Film, TooLarge> {
    let whole = Area::whole(film.width(), film.height());
    let side = (whole.width.div_ceil(WHOLE.0)).max(whole.height.div_ceil(WHOLE.1));
    let square = |x: u32, y: u32| {
        let square = Area {
            x: x * side,
            y: y * side,
            width: side,
            height: side,
        };
        let pixels = square.common(whole).iter();
        film::mean(pixels.map(|(x, y)| (1, film.pixel(x, y))))
    };
    Film::from_fn(
        whole.width.div_ceil(side),
        whole.height.div_ceil(side),
        square,
    )
}

/// A picture as a PNG in a `data:` URI.
pub fn uri(film: &Film) -> io::Result<String> {
    let mut bytes = Vec::new();
    write_plain_png(film, &mut bytes)?;
    let bytes = BASE64_STANDARD.encode(bytes);
    Ok(format!("data:image/png;base64,{bytes}"))
}
