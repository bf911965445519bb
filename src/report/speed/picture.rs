//! The pictures of the page: a part that every method shows, and the exact picture as a whole.

use std::io;

use base64::{Engine, prelude::BASE64_STANDARD};

use super::measurement::{Measurement, Shown};
use crate::{
    area::Area,
    film::{self, Film, Recipe, TooLarge, write_png},
    scene::Method,
};

/// The largest part: several stand beside each other on a page, and a sample's noise is to be seen.
const PART: (u32, u32) = (240, 135);

/// The picture as a whole is at most so wide and high: a page is not much wider, and its file stays small.
const WHOLE: (u32, u32) = (640, 480);

/// The part of a picture where it is most wrong, in steps of half its size.
pub fn part(film: &Film, reference: &Film) -> Area {
    let (width, height) = (film.width().min(PART.0), film.height().min(PART.1));
    let places = |length: u32, size: u32| {
        let last = length - size;
        (0..last).step_by((size / 2).max(1) as usize).chain([last])
    };
    let squares = |part: Area| -> f64 {
        let pixels = part
            .iter()
            .map(|(x, y)| (film.pixel(x, y), reference.pixel(x, y)));
        pixels
            .map(|(a, b)| (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum::<f64>())
            .sum()
    };
    let rows = places(film.height(), height);
    let parts = rows.flat_map(|y| {
        places(film.width(), width).map(move |x| Area {
            x,
            y,
            width,
            height,
        })
    });
    let first = Area {
        x: 0,
        y: 0,
        width,
        height,
    };
    let wrong = parts.map(|part| (squares(part), part));
    wrong
        .fold(
            (0.0, first),
            |best, next| if next.0 > best.0 { next } else { best },
        )
        .1
}

/// A part of a picture as a picture.
pub fn cropped(film: &Film, part: Area) -> Result<Film, TooLarge> {
    Film::from_fn(part.width, part.height, |x, y| {
        film.pixel(part.x + x, part.y + y)
    })
}

/// The whole exact picture as a `data:` URI, and its size there: squares of as many pixels as it takes are averaged, in linear light.
pub fn whole(measured: &Measurement) -> io::Result<(String, Area)> {
    let exact = &measured.reference.film;
    let whole = measured.whole();
    let side = whole
        .width
        .div_ceil(WHOLE.0)
        .max(whole.height.div_ceil(WHOLE.1));
    let size = Area::whole(whole.width.div_ceil(side), whole.height.div_ceil(side));
    let square = |x: u32, y: u32| {
        let square = Area {
            x: x * side,
            y: y * side,
            width: side,
            height: side,
        };
        film::mean(
            square
                .common(whole)
                .iter()
                .map(|(x, y)| (1, exact.pixel(x, y))),
        )
    };
    let film = Film::from_fn(size.width, size.height, square).map_err(io::Error::other)?;
    Ok((uri(&film, measured, None, &[])?, size))
}

/// The part of the exact picture that is shown of every method, as a `data:` URI.
pub fn exact(measured: &Measurement) -> io::Result<String> {
    let film = cropped(&measured.reference.film, measured.crop).map_err(io::Error::other)?;
    uri(&film, measured, Some(measured.crop), &[])
}

/// The same of a method. Like every picture it carries the scene, so that Pinhole can render it again.
pub fn sampled(measured: &Measurement, method: Method, shown: &Shown) -> io::Result<String> {
    let sets = [
        format!("sampler.method={}", method.name()),
        format!("sampler.per_pixel={}", shown.per_pixel),
        format!("sampler.seed={}", measured.seed),
    ];
    uri(&shown.crop, measured, Some(measured.crop), &sets)
}

/// A picture as a PNG in a `data:` URI; exact unless overrides say otherwise.
fn uri(
    film: &Film,
    measured: &Measurement,
    crop: Option<Area>,
    sets: &[String],
) -> io::Result<String> {
    let mut recipe = Recipe {
        crop,
        ..measured.subject.recipe.clone()
    };
    let exact = format!("sampler.method={}", Method::Exact.name());
    match sets {
        [] => recipe.overrides.push(exact),
        sets => recipe.overrides.extend_from_slice(sets),
    }
    let mut bytes = Vec::new();
    write_png(film, &recipe, &mut bytes)?;
    Ok(format!(
        "data:image/png;base64,{}",
        BASE64_STANDARD.encode(bytes)
    ))
}
