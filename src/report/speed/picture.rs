//! The part of a picture that the page shows of every method.

use crate::{
    area::Area,
    film::{self, Film, TooLarge},
};

/// The largest part: several stand beside each other on a page, and a sample's noise is to be seen.
const PART: (u32, u32) = (240, 135);

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
