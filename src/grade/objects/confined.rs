//! An object that is off in some way that nobody thought of: the picture is right wherever it is not.

use glam::DVec3;

use super::{
    ENOUGH, SEARCHED, called,
    colors::{Near, color},
    likeliest, moved,
    search::Blob,
};
use crate::{
    area::Area,
    film::{Film, Tolerance, compare, rmse},
    grade::{Case, Off, Verdict, explained_share, noise},
    render::RenderError,
    scene::Shape,
};

/// How much larger an object may be, or how much of its size beside its place.
const ROOM: f64 = 1.25;

/// An object takes the blame if its part of the picture is less than this share of it.
const PART: f64 = 0.5;

/// So many pixels have to be wrong there.
const WRONG: usize = 16;

/// The object in whose part of the picture all of the difference is but noise; of several the one with the smallest part.
pub fn confined(case: &Case) -> Result<Option<Verdict>, RenderError> {
    let (a, exact, scene) = (&case.full.a, &case.full.exact, &case.full.scene);
    let whole = Area::whole(a.width(), a.height());
    let mut parts = Vec::new();
    for (_, index) in likeliest(case, ROOM).into_iter().take(SEARCHED) {
        let shape = scene.objects[index].shape;
        if matches!(shape, Shape::Checkerboard(_)) {
            continue;
        }
        let part = case.view.extent(&moved(&shape, DVec3::ZERO, ROOM));
        parts.extend(part.map(|part| (part.pixels(), index, part)));
    }
    parts.retain(|(pixels, ..)| (*pixels as f64) < PART * whole.pixels() as f64);
    parts.sort_by_key(|(pixels, index, _)| (*pixels, *index));
    for (_, index, part) in parts {
        let Some(rest) = outside(case, part)? else {
            continue;
        };
        let (wrong, off) = (wrong(case, part), off(case, index, part));
        let mut message = format!(
            "the picture is wrong only where {} is seen, or near it, in {wrong} pixels: something about it is off",
            called(scene, index)
        );
        if let Some(off) = off {
            message += &format!("; what has its colour there is displaced: {off}");
        }
        let left = rmse(&rest, exact);
        return Ok(Some(Verdict {
            mistake: "object",
            message,
            help: format!(
                "look at the fields of the {}, and at how its rays are intersected",
                scene.objects[index].shape.kind()
            ),
            rmse: Some(left),
            explains: Some(explained_share(left, case.difference)),
            off,
        }));
    }
    Ok(None)
}

/// How many pixels of a part are wrong.
fn wrong(case: &Case, part: Area) -> usize {
    let (a, exact) = (&case.full.a, &case.full.exact);
    let is_off = |(x, y): &(u32, u32)| noise::is_off((&a.pixel(*x, *y), &exact.pixel(*x, *y)));
    part.iter().filter(is_off).count()
}

/// How far what has an object's colour in a part is from where the exact picture has it.
fn off(case: &Case, index: usize, part: Area) -> Option<Off> {
    let mut shape = case.full.scene.objects[index].shape;
    let color = color(&mut shape).first()?.to_linear();
    let near = Near::to(&color);
    let films = [&case.full.a, &case.full.exact];
    let [is, should] = films.map(|film| Blob::of(film, part, &near));
    if is.pixels.min(should.pixels) < ENOUGH {
        return None;
    }
    // As of a disk.
    let radius = |blob: &Blob| (blob.pixels as f64 / std::f64::consts::PI).sqrt();
    Off::by(is.middle - should.middle, radius(&is) - radius(&should))
}

/// The picture, right in a part of it, if the rest of it differs by roundings or noise alone.
fn outside(case: &Case, part: Area) -> Result<Option<Film>, RenderError> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    let is_in = |x: u32, y: u32| Area::pixel(x, y).lies_in(part);
    let rest = Film::from_fn(a.width(), a.height(), |x, y| match is_in(x, y) {
        true => exact.pixel(x, y),
        false => a.pixel(x, y),
    })?;
    let rounding = Tolerance {
        steps: 0.501,
        bounds: None,
    };
    if compare(&rest, exact, rounding).is_ok_and(|found| found.is_equal()) {
        return Ok((wrong(case, part) >= WRONG).then_some(rest));
    }
    let none = Film::new(a.width(), a.height())?;
    let variance = Film::from_fn(a.width(), a.height(), |x, y| match is_in(x, y) {
        true => none.pixel(x, y),
        false => case.variance.pixel(x, y),
    })?;
    let Some(noise) = noise::judge(&rest, exact, &variance) else {
        return Ok(None);
    };
    let is_biased = case.is_biased(&rest, exact, &variance, noise)?;
    Ok((!is_biased).then_some(rest))
}
